"""Which keys a model knows at the place of a finding, and what is expected of one that is missing."""

from __future__ import annotations

import types
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

SIGNS = (("gt", ">"), ("ge", ">="), ("lt", "<"), ("le", "<="))
MOST_TOLD = 140
"""Characters of a field's own description that are told."""
MOST_NAMED = 8
"""Fields of a part that are told where the part itself is missing."""


def fields_beside(model: type[BaseModel], loc: Sequence[int | str]) -> tuple[str, ...]:
    """Fields of the part of `model` that holds the last key of `loc`; of all kinds where a part comes in several."""
    return tuple(dict.fromkeys(name for part in _parts(model, loc) for name in part.model_fields))


def expected_at(model: type[BaseModel], loc: Sequence[int | str]) -> str:
    """What the field at `loc` takes: `a number > 0`, `text`, `an object with shaft, speed_hz`; empty if not known."""
    if not loc:
        return f"an object with {', '.join(list(model.model_fields)[:MOST_NAMED])}"
    if isinstance(loc[-1], int):
        return ""
    found = [part.model_fields[loc[-1]] for part in _parts(model, loc) if loc[-1] in part.model_fields]
    if not found:
        return ""
    told = (found[0].description or "").replace("\n", " ")
    words = _expected(found[0].annotation, found[0])
    if not words:
        return told.rstrip(".")
    return f"{words} ({told.rstrip('.')})" if 0 < len(told) <= MOST_TOLD else words


def _expected(annotation: Any, field: FieldInfo | None = None) -> str:  # noqa: ANN401, PLR0911 - any annotation
    origin, inner = get_origin(annotation), get_args(annotation)
    if origin in (Union, types.UnionType):
        return " or ".join(dict.fromkeys(filter(None, (_expected(a) for a in inner if a is not type(None)))))
    if origin is Literal:
        return ", ".join(map(str, inner))
    if hasattr(annotation, "__metadata__"):
        return _expected(inner[0]) + _bounds(annotation.__metadata__)
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return f"an object with {', '.join(list(annotation.model_fields)[:MOST_NAMED])}"
    if origin in (list, tuple, Sequence):
        items = _expected(inner[0]) if inner else ""
        return f"a list, each {items}" if items else "a list"
    if origin in (dict, Mapping):
        return "an object"
    plain = {bool: "true or false", int: "a whole number", float: "a number", str: "text"}
    return plain.get(annotation, "") + (_bounds(field.metadata) if field is not None else "")


def _bounds(metadata: Sequence[Any]) -> str:
    """` > 0, <= 1e5`: bounds stand in annotated-types' marks or in pydantic's own fields, which hold such marks."""
    marks = [m for entry in metadata for m in (entry.metadata if isinstance(entry, FieldInfo) else [entry])]
    told = [f"{sign} {getattr(m, key):g}" for m in marks for key, sign in SIGNS if getattr(m, key, None) is not None]
    return " " + ", ".join(told) if told else ""


def _parts(model: type[BaseModel], loc: Sequence[int | str]) -> list[type[BaseModel]]:
    """The models that hold the last key of `loc`."""
    parts: list[type[BaseModel]] = [model]
    for step in loc[:-1]:
        if isinstance(step, int):
            continue
        inner = [part.model_fields[step].annotation for part in parts if step in part.model_fields]
        # A step that is no field is the kind that validation puts behind a part of several kinds.
        if inner:
            parts = [found for annotation in inner for found in _models(annotation)]
    return parts


def _models(annotation: Any) -> Iterator[type[BaseModel]]:  # noqa: ANN401 - any annotation
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
        return
    for argument in get_args(annotation):
        yield from _models(argument)
