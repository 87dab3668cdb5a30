"""Numbers from environment variables: one that cannot be used is named with what was given and what is allowed."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from sim.core.errors import Problem, SpecError


class Numbers:
    """Reads numbers from an environment; `settle` raises SpecError with every one that is wrong."""

    def __init__(self, environment: Mapping[str, str]) -> None:
        self._environment = environment
        self._problems: list[Problem] = []

    def number(self, name: str, default: float, *, least: float = 0.0, most: float = math.inf, unit: str = "") -> float:
        """A number from `least` to `most`; an empty text is the default. A wrong one is noted, and the default read."""
        return self._read(name, default, Allowed(least=least, most=most, unit=unit))

    def whole(self, name: str, default: int, *, least: int = 0, most: float = math.inf, unit: str = "") -> int:
        """A whole number; `2e9` is one."""
        return int(self._read(name, default, Allowed(least=least, most=most, unit=unit, whole=True)))

    def settle(self) -> None:
        """Raise what was noted, if anything."""
        if self._problems:
            raise SpecError(self._problems)

    def _read(self, name: str, default: float, allowed: Allowed) -> float:
        text = self._environment.get(name, "").strip()
        if not text:
            return default
        try:
            found = float(text)
        except ValueError:
            found = math.nan
        if allowed.holds(found):
            return found
        told = Problem(field=name, message="is not usable", given=text[:80], allowed=str(allowed), unit=allowed.unit)
        self._problems.append(told)
        return default


@dataclass(frozen=True, kw_only=True)
class Allowed:
    """What a variable may be."""

    least: float
    most: float
    unit: str = ""
    whole: bool = False

    def holds(self, value: float) -> bool:
        """Whether a number, which may be NaN, is one of these."""
        return math.isfinite(value) and self.least <= value <= self.most and (value % 1 == 0 or not self.whole)

    def __str__(self) -> str:
        kind = "a whole number" if self.whole else "a number"
        bounds = f"{self.least:g} to {self.most:g}" if math.isfinite(self.most) else f"{self.least:g} or more"
        return f"{kind}, {bounds}"
