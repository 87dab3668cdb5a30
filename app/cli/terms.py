"""List the physical effects, or explain one: where it acts, its parameters, its literature.

Example: sideband terms fit_clearance
"""

from __future__ import annotations

import argparse

from app.cli.files import json_text
from jobs.physics import PhysicsEngine
from sim.core.errors import UnknownName
from sim.core.terms import Term
from sim.terms import REGISTRY


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument("name", metavar="NAME", nargs="?", help="explain this one")
    parser.add_argument("--json", action="store_true", help="print JSON")


def run(arguments: argparse.Namespace) -> int:
    """Run the command."""
    name = arguments.name
    if name is not None and REGISTRY.get(name) is None:
        raise UnknownName("term", name, REGISTRY.keys())
    if arguments.json:
        listed = [t for t in PhysicsEngine().terms() if name in (None, t["key"])]
        print(json_text(listed if name is None else listed[0]), end="")
        return 0
    chosen = [t for t in REGISTRY if name in (None, t.key)]
    for term in chosen:
        print(_explained(term) if name is not None else _line(term))
    return 0


def _line(term: Term) -> str:
    where = ", ".join(term.sites) or "machine"
    return f"{term.key:<22}  {where:<8}  {', '.join(p.name for p in term.params) or '-'}\n    {term.sentence}"


def _explained(term: Term) -> str:
    lines = [f"{term.key}: {term.title}", f"  {term.sentence}", f"  acts at: {', '.join(term.sites) or 'the machine'}"]
    for p in term.params:
        bounds = f"{p.low:g} to {p.high:g}"
        unit = "" if p.unit == "1" else f" {p.unit}"
        lines.append(f"  {p.name:<16} default {p.default:g}, {bounds}{unit}: {p.sentence}")
    lines += [f"  cannot act together with: {', '.join(term.excludes)}"] if term.excludes else []
    lines += [f"  source: {reference}" for reference in term.references]
    return "\n".join(lines)
