"""Which engine made a result: a hash of the source that verdicts depend on."""

from __future__ import annotations

import hashlib
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PACKAGES = ("reconcile", "signals", "sim")


@cache
def engine_id(root: Path = ROOT) -> str:
    """Twelve hex digits over the names and bytes of all modules; reports' pages (`reconcile/report`) are left out."""
    found = hashlib.sha256()
    for package in PACKAGES:
        for path in sorted((root / package).rglob("*.py")):
            name = path.relative_to(root).as_posix()
            if not name.startswith("reconcile/report/"):
                found.update(name.encode() + b"\0" + path.read_bytes() + b"\0")
    return found.hexdigest()[:12]
