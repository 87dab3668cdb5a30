"""Where a report comes from, the same at all levels: versions, seed and cost."""

from __future__ import annotations

import importlib.metadata

from sim.version import PHYSICS_VERSION


def _installed() -> str:
    try:
        return importlib.metadata.version("sideband")
    except importlib.metadata.PackageNotFoundError:
        return "0.1.0"


PACKAGE_VERSION = _installed()
METHOD_VERSION = "reconciliation-39"
"""Of what answers are made with, beside the physics: raised when an answer would be another."""


def origin(seed: int, core_s: float, **cost: object) -> dict[str, object]:
    """The entries of `provenance` that every report has; `core_s`: processor seconds, `cost`: more of what it cost."""
    return {
        "physics_version": PHYSICS_VERSION,
        "package_version": PACKAGE_VERSION,
        "method_version": METHOD_VERSION,
        "seed": seed,
        "cost": {"core_s": core_s, **cost},
    }
