"""Room for a dataset on the disk, asked for before anything is made."""

from __future__ import annotations

import shutil
from pathlib import Path

from sim.core.errors import Problem, SpecError


def free_bytes(folder: Path) -> int:
    """Free for this user on the disk of a folder that need not be there yet."""
    there = next(parent for parent in (folder.absolute(), *folder.absolute().parents) if parent.is_dir())
    return shutil.disk_usage(there).free


def check_space(needed: int, out: Path) -> None:
    """SpecError when the disk of `out` has less than the `needed` bytes, estimated before compression."""
    free = free_bytes(out)
    if needed > free:
        message = f"has too little space: the dataset is estimated at {needed} bytes, {free} are free"
        allowed = "a folder on a larger disk, or fewer recordings"
        raise SpecError(Problem(field="--out", message=message, given=str(out), allowed=allowed))
