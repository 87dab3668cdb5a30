"""Declared parameters: one object says the unit, bounds, default and meaning of a number everywhere."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from sim.core.errors import Problem

Scale = Literal["linear", "log"]


@dataclass(frozen=True, kw_only=True)
class Param:
    """A scalar parameter of a term.

    `low` and `high` are inclusive bounds in `unit`; `scale` says how samplers and forms move through them.
    """

    name: str
    unit: str
    default: float
    low: float
    high: float
    sentence: str
    scale: Scale = "linear"
    choices: tuple[float, ...] = ()
    sought: tuple[float, float] | None = None
    """Values a search for the effect covers, where what is met spans more than the default's surroundings; also where
    the machine states one, which nobody has measured (collision damping)."""

    def problem(self, value: object, field: str) -> Problem | None:
        """Return what is wrong with `value`, or None when it is allowed."""
        allowed = f"{self.low:g} to {self.high:g}"
        if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
            return Problem(field=field, message="must be a finite number", given=value, allowed=allowed, unit=self.unit)
        if self.choices and float(value) not in self.choices:
            listed = ", ".join(f"{c:g}" for c in self.choices)
            return Problem(
                field=field, message="is not one of the choices", given=value, allowed=listed, unit=self.unit
            )
        if not self.low <= value <= self.high:
            hint = unit_hint(float(value), self)
            return Problem(field=field, message=f"is out of bounds{hint}", given=value, allowed=allowed, unit=self.unit)
        return None


def unit_hint(value: float, param: Param) -> str:
    """Return a hint when `value` looks like millimetres or micrometres given for metres, else an empty string."""
    if param.unit != "m":
        return ""
    for factor, unit in ((1e-3, "mm"), (1e-6, "um")):
        if param.low <= value * factor <= param.high and value * factor > 0:
            return f" (it would fit if meant in {unit}; lengths are given in m)"
    return ""
