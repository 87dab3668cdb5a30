"""Which keys a model knows at the place of a finding: what may stand where an unknown key was given."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, get_args

from pydantic import BaseModel


def fields_beside(model: type[BaseModel], loc: Sequence[int | str]) -> tuple[str, ...]:
    """Fields of the part of `model` that holds the last key of `loc`; of all kinds where a part comes in several."""
    parts: list[type[BaseModel]] = [model]
    for step in loc[:-1]:
        if isinstance(step, int):
            continue
        inner = [part.model_fields[step].annotation for part in parts if step in part.model_fields]
        # A step that is no field is the kind that validation puts behind a part of several kinds.
        if inner:
            parts = [found for annotation in inner for found in _models(annotation)]
    return tuple(dict.fromkeys(name for part in parts for name in part.model_fields))


def _models(annotation: Any) -> Iterator[type[BaseModel]]:  # noqa: ANN401 - any annotation
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
        return
    for argument in get_args(annotation):
        yield from _models(argument)
