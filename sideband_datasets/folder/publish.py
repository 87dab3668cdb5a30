"""How a folder that is being made becomes a dataset: held by one command, checked, then renamed whole.

A command may be killed at any moment. Until the state is gone `resume` makes again whatever is damaged; the state goes
when everything the manifest lists is on the disk, what is made last in it, and from then on `resume` needs nothing but
the manifest. The lock is on the folder itself, so that it is there as long as the folder is, and leaves no file.
"""

from __future__ import annotations

import contextlib
import fcntl
import json
import os
from collections.abc import Iterator
from pathlib import Path

from sideband_datasets.folder.finding import Finding
from sideband_datasets.folder.layout import DATA, MANIFEST, SETTINGS, STATE, files_below, remove, synced
from sideband_datasets.folder.listed import file_findings, surplus
from sim.core.errors import Problem, SpecError

MOST_NAMED = 3


def check_free(out: Path) -> None:
    """SpecError when something is where the dataset shall be; an empty folder is nothing."""
    if out.exists() and (not out.is_dir() or any(out.iterdir())):
        raise SpecError(Problem(field="--out", message="is there already", given=str(out), allowed="a new folder"))


def check_not_begun(folder: Path, out: Path) -> None:
    """SpecError when the folder `out` is made in holds any file, whatever it is."""
    if folder.exists() and (not folder.is_dir() or files_below(folder)):
        message = f"was begun already{_of_recipe(folder)}: {folder.name} is not empty"
        allowed = f"`sideband dataset resume {out}`, or another --out"
        raise SpecError(Problem(field="--out", message=message, given=str(out), allowed=allowed))


def _of_recipe(folder: Path) -> str:
    """Which dataset an unfinished folder is to be, where that can be read."""
    with contextlib.suppress(OSError, ValueError, KeyError, TypeError):
        begun = json.loads((folder / STATE / SETTINGS).read_text(encoding="utf-8"))
        recipe, kind = begun["recipe"], begun["format"]
        return f" as {recipe['name']} (seed {recipe['seed']}, {recipe['count']} recordings, {kind})"
    return ""


@contextlib.contextmanager
def alone(folder: Path) -> Iterator[None]:
    """One command at a time; the lock goes with its process, however that ends."""
    busy = Problem(field="--out", message="is being made by another command", given=folder.name)
    try:
        handle = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    except OSError as error:
        raise SpecError(busy) from error
    try:
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
            # Not one that took its final name meanwhile.
            same = os.path.samestat(os.fstat(handle), folder.stat())
        except OSError as error:
            raise SpecError(busy) from error
        if not same:
            raise SpecError(busy)
        yield
    finally:
        os.close(handle)


def sweep(folder: Path) -> None:
    """Remove what killed commands left under no name of its own."""
    for place in (folder, folder / DATA, folder / STATE):
        for left in list(place.glob(".*")):
            remove(left)


def manifest_of(folder: Path) -> dict[str, object] | None:
    """The manifest; None when there is none that can be read."""
    try:
        found = json.loads((folder / MANIFEST).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    return found if isinstance(found, dict) else None


def damage(folder: Path, manifest: dict[str, object]) -> list[Finding]:
    """What keeps a folder from being the dataset of its manifest; its state, if it is still there, is no part of it."""
    try:
        found = [finding for finding in file_findings(folder, manifest) if not finding.where.startswith(f"{STATE}/")]
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        return [Finding(where=MANIFEST, what=f"cannot be read: {error!r}")]
    return found


def refused(out: Path, found: list[Finding]) -> SpecError:
    """Of a folder that cannot be published, with the places."""
    told = "; ".join(map(str, found[:MOST_NAMED])) + " ..." * (len(found) > MOST_NAMED)
    allowed = f"remove {out.name}.partial and make the dataset anew"
    return SpecError(Problem(field="--out", message=f"cannot be finished: {told}", given=str(out), allowed=allowed))


def publish(folder: Path, out: Path, manifest: dict[str, object]) -> None:
    """The finished folder takes its name, whole. SpecError, and nothing is changed, when it holds other files too."""
    check_free(out)
    sweep(folder)
    others = list(surplus(folder, manifest, made=True))
    if others:
        named = ", ".join(finding.where for finding in others[:MOST_NAMED])
        message = f"holds what is no part of it: {named}"
        raise SpecError(Problem(field="--out", message=message, given=folder.name, allowed="move it away, and resume"))
    synced(folder)
    drop_state(folder)
    folder.replace(out.absolute())
    synced(out.absolute())


def drop_state(folder: Path) -> None:
    """Remove the state; what is made is last, so that any part of the rest can be made again."""
    for path in list((folder / STATE).glob("*")):
        if path.name != SETTINGS:
            remove(path)
    remove(folder / STATE)
