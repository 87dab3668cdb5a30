"""The numbers of one setting along clearance and speed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

Numbers = Mapping[str, float]


@dataclass(frozen=True, kw_only=True)
class Sweep:
    """`healthy`: without clearance. `by_gap`: clearance in um, rising, the rigid wall (0) not among them.

    `by_speed`: shaft speed in Hz, rising, at 20 um; empty where no speed sweep was made.
    """

    healthy: Numbers
    by_gap: Mapping[float, Numbers]
    by_speed: Mapping[float, Numbers]
    f_o1_hz: float
    f_r1_hz: float

    def gaps(self, low: float = 0.0, high: float = 1e9) -> list[float]:
        """Clearances between two values, um."""
        return [g for g in self.by_gap if low <= g <= high]

    def row(self, name: str, gaps: Sequence[float]) -> list[float]:
        """A number at the given clearances; 0 is the healthy machine."""
        return [(self.by_gap[g] if g > 0 else self.healthy)[name] for g in gaps]

    def fast(self, name: str) -> list[float]:
        """A number along the speed sweep."""
        return [n[name] for n in self.by_speed.values()]

    def nearest(self, gap_um: float) -> float:
        """The swept clearance nearest to a wanted one."""
        return min(self.by_gap, key=lambda g: abs(g - gap_um))
