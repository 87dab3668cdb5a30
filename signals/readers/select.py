"""From a description's `column` to an array of the file and the part of it that is meant."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np

from signals.names import matlab_name
from signals.readers.contents import AnyArray, Contents
from signals.series import FloatArray
from sim.core.errors import Problem, SpecError

_INDEXED = re.compile(r"^(?P<name>.+?)\s*\[\s*(?P<index>[:\d]+(?:\s*,\s*[:\d]+)?)\s*\]$")
_NUMBERED = re.compile(r"^(?P<name>.+)\.(?P<number>[1-9]\d{0,3})$")
_SHOWN = 40


@dataclass(frozen=True, kw_only=True)
class Pick:
    """Row or column `index` of the array `name`: `axis` 0 a row, 1 a column, None the shorter way round.

    `index` None: the whole array, which must then be one channel.
    """

    name: str
    index: int | None = None
    axis: int | None = None


def pick(contents: Contents, column: str | int, field: str) -> Pick:
    """The array that a column means; SpecError lists what the file holds."""
    found = _by_number(contents, column) if isinstance(column, int) else _by_name(contents, column)
    if found is None:
        names = [_parts(name, entry.shape) for name, entry in contents.entries.items()]
        listed = ", ".join(names[:_SHOWN]) + (" ..." if len(names) > _SHOWN else "")
        message = "is not in the file"
        raise SpecError(Problem(field=field, message=message, given=column, allowed=listed or "nothing: no numbers"))
    return found


def _parts(name: str, shape: tuple[int, ...] | None) -> str:
    """How the channels of an array are named: of a table, rows or columns, its shorter side."""
    if shape is None or len(shape) != 2 or min(shape) < 2:
        return name
    return f"{name}[0] to {name}[{min(shape) - 1}]"


def only_array(contents: Contents) -> str | None:
    """The file's one array that is more than a number, if there is just one."""
    arrays = [name for name, e in contents.entries.items() if e.shape is None or int(np.prod(e.shape)) > 1]
    return arrays[0] if len(arrays) == 1 else None


def _by_number(contents: Contents, column: int) -> Pick | None:
    names = list(contents.entries)
    if contents.numbered:
        return Pick(name=names[column]) if column < len(names) else None
    alone = only_array(contents)
    return None if alone is None else Pick(name=alone, index=column)


def _by_name(contents: Contents, column: str) -> Pick | None:
    column = contents.aliases.get(column, column)
    if column in contents.entries:
        return Pick(name=column)
    indexed = _INDEXED.match(column)
    if indexed and indexed["name"] in contents.entries:
        return _indexed(indexed["name"], [part.strip() for part in indexed["index"].split(",")])
    numbered = _NUMBERED.match(column)
    if numbered and numbered["name"] in contents.entries:
        return Pick(name=numbered["name"], index=int(numbered["number"]) - 1)
    # a heading with its unit, as `a [g]`, whose unit the reader took off; a name that MATLAB does not allow
    bare = column.rpartition(" [")[0].strip() if column.endswith("]") and not indexed else ""
    return next((Pick(name=name) for name in (bare, matlab_name(column)) if name in contents.entries), None)


def _indexed(name: str, parts: list[str]) -> Pick | None:
    if len(parts) == 2 and parts.count(":") == 1:
        axis = 1 if parts[0] == ":" else 0
        return Pick(name=name, index=int(parts[axis]), axis=axis) if parts[axis].isdigit() else None
    if parts == [":"]:
        return Pick(name=name)
    return Pick(name=name, index=int(parts[0])) if len(parts) == 1 and parts[0].isdigit() else None


def take(array: AnyArray, chosen: Pick, field: str) -> FloatArray:
    """The channel's samples, shape (n,), float64."""
    if chosen.index is not None:
        if array.ndim != 2:
            message = "has an index, but the array has no second axis"
            raise SpecError(Problem(field=field, message=message, given=f"shape {array.shape}", allowed=chosen.name))
        axis = chosen.axis if chosen.axis is not None else int(array.shape[0] > array.shape[1])
        if chosen.index >= array.shape[axis]:
            allowed = f"0 to {array.shape[axis] - 1}"
            message = f"is beyond the array {chosen.name} of shape {array.shape}"
            raise SpecError(Problem(field=field, message=message, given=chosen.index, allowed=allowed))
        array = array[chosen.index] if axis == 0 else array[:, chosen.index]
    elif array.ndim > 1:
        wide = [n for n in array.shape if n > 1]
        if len(wide) > 1:
            message = f"{chosen.name} has shape {array.shape}: say which part is the channel"
            raise SpecError(
                Problem(field=field, message=message, allowed=f"{chosen.name}[:,0], {chosen.name}[0,:] ...")
            )
        array = array.reshape(-1)
    return np.atleast_1d(array).astype(np.float64)
