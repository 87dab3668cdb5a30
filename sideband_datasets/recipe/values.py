"""Values a recipe draws: a fixed one, a range, one of several, or a factor on what the machine has."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Literal, Self

from pydantic import BeforeValidator, Discriminator, Field, Tag, model_validator
from pydantic_core import PydanticCustomError

from sim.core.errors import Problem, SpecError
from sim.core.spec import SpecModel

Number = Annotated[float, Field(ge=-1e15, le=1e15)]
Levels = Annotated[int, Field(ge=2, le=100)]
LEVELS = 3
"""Levels of a range in a factorial plan, unless it says."""


RANGE = '{"low": 10, "high": 20}'
CHOICE = '{"choices": [10, 20]}'


def wrong(message: str, allowed: str, given: str, *, field: str = "") -> PydanticCustomError:
    """What is allowed, what was given in words of its own, and, of a whole, which field it is about."""
    told = {"message": message, "expected": allowed, "given": given}
    return PydanticCustomError("value", "{message}", told | ({"field": field} if field else {}))


class Range(SpecModel):
    """From `low` to `high`, evenly or evenly in its logarithm."""

    low: Number
    high: Number
    scale: Literal["linear", "log"] = "linear"
    levels: Levels = LEVELS
    """In a factorial plan, both ends included."""

    @model_validator(mode="after")
    def _ordered(self) -> Self:
        if not self.low <= self.high:
            raise wrong("`low` is above `high`", "`low` at or below `high`", f"{self.low:g} and {self.high:g}")
        if self.scale == "log" and self.low <= 0:
            raise ValueError("a logarithmic range begins above zero")
        return self


def _as_tuple(value: object) -> object:
    return tuple(value) if isinstance(value, list) else value


class Factor(SpecModel):
    """The machine's own value times a factor between two numbers, evenly in its logarithm."""

    factor: Annotated[tuple[Number, Number], BeforeValidator(_as_tuple)]
    levels: Levels = LEVELS

    @model_validator(mode="after")
    def _ordered(self) -> Self:
        low, high = self.factor
        if not 0 < low <= high:
            message = "the two factors must be above zero, the smaller one first"
            raise wrong(message, "0 < first <= second", f"{low:g} and {high:g}")
        return self


Item = bool | Number | Annotated[str, Field(max_length=200)]


class Choice(SpecModel):
    """One of several, each as likely."""

    choices: Annotated[tuple[Item, ...], BeforeValidator(_as_tuple), Field(min_length=1, max_length=1000)]


Fixed = bool | Number | Annotated[str, Field(max_length=200)]
TAGS = ("fixed", "range", "factor", "choice")


def _kind(value: object) -> str:
    if isinstance(value, Range | Factor | Choice):
        return type(value).__name__.lower()
    if not isinstance(value, Mapping):
        return "fixed"
    return "choice" if "choices" in value else "factor" if "factor" in value else "range"


def _no_list(value: object) -> object:
    if isinstance(value, list | tuple):
        numbers = ", ".join(f"{item:g}" if isinstance(item, int | float) else str(item)[:40] for item in value[:8])
        allowed = f"one value, a range {RANGE}, or choices {CHOICE}"
        raise wrong("is a list, which may be a range or choices", allowed, f"[{numbers}{', ...' * (len(value) > 8)}]")
    return value


Value = Annotated[
    Annotated[Fixed, Tag("fixed")]
    | Annotated[Range, Tag("range")]
    | Annotated[Factor, Tag("factor")]
    | Annotated[Choice, Tag("choice")],
    Discriminator(_kind),
    BeforeValidator(_no_list),
]
Drawn = bool | float | str


def levels_of(value: Value) -> int:
    """Levels in a factorial plan."""
    if isinstance(value, Choice):
        return len(value.choices)
    return value.levels if isinstance(value, Range | Factor) and ends_of(value)[0] < ends_of(value)[1] else 1


def ends_of(value: Range | Factor) -> tuple[float, float]:
    """Smallest and largest."""
    return (value.low, value.high) if isinstance(value, Range) else value.factor


def drawn(value: Value, share: float, own: object, field: str) -> Drawn:
    """The value at a point `share` (0 to 1) of its range; `own` is what the machine has there, for factors."""
    if isinstance(value, Choice):
        return value.choices[min(int(share * len(value.choices)), len(value.choices) - 1)]
    if isinstance(value, Range):
        return _between(value.low, value.high, share, log=value.scale == "log")
    if isinstance(value, Factor):
        if isinstance(own, bool) or not isinstance(own, int | float):
            message = "a factor needs a number in the machine to multiply"
            raise SpecError(Problem(field=field, message=message, given=own, allowed="`low` and `high` instead"))
        return own * _between(*value.factor, share, log=True)
    return value


def _between(low: float, high: float, share: float, *, log: bool) -> float:
    if not log:
        return min(max(low + share * (high - low), low), high)
    ends = math.log(low), math.log(high)
    return min(max(math.exp(ends[0] + share * (ends[1] - ends[0])), low), high)


def most(value: Value) -> float | None:
    """The largest number that can be drawn; None where it depends on the machine or is no number."""
    if isinstance(value, Range):
        return value.high
    if isinstance(value, Choice):
        return max((item for item in value.choices if not isinstance(item, bool | str)), default=None)
    return value if isinstance(value, float) else None


def least(value: Value) -> float | None:
    """The smallest number that can be drawn; None where it depends on the machine or is no number."""
    if isinstance(value, Range):
        return value.low
    if isinstance(value, Choice):
        numbers = [item for item in value.choices if not isinstance(item, bool | str)]
        return min(numbers, default=None)
    return value if isinstance(value, float) else None
