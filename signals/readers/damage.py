"""Whether a file is whole and of its kind, told by its own beginning, lengths and end, before its parser sees it.

Parsers read on where a file breaks off, or fail in words of their own. What can be told cheaply is told here: an empty
file, one of another kind under this name, one that ends before the length which it states.
"""

from __future__ import annotations

import re
import struct
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import BinaryIO

from signals.readers.borders import borders, is_binary, without_mark
from signals.readers.formats import HDF5_SIGNATURE, hdf5_begins, suffix_of
from signals.readers.riff import OPEN_ENDED, samples_of

_UNKNOWN = (0, 2**32 - 1, 2**64 - 1)
"""Lengths that writers leave where they do not know them (a stream, a logger that was stopped)."""
_MAT_HEADER, _MAT4_HEADER = 128, 20
_MAT4_BYTES = {0: 8, 1: 4, 2: 4, 3: 2, 4: 2, 5: 1}
_MOST_PARTS = 100_000
_SCAN_BYTES = 2**28


def damage(path: Path) -> str:
    """What is wrong with the file as a whole, after `it ...`; empty where nothing can be told (or it is a text)."""
    suffix = suffix_of(path)
    if suffix not in _CHECKS or not path.is_file():
        return ""
    kind, check = _CHECKS[suffix]
    size = path.stat().st_size
    if size == 0:
        return "is empty (0 bytes)"
    with path.open("rb") as stream:
        found = check(stream, size)
    return found.format(kind=kind)


_FOREIGN = "does not begin as a {kind} file does: it is damaged, or of another kind"


def _cut(size: int, needed: int) -> str:
    return f"is cut short or damaged: {size} bytes are there, its own lengths need {needed}" if size < needed else ""


def _mat(stream: BinaryIO, size: int) -> str:
    """Levels 4 and 5 (MathWorks, "MAT-File Format"): each element states its length; 7.3 is HDF5."""
    head = stream.read(_MAT_HEADER)
    if b"\0" in head[:4]:
        return _mat4(stream, size) if any(head[:_MAT4_HEADER]) else _FOREIGN
    if HDF5_SIGNATURE[:4] in head[:4] or head.startswith(b"MATLAB 7.3"):
        return _hdf5(stream, size)
    if size < _MAT_HEADER and head.startswith(b"MATLAB"):
        return _cut(size, _MAT_HEADER)
    order = {b"IM": "<", b"MI": ">"}.get(head[126:128])
    return _FOREIGN if order is None else _mat5(stream, size, order)


def _mat5(stream: BinaryIO, size: int, order: str) -> str:
    at = _MAT_HEADER
    for _ in range(_MOST_PARTS):
        stream.seek(at)
        tag = stream.read(8)
        if len(tag) < 8:
            return _cut(size, at + 8) if tag else ""
        at += 8 + struct.unpack(f"{order}II", tag)[1]
        if at > size:
            return _cut(size, at)
    return ""


