"""Columns of numbers in text: csv, tsv, blanks; plain or gzipped. The layout is read off the first lines.

A first line of names is used when there is one (and a line of units below it); lines before it are skipped. Between
semicolons, a comma is the decimal sign. An empty cell is a missing sample; at a column's end, the column ends there.
"""

from __future__ import annotations

import gzip
import io
import re
import sys
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from traceback import clear_frames
from typing import BinaryIO, cast

import numpy as np
import pyarrow as pa
import pyarrow.csv as pc

from signals.readers.contents import AnyArray, Contents, Entry, refused, told
from signals.readers.layout import BLANKS, Layout, layout_of
from signals.readers.limits import Bounds
from signals.series import FloatArray

HEAD_BYTES = 2**16
TAIL_BYTES = 2**12
_BLOCK_BYTES = 2**22
RELEASE_TRIES, RELEASE_S = 1000, 0.001
_COLUMN, _ROW = re.compile(r"In CSV column #(\d+): "), re.compile(r"Row #(\d+): ")
"""How Arrow tells a place: columns from 0, rows from 1."""
_EMPTY = ["", "NA", "N/A", "#N/A", "null", "NULL", "None"]


class _Bounded(io.RawIOBase):
    """A stream of at most `limit` bytes once unpacked."""

    def __init__(self, path: Path, raw: BinaryIO, limit: int) -> None:
        super().__init__()
        self._path, self._raw, self._limit, self._seen = path, raw, limit, 0

    def readable(self) -> bool:
        return True

    def readinto(self, buffer: object) -> int:
        view = memoryview(buffer)  # type: ignore[arg-type]
        part = self._raw.read(len(view))
        self._seen += len(part)
        if self._seen > self._limit:
            raise ValueError(f"it holds more than {self._limit} bytes once unpacked")
        view[: len(part)] = part
        return len(part)

    def close(self) -> None:
        self._raw.close()
        super().close()


@contextmanager
def open_file(path: Path, bounds: Bounds) -> Iterator[Contents]:
    """Columns by name, also by number from 0; a file without names has `0`, `1` ..."""
    with told(path), _stream(path, bounds) as stream:
        layout = layout_of(path, stream.read(HEAD_BYTES))
    bounds.check_members(path.name, len(layout.names), "columns")
    read = partial(_read, path, bounds, layout)
    entries = {
        name: Entry(load=partial(_one, read, name), unit=unit)
        for name, unit in zip(layout.names, layout.units, strict=True)
    }
    with told(path):
        said = _last_row(path, layout)
    yield Contents(entries=entries, numbered=True, together=read, remarks=said)


def _last_row(path: Path, layout: Layout) -> tuple[str, ...]:
    """A remark where a file ends without a line end, in a number that is shorter than those above it."""
    if path.suffix.lower() == ".gz":
        return ()
    with path.open("rb") as stream:
        stream.seek(max(0, path.stat().st_size - TAIL_BYTES))
        tail = stream.read(TAIL_BYTES).decode(layout.encoding, errors="replace")
    if tail.endswith(("\n", "\r")):
        return ()
    delimiter = None if layout.delimiter == BLANKS else layout.delimiter
    *above, last = (len(line.split(delimiter)[-1].strip()) for line in tail.splitlines()[1:] or [""])
    if not above or last >= min(above):
        return ()
    return ("the file ends without a line end, in a number shorter than those above it: it may be cut short",)


def _one(read: Callable[[Sequence[str]], Mapping[str, AnyArray]], name: str) -> AnyArray:
    return read([name])[name]


def _stream(path: Path, bounds: Bounds) -> io.BufferedReader:
    raw = gzip.GzipFile(path, "rb") if path.suffix.lower() == ".gz" else path.open("rb")
    return io.BufferedReader(_Bounded(path, cast(BinaryIO, raw), bounds.unpacked_bytes), _BLOCK_BYTES)


def _read(path: Path, bounds: Bounds, layout: Layout, names: Sequence[str]) -> Mapping[str, AnyArray]:
    wanted = [layout.names.index(name) for name in names]
    with told(path), _stream(path, bounds) as stream:
        read = _by_blanks if layout.delimiter == BLANKS else _by_delimiter
        try:
            columns = read(path, bounds, layout, stream, wanted)
        except pa.ArrowInvalid as error:
            raise refused(path, _placed(path, bounds, layout, str(error).splitlines()[0][:300])) from None
    return dict(zip(names, columns, strict=True))


