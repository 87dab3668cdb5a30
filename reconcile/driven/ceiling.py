"""Outputs that stand at a ceiling or floor: saturation, of the sensor or of the system."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from reconcile.driven.channels import FloatArray

NEAR = 2e-3
"""Distance from the extreme, over the range, that counts as standing there."""
LEAST_RUN, LEAST_SAMPLES = 4, 8
MOST_SMOOTH = 0.2
"""A smooth peak leaves the extreme within as many samples on either side; a ceiling is entered at speed."""


@dataclass(frozen=True, kw_only=True)
class Ceiling:
    """Level at which the output stands, on how many samples, and whether it is the upper end."""

    level: float
    samples: int
    upper: bool

    def words(self, unit: str) -> str:
        """For a reader."""
        side = "above" if self.upper else "below"
        return (
            f"the output stands at {self.level:.4g} {unit} for {self.samples} samples and never goes {side}: saturation"
        )


def _standing(values: FloatArray, upper: bool) -> Ceiling | None:
    turned = values if upper else -values
    spread = float(np.ptp(turned))
    if spread == 0.0:
        return None
    there = np.concatenate([[False], turned > turned.max() - NEAR * spread, [False]])
    edges = np.nonzero(np.diff(there.astype(np.int8)))[0]
    count = 0
    for first, last in zip(edges[::2], edges[1::2], strict=True):
        if last - first < LEAST_RUN or first == 0 or last >= turned.size:
            continue
        step = float(max(turned[first] - turned[first - 1], turned[last - 1] - turned[last]))
        inner = float(np.ptp(turned[first:last])) / (last - first)
        if inner < MOST_SMOOTH * step:
            count += int(last - first)
    if count < LEAST_SAMPLES:
        return None
    return Ceiling(level=float(values.max() if upper else values.min()), samples=count, upper=upper)


def ceilings(values: FloatArray) -> tuple[Ceiling, ...]:
    """Both ends of an output (n,)."""
    found = (_standing(values, True), _standing(values, False))
    return tuple(c for c in found if c is not None)
