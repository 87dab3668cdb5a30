"""A misspelt key hides what stands under it and every rule between fields: both are looked for behind it too."""

from __future__ import annotations

import copy
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any, TypeVar

from sim.core.errors import Problem, SpecError
from sim.core.near import likest

Read = TypeVar("Read")
UNKNOWN = "is not a known field"
ROOT = "machine"


def told_behind_slips(read: Callable[[Mapping[str, object]], Read], form: Mapping[str, object]) -> Read:
    """What `read` makes of the form; SpecError also with what it would find if every unknown key were put right.

    A key that is like one that is missing is read as that, and what is found there is told under the key as written;
    any other is left out. Problems keep their order, those behind slips come last.
    """
    try:
        return read(form)
    except SpecError as error:
        first = error.problems
    mended, names = _mended(form, [p for p in first if p.message.startswith(UNKNOWN)])
    if mended is None:
        raise SpecError(first)
    told = {p.field for p in first}
    try:
        read(mended)
    except SpecError as error:
        behind = [replace(p, field=_as_written(p.field, names)) for p in error.problems]
        raise SpecError([*first, *(p for p in behind if p.field not in told)]) from None
    raise SpecError(first)


def _mended(
    form: Mapping[str, object], slips: Sequence[Problem]
) -> tuple[Mapping[str, object] | None, Mapping[str, str]]:
    """A copy without unknown keys, and how those that were read as others were written, by place; None: no slip."""
    mended, names = copy.deepcopy(dict(form)), {}
    found = False
    for slip in slips:
        *path, key = slip.field.removeprefix(f"{ROOT}.").split(".")
        part = _at(mended, path)
        if not isinstance(part, dict) or key not in part:
            continue
        found, content = True, part.pop(key)
        alike = [name for name in likest(key, slip.allowed.split(", ")) if name not in part]
        if len(alike) == 1:
            part[alike[0]] = content
            names[".".join((ROOT, *path, alike[0]))] = slip.field
    return (mended if found else None), names


def _at(part: Any, path: Sequence[str]) -> Any:  # noqa: ANN401 - any JSON value
    for step in path:
        if isinstance(part, list) and step.isdigit() and int(step) < len(part):
            part = part[int(step)]
        elif isinstance(part, dict) and step in part:
            part = part[step]
        else:
            return None
    return part


def _as_written(field: str, names: Mapping[str, str]) -> str:
    return next(_renamed(field, names), field)


def _renamed(field: str, names: Mapping[str, str]) -> Iterator[str]:
    for read_as, written in names.items():
        if field == read_as or field.startswith(f"{read_as}."):
            yield written + field.removeprefix(read_as)