def _placed(path: Path, bounds: Bounds, layout: Layout, reason: str) -> str:
    """What Arrow says, with the column by its name and the line as an editor counts it."""
    row, column = _ROW.search(reason), _COLUMN.match(reason)
    named = column and int(column[1]) < len(layout.names)
    line = _line_of(path, bounds, layout, int(row[1])) if row else 0
    places = [
        *([f"column {layout.names[int(column[1])]}"] if column and named else []),
        *([f"line {line}"] if line else []),
    ]
    rest = _ROW.sub("", _COLUMN.sub("", reason)).removeprefix("CSV parse error: ")
    return ": ".join([", ".join(places), rest.replace("CSV conversion error to double: ", "")] if places else [rest])


def _line_of(path: Path, bounds: Bounds, layout: Layout, row: int) -> int:
    """The line of a row as Arrow counts them: lines above the numbers too, empty ones among these not; 0: none."""
    seen = layout.first_row
    with _stream(path, bounds) as stream:
        for number, line in enumerate(stream, start=1):
            seen += number > layout.first_row and bool(line.rstrip(b"\r\n"))
            if seen == row:
                return number
    return 0


def _by_delimiter(
    path: Path, bounds: Bounds, layout: Layout, stream: io.BufferedReader, wanted: Sequence[int]
) -> list[FloatArray]:
    """Waits at the end until Arrow, which reads ahead in a thread of its own, has let go of the stream: a thread that
    is in Python code when the interpreter ends aborts the process."""
    held = sys.getrefcount(stream)
    try:
        return _parsed(path, bounds, layout, stream, wanted)
    except BaseException as error:
        clear_frames(error.__traceback__)  # they hold the reader
        raise
    finally:
        for _ in range(RELEASE_TRIES):  # counted here as above: the parameter of a function would be one more
            if sys.getrefcount(stream) <= held:
                break
            time.sleep(RELEASE_S)


def _parsed(
    path: Path, bounds: Bounds, layout: Layout, stream: io.BufferedReader, wanted: Sequence[int]
) -> list[FloatArray]:
    keys = [f"c{i}" for i in range(layout.columns)]
    chosen = [keys[i] for i in wanted]
    reader = pc.open_csv(
        stream,
        read_options=pc.ReadOptions(
            use_threads=False,
            block_size=_BLOCK_BYTES,
            skip_rows=layout.first_row,
            column_names=keys,
            encoding=layout.encoding,
        ),
        parse_options=pc.ParseOptions(delimiter=layout.delimiter, ignore_empty_lines=True),
        convert_options=pc.ConvertOptions(
            include_columns=chosen,
            column_types=dict.fromkeys(chosen, pa.float64()),
            null_values=_EMPTY,
            quoted_strings_can_be_null=True,
            decimal_point=layout.decimal,
        ),
    )
    pieces: list[list[FloatArray]] = [[] for _ in wanted]
    ends, rows = [0] * len(wanted), 0
    for batch in reader:
        message = "holds too many samples"
        total = (rows + batch.num_rows) * len(wanted)
        bounds.check(path.name, message=message, given=total, allowed=bounds.values, unit="samples")
        for i, column in enumerate(batch.columns):
            present = np.flatnonzero(column.is_valid().to_numpy(zero_copy_only=False))
            ends[i] = rows + int(present[-1]) + 1 if present.size else ends[i]
            pieces[i].append(column.to_numpy(zero_copy_only=False))  # missing cells become NaN
        rows += batch.num_rows
    return [np.concatenate([np.empty(0), *parts])[:end] for parts, end in zip(pieces, ends, strict=True)]


def _by_blanks(
    path: Path, bounds: Bounds, layout: Layout, stream: io.BufferedReader, wanted: Sequence[int]
) -> list[FloatArray]:
    text = io.TextIOWrapper(stream, encoding=layout.encoding)
    most = bounds.values // len(wanted) + 1
    table = np.loadtxt(text, skiprows=layout.first_row, usecols=wanted, ndmin=2, max_rows=most, comments="#")
    if table.size == 0:
        raise refused(path, "holds no numbers")
    bounds.check(path.name, message="holds too many samples", given=table.size, allowed=bounds.values, unit="samples")
    return [np.ascontiguousarray(table[:, i]) for i in range(len(wanted))]
