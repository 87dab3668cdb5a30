"""Reading JSON strictly (RFC 8259): no NaN or Infinity, no repeated keys, no numbers beyond a double, bounded depth.

An escape may name half of a surrogate pair (RFC 8259, section 8.2): text that no encoding can write and no store keep.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterable, Iterator

_SURROGATE = re.compile("[\ud800-\udfff]")
_ESCAPED = re.compile(rb"\\u[dD][89a-fA-F]")
"""Where there is none, no text can hold a surrogate: UTF-8 has no bytes for them."""
_SHOWN = 80


class NotStrictJson(ValueError):
    """The text is not acceptable JSON; the message says why. `field`: which part of it, dotted, where that is known;
    `given`: what stands there, as it may be written."""

    def __init__(self, message: str, *, field: str = "", given: str | None = None) -> None:
        self.field, self.given = field, given
        super().__init__(message)


def writable(text: str) -> str:
    """The text with lone surrogates as their escapes: what any encoding can write."""
    return _SURROGATE.sub(lambda found: f"\\u{ord(found[0]):04x}", text)


def check(text: bytes, max_depth: int) -> None:
    """Raise NotStrictJson unless the text is acceptable."""
    try:
        document = json.loads(
            text.decode("utf-8"), parse_constant=_constant, parse_float=_float, parse_int=_int, object_pairs_hook=_pairs
        )
    except UnicodeDecodeError as error:
        raise NotStrictJson("the body is not UTF-8 text") from error
    except RecursionError as error:
        raise NotStrictJson(f"the body is nested deeper than {max_depth} levels") from error
    except json.JSONDecodeError as error:
        raise NotStrictJson(
            f"the body is not JSON: {error.msg} at line {error.lineno}, column {error.colno}"
        ) from error
    if _depth(document) > max_depth:
        raise NotStrictJson(f"the body is nested deeper than {max_depth} levels")
    if _ESCAPED.search(text):
        check_unicode(document)


def check_unicode(document: object) -> None:
    """Raise NotStrictJson at the first name or text that holds half of a surrogate pair."""
    for path, text, what in _texts(document):
        found = _SURROGATE.search(text)
        if found:
            half = writable(found[0])
            message = f"{what} {half}, half of a surrogate pair, which cannot be written as Unicode"
            given = text[max(0, found.start() - _SHOWN // 2) :][:_SHOWN]
            raise NotStrictJson(message, field=path, given=writable(given))


def _texts(document: object) -> Iterator[tuple[str, str, str]]:
    """Every text with the path of its field, and every name with that of its object."""
    left: list[tuple[str, object]] = [("", document)]
    while left:
        path, node = left.pop()
        before = f"{path}." if path else ""
        if isinstance(node, str):
            yield path, node, "holds"
        elif isinstance(node, dict):
            yield from ((path, name, "has a name that holds") for name in node)
            left += reversed([(f"{before}{name}", child) for name, child in node.items()])
        elif isinstance(node, list):
            left += reversed([(f"{before}{i}", child) for i, child in enumerate(node)])


def _constant(name: str) -> float:
    raise NotStrictJson(f"{name} is not a JSON number; give a finite number")


def _float(text: str) -> float:
    value = float(text)
    if not math.isfinite(value):
        raise NotStrictJson(f"the number {text[:40]} is too large; give one below 1.8e308")
    return value


def _int(text: str) -> int:
    if len(text) > 40:
        raise NotStrictJson(f"the number {text[:20]}... has too many digits")
    return int(text)


def _pairs(pairs: list[tuple[str, object]]) -> dict[str, object]:
    document = dict(pairs)
    if len(document) != len(pairs):
        raise NotStrictJson(f"the key {twice(name for name, _ in pairs)[:80]!r} appears twice in one object")
    return document


def twice(names: Iterable[str]) -> str:
    """The first name that was there before, in one pass, as an object may have a million; ValueError without one."""
    seen: set[str] = set()
    for name in names:
        if name in seen:
            return name
        seen.add(name)
    raise ValueError("none of the names appears twice")


def _depth(document: object) -> int:
    deepest, level = 0, [document]
    while level:
        containers = [node for node in level if isinstance(node, dict | list)]
        if not containers:
            break
        deepest += 1
        level = [child for node in containers for child in (node.values() if isinstance(node, dict) else node)]
    return deepest
