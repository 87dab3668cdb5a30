"""Physical effects. Every module of this package that defines `TERM` is registered; no other list exists."""

from __future__ import annotations

import importlib
import pkgutil

from sim.core.terms import Registry, Term


def _discover() -> Registry:
    found: list[Term] = []
    for info in sorted(pkgutil.iter_modules(__path__), key=lambda m: m.name):
        term = getattr(importlib.import_module(f"{__name__}.{info.name}"), "TERM", None)
        if isinstance(term, Term):
            found.append(term)
    return Registry(found)


REGISTRY = _discover()
