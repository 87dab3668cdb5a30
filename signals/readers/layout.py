"""How a text file lays out its columns, read off its first lines."""

from __future__ import annotations

import codecs
import csv
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from signals.readers.contents import refused
from signals.units import find_unit

BLANKS = " "
_DELIMITERS = ("\t", ";", ",", BLANKS)
_COMMENT = ("#", "%")


@dataclass(frozen=True, kw_only=True)
class Layout:
    """`first_row`: lines to skip before the numbers; `units`: those the file states, else empty."""

    delimiter: str
    decimal: str
    encoding: str
    first_row: int
    columns: int
    names: tuple[str, ...]
    units: tuple[str, ...]


def layout_of(path: Path, head: bytes) -> Layout:
    """The layout; SpecError when no line of numbers is among the first ones."""
    lines, encoding = _lines(head)
    for number, line in enumerate(lines):
        cells, delimiter, decimal = _numbers(line)
        if cells:
            above = [(i, _split(text, delimiter)) for i, text in enumerate(lines[:number]) if _is_text(text)]
            names, units = _titles(path, above, len(cells))
            return Layout(
                delimiter=delimiter,
                decimal=decimal,
                encoding=encoding,
                first_row=number,
                columns=len(cells),
                names=names,
                units=units,
            )
    raise refused(path, "no line of numbers among its first ones")


def _lines(head: bytes) -> tuple[list[str], str]:
    text, encoding = "", "utf-8"
    try:
        # the last character may be cut
        text = codecs.getincrementaldecoder("utf-8")().decode(head.removeprefix(codecs.BOM_UTF8))
    except UnicodeDecodeError:
        text, encoding = head.decode("latin-1"), "latin-1"
    lines = text.splitlines()
    return (lines[:-1] if len(lines) > 1 and not text.endswith(("\n", "\r")) else lines), encoding


def _is_text(line: str) -> bool:
    return bool(line.strip()) and not line.lstrip().startswith(_COMMENT)


def _split(line: str, delimiter: str) -> list[str]:
    if delimiter == BLANKS:
        return line.split()
    return [cell.strip() for cell in next(csv.reader([line], delimiter=delimiter), [])]


def _numbers(line: str) -> tuple[list[str], str, str]:
    """Cells, delimiter and decimal sign of a line that holds numbers only; no cells when it does not."""
    if not _is_text(line):
        return [], "", "."
    for delimiter in _DELIMITERS:
        cells = _split(line, delimiter)
        # a comma between digits of a single cell may part two columns as well
        for decimal in ".," if delimiter in (";", "\t") and len(cells) > 1 else ".":
            if any(cells) and all(not cell or _is_number(cell, decimal) for cell in cells):
                return cells, delimiter, decimal
    return [], "", "."


def _is_number(cell: str, decimal: str) -> bool:
    if "_" in cell or (decimal == "," and "." in cell):
        return False
    try:
        float(cell.replace(",", ".") if decimal == "," else cell)
    except ValueError:
        return False
    return True


def _titles(
    path: Path, above: Sequence[tuple[int, list[str]]], columns: int
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Names and units over the numbers: the last text line, or the last but one when units stand below it."""
    if not above:
        return tuple(str(i) for i in range(columns)), ("",) * columns
    row, cells = above[-1]
    below: list[str] = []
    if len(above) > 1 and len(above[-2][1]) == len(cells) and all(not c or find_unit(c) for c in cells):
        below, (row, cells) = cells, above[-2]
    if any(_is_number(cell, ".") for cell in cells if cell):
        raise refused(path, f"line {row + 1} holds a text where a number is expected")
    if len(cells) != columns:
        raise refused(path, f"{len(cells)} names in line {row + 1}, {columns} columns below")
    names, units = [], []
    for i, cell in enumerate(cells):
        plain, unit = _with_unit(cell)
        names.append(plain if plain and plain not in names else f"{plain or 'column'} ({i})")
        units.append(below[i] if below else unit)
    return tuple(names), tuple(units)


def _with_unit(cell: str) -> tuple[str, str]:
    """`a [m/s^2]` is the column `a` with its unit."""
    if cell.endswith("]") and " [" in cell:
        name, _, unit = cell[:-1].rpartition(" [")
        return name.strip(), unit.strip()
    return cell, ""
