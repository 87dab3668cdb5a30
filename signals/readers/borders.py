"""Borders of the datasets of a universal file: lines of -1, of which data may hold some too.

SDRC, "Universal file datasets": each dataset stands between two lines with -1 in columns 5 and 6; its first line is its
number. Parsers take any line of -1 for a border.
"""

from __future__ import annotations

import re

MARK = b"\xef\xbb\xbf"
"""Byte order mark, which text tools put before a file."""
_LINE = re.compile(rb"^ {4}-1[ \t]*\r?$", re.MULTILINE)
_ENDS_AS_ONE = re.compile(rb" {4}-1(?=[\r\n]|$| {74})")
_NUMBER = re.compile(rb"\s*\d+b?[ \t\d]*\r?$", re.MULTILINE)
_HIDDEN = b"-1    "


def without_mark(content: bytes) -> bytes:
    """The content, its byte order mark taken off."""
    return content.removeprefix(MARK)


def is_binary(content: bytes) -> bool:
    """Whether a dataset is one of those whose bytes may look like anything."""
    return re.search(rb"^\s*58b", content, re.MULTILINE) is not None


def borders(content: bytes) -> tuple[list[int], bool]:
    """Where the lines begin that are borders, and whether the last dataset has an end.

    In a dataset a line of -1 is its end if nothing or another such line follows, else it is data. Where they are even
    and numbers follow every second one, all count: a writer may add lines of its own between datasets.
    """
    lines = [(m.start(), m.end()) for m in _LINE.finditer(content)]
    if len(lines) % 2 == 0 and all(_NUMBER.match(content, end) for _, end in lines[::2]):
        return [start for start, _ in lines], True
    found, inside = [], False
    for i, (start, end) in enumerate(lines):
        following = lines[i + 1][0] if i + 1 < len(lines) else len(content)
        if not inside or not content[end:following].strip():
            found.append(start)
            inside = not inside
    return found, not inside


def without_false_borders(content: bytes) -> bytes | None:
    """The content with -1 moved to the margin in lines that only look like borders; None where there are none."""
    true = set(borders(content)[0])
    false = [m.start() for m in _ENDS_AS_ONE.finditer(content) if m.start() not in true]
    if not true or not false:
        return None
    mended = bytearray(content)
    for at in false:
        mended[at : at + len(_HIDDEN)] = _HIDDEN
    return bytes(mended)
