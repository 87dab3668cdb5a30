"""What the tests of the house look at: the committed files, and the configuration."""

from __future__ import annotations

import subprocess
import tomllib
from functools import cache
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]


@cache
def tracked() -> tuple[Path, ...]:
    """Committed files that exist, relative to the root; without a repository, every file outside hidden folders."""
    told = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=False)
    if told.returncode == 0 and told.stdout:
        names = [Path(name) for name in told.stdout.split("\0") if name]
    else:
        names = [path.relative_to(ROOT) for path in ROOT.rglob("*") if path.is_file()]
        names = [name for name in names if not any(part.startswith(".") for part in name.parts[:-1])]
    return tuple(sorted(name for name in names if (ROOT / name).is_file()))


@cache
def text(name: Path) -> str | None:
    """Contents of a tracked file; None when it is not text."""
    try:
        return (ROOT / name).read_text(encoding="utf-8")
    except UnicodeDecodeError:
        return None


@cache
def configuration() -> dict[str, Any]:
    """pyproject.toml."""
    return tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))


def sources() -> tuple[Path, ...]:
    """Python files of the product and its studies: no tests."""
    return tuple(name for name in tracked() if name.suffix == ".py" and name.parts[0] != "tests")


def packages() -> tuple[str, ...]:
    """Top-level packages with code in them."""
    return tuple(sorted({name.parts[0] for name in sources() if len(name.parts) > 1}))
