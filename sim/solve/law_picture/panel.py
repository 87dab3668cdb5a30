"""What a picture of a law is made of."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from sim.core.response import FloatArray

TELLING, SHARE = 0.01, 0.02
"""Least difference, relative to the range of the curves, that the eye sees, and the least share of points with it."""


def told(value: float, unit: str) -> str:
    """A value in a caption, lengths in micrometres: `21 µm`."""
    return f"{1e6 * value:.3g} µm" if unit == "m" else f"{value:.3g} {unit}"


@dataclass(frozen=True, kw_only=True)
class Axis:
    """What is drawn along an axis, and its SI unit."""

    label: str
    unit: str


@dataclass(frozen=True, kw_only=True)
class Curve:
    """One law over the panel's x, with the effect and without it; None where there is no such law without it."""

    name: str
    """Empty where the panel has one curve only."""
    here: FloatArray
    without: FloatArray | None

    @property
    def telling(self) -> bool:
        """Whether the effect is seen: against the machine without it, else against nothing at all."""
        other = np.zeros_like(self.here) if self.without is None else self.without
        size = float(np.ptp(np.concatenate([self.here, other])))
        rounding = 1e-9 * float(np.max(np.abs(other)))
        return bool(np.mean(np.abs(self.here - other) > max(TELLING * size, rounding)) >= SHARE)


@dataclass(frozen=True, kw_only=True)
class Panel:
    """One picture: curves (n,) over `values` (n,), all SI."""

    title: str
    caption: str
    """What was held and what was moved, in a sentence or two."""
    x: Axis
    values: FloatArray
    y: Axis
    curves: tuple[Curve, ...]

    @property
    def telling(self) -> bool:
        """Whether any of its curves shows the effect."""
        return any(curve.telling for curve in self.curves)