def _mat4(stream: BinaryIO, size: int) -> str:
    at = 0
    for _ in range(_MOST_PARTS):
        stream.seek(at)
        head = stream.read(_MAT4_HEADER)
        if not head:
            return ""
        if len(head) < _MAT4_HEADER:
            return _cut(size, at + _MAT4_HEADER)
        order = "<" if struct.unpack("<I", head[:4])[0] <= 5000 else ">"
        kind, rows, columns, imaginary, name = struct.unpack(f"{order}5I", head)
        item = _MAT4_BYTES.get(kind // 10 % 10)
        if kind > 5000 or item is None or kind % 10 == 2:  # sparse ones are left to the parser
            return ""
        at += _MAT4_HEADER + name + rows * columns * item * (2 if imaginary else 1)
        if at > size:
            return _cut(size, at)
    return ""


def _hdf5(stream: BinaryIO, size: int) -> str:
    """Superblock, HDF5 File Format Specification 3.0, II.A: its end-of-file address."""
    at = hdf5_begins(stream, size)
    if at is None:
        return _cut(size, 1024) if size < 520 else _FOREIGN
    stream.seek(at)
    block = stream.read(64)
    if len(block) < 64:
        return _cut(size, at + 64)
    version = block[8]
    end = {0: 40, 1: 44, 2: 28, 3: 28}.get(version)
    if end is None or block[13 if version < 2 else 9] != 8:
        return ""
    (stated,) = struct.unpack("<Q", block[end : end + 8])
    return "" if stated in _UNKNOWN else _cut(size, stated)


def _wave(stream: BinaryIO, size: int) -> str:
    head = stream.read(12)
    if head[:4] not in (b"RIFF", b"RIFX", b"RF64") or head[8:] != b"WAVE":
        return _FOREIGN if len(head) == 12 or not b"RIFF".startswith(head[:4]) else _cut(size, 44)
    found = samples_of(stream)
    if found is None:
        return "is cut short: no samples are in it"
    return "" if found.length in (0, *OPEN_ENDED) else _cut(size, found.at + found.length)


def _zip(stream: BinaryIO, _size: int) -> str:
    if stream.read(2) != b"PK":
        return _FOREIGN
    return "" if zipfile.is_zipfile(stream) else "is cut short: the directory at its end is missing"


def _parquet(stream: BinaryIO, size: int) -> str:
    if stream.read(4) != b"PAR1":
        return _FOREIGN
    stream.seek(max(size - 4, 4))
    return "" if stream.read(4) == b"PAR1" else "is cut short: the description at its end is missing"


def _tdms(stream: BinaryIO, size: int) -> str:
    """Segments with their lead-ins (National Instruments, "TDMS File Format Internal Structure")."""
    at = 0
    for _ in range(_MOST_PARTS):
        stream.seek(at)
        lead = stream.read(28)
        if not lead:
            return ""
        if lead[:4] != b"TDSm"[: len(lead)]:
            return _FOREIGN if at == 0 else "is damaged: what follows a segment is none"
        if len(lead) < 28:
            return _cut(size, at + 28)
        order = ">" if lead[4] & 0x40 else "<"
        (length,) = struct.unpack(f"{order}Q", lead[12:20])
        if length in _UNKNOWN:
            return ""  # its writer was stopped: what is there is read
        at += 28 + length
        if at > size:
            return _cut(size, at)
    return ""


def _uff(stream: BinaryIO, size: int) -> str:
    """Datasets stand between lines of -1."""
    head = without_mark(stream.read(4096))
    if not re.match(rb"\s*-1\s", head):
        return _FOREIGN
    if size > _SCAN_BYTES:
        return ""
    stream.seek(0)
    content = without_mark(stream.read())
    return "" if is_binary(content) or borders(content)[1] else "is cut short: its last dataset has no end"


def _begins(*signatures: bytes) -> Callable[[BinaryIO, int], str]:
    def check(stream: BinaryIO, _size: int) -> str:
        head = stream.read(8)
        return "" if any(head.startswith(s) for s in signatures) else _FOREIGN

    return check


def _text(stream: BinaryIO, _size: int) -> str:
    """Nothing is asked of a text but that it is none of what is often saved under such a name."""
    head = stream.read(1024)
    if head.startswith(b"PK\x03\x04"):
        return "is an archive (zip, or a spreadsheet), not a text: unpack it, or save it as {kind}"
    if head.lstrip(b"\xef\xbb\xbf \t\r\n").lower().startswith((b"<!doctype html", b"<html")):
        return "is an HTML page, not data: perhaps what a failed download left"
    return ""


_CHECKS: dict[str, tuple[str, Callable[[BinaryIO, int], str]]] = {
    **dict.fromkeys((".csv", ".tsv", ".txt", ".dat"), ("csv", _text)),
    ".mat": ("MATLAB", _mat),
    ".h5": ("HDF5", _hdf5),
    ".hdf5": ("HDF5", _hdf5),
    ".wav": ("WAV", _wave),
    ".npz": ("npz", _zip),
    ".parquet": ("Parquet", _parquet),
    ".tdms": ("TDMS", _tdms),
    ".uff": ("universal", _uff),
    ".unv": ("universal", _uff),
    ".mf4": ("MDF", _begins(b"MDF ", b"UnFinMF")),
    ".flac": ("FLAC", _begins(b"fLaC", b"ID3")),
}
