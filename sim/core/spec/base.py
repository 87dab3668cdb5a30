"""Common base of the specification models."""

from __future__ import annotations

from typing import Annotated

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, StringConstraints
from pydantic_core import PydanticCustomError

SCHEMA_VERSION = 1
MAX_ITEMS = 64
"""Largest number of parts of one kind in a machine: bounds every matrix a request can ask for."""

Name = Annotated[str, StringConstraints(pattern=r"^[a-z][a-z0-9_]{0,39}$")]
Positive = Annotated[float, Field(gt=0, allow_inf_nan=False)]
NonNegative = Annotated[float, Field(ge=0, allow_inf_nan=False)]
Finite = Annotated[float, Field(allow_inf_nan=False)]


def _number(value: object) -> object:
    if isinstance(value, bool | str):
        raise PydanticCustomError("int_type", "must be a whole number: text and truth values are not converted")
    return value


WHOLE = BeforeValidator(_number)
"""With `strict=False` on an integer: 23.0 is a whole number (JSON knows one kind of number), "23" and true are not."""


class SpecModel(BaseModel):
    """Frozen, strict about types (no number from text, no truth value from a number), known keys, finite numbers."""

    model_config = ConfigDict(
        frozen=True, extra="forbid", strict=True, allow_inf_nan=False, use_attribute_docstrings=True
    )
