"""Reading JSON strictly (RFC 8259): no NaN or Infinity, no repeated keys, no numbers beyond a double, bounded depth."""

from __future__ import annotations

import json
import math


class NotStrictJson(ValueError):
    """The text is not acceptable JSON; the message says why."""


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
        names = [name for name, _ in pairs]
        twice = next(name for name in names if names.count(name) > 1)
        raise NotStrictJson(f"the key {twice[:80]!r} appears twice in one object")
    return document


def _depth(document: object) -> int:
    deepest, level = 0, [document]
    while level:
        containers = [node for node in level if isinstance(node, dict | list)]
        if not containers:
            break
        deepest += 1
        level = [child for node in containers for child in (node.values() if isinstance(node, dict) else node)]
    return deepest
