"""Which engine made a result: a hash of the source that verdicts depend on."""

from __future__ import annotations

import ast
import hashlib
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Literal

ROOT = Path(__file__).resolve().parent.parent
PACKAGES = ("reconcile", "signals", "sim")
LEVELS = {
    "machine": ("reconcile.machine.engine", "reconcile.grown_turns", "reconcile.unsteady"),
    "kinematics": ("reconcile.kinematics.reconcile", "reconcile.unsteady"),
    "driven": ("reconcile.driven.engine",),
}
"""Where the engine of each level begins; what the entry refuses is no verdict."""
WHOLE = "sim"
"""Package whose effects register themselves: all of it counts."""
TOLD = (
    "reconcile/report/",
    "reconcile/origin.py",
    *(f"reconcile/machine/{name}.py" for name in ("words", "next_look", "pictures", "stages")),
)
"""What only tells an answer, or of what it is: pages, pictures, sentences, the next experiment, names of versions."""


Level = Literal["machine", "kinematics", "driven"]


@cache
def engine_id(level: Level = "machine", root: Path = ROOT) -> str:
    """Twelve hex digits over the names and bytes of all modules that a level's engine imports, but for those that only
    tell its answers."""
    found = hashlib.sha256()
    for path in sorted(modules(level, root)):
        name = path.relative_to(root).as_posix()
        if not name.startswith(TOLD):
            found.update(name.encode() + b"\0" + path.read_bytes() + b"\0")
    return found.hexdigest()[:12]


def modules(level: Level, root: Path = ROOT) -> set[Path]:
    """Files of the modules that the engine of a level imports, directly or not, and all that simulates."""
    found: set[Path] = set((root / WHOLE).rglob("*.py"))
    left = [path for start in LEVELS[level] for path in _files(start, root)]
    left += found
    while left:
        path = left.pop()
        further = {p for name in _imports(path) for p in _files(name, root)} - found
        found |= {path, *further}
        left += further
    return found


def _imports(path: Path) -> Iterator[str]:
    """Names that may be modules."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module is not None:
            yield node.module
            yield from (f"{node.module}.{alias.name}" for alias in node.names)


def _files(name: str, root: Path) -> Iterator[Path]:
    """The file of a module or package, if it is the product's; a package above runs, but decides nothing."""
    if name.split(".", maxsplit=1)[0] in PACKAGES:
        folder = root.joinpath(*name.split("."))
        yield from (p for p in (folder / "__init__.py", folder.with_suffix(".py")) if p.is_file())
