"""Spectral lines as sums of orders: `2*f_o1`, `1*f_m-1*f_r1`.

A line is a linear combination of base frequencies; the frequency follows from the machine's kinematics, so a
line is meaningful at any speed. Canonical text lists the bases in a fixed order of families.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

Order = int | Fraction
"""A multiple; a fraction where a rotor answers every second or third turn only."""


@dataclass(frozen=True, kw_only=True)
class Line:
    """A predicted line: `orders` maps base names (`f_m`, `f_r1`, `f_o1`, `f_i1`, `f_b1`, `f_c1`) to multiples.

    `component` is the site (`bearing1`, `mesh1`, `pinion`, `input`), `mechanism` the term key that excites it,
    `family` a coarse group for switching displays (`mesh`, `shaft`, `outer`, `inner`, `ball`, `cage`).
    """

    orders: tuple[tuple[str, Order], ...]
    component: str
    mechanism: str
    family: str

    @property
    def label(self) -> str:
        """Canonical text of the sum, for example `1*f_m-1*f_r1` or `1/2*f_r1`."""
        parts = [f"{'+' if n > 0 else ''}{n}*{base}" for base, n in self.orders if n != 0]
        return "".join(parts).removeprefix("+")

    def frequency_hz(self, bases_hz: Mapping[str, float]) -> float:
        """Frequency for the given base frequencies, Hz (negative sums fold to positive)."""
        return abs(sum(float(n) * bases_hz[base] for base, n in self.orders))
