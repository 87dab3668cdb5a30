"""How far to go with a displacement or a velocity, so that the shape of a law is seen."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from sim.core.response import FloatArray

Law = Callable[[float], float]
LEAST, PER_DECADE = 1e-8, 6
MOST = {"m": 1e-1, "rad": 1e-1, "m/s": 1e1, "rad/s": 1e2}
USUAL = {"m": 1e-5, "rad": 1e-3, "m/s": 1e-2, "rad/s": 1.0}
BENT = 0.15
"""Departure from a straight line that the eye cannot miss."""
ROUND = (1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0)
SAMPLES = 24
"""Odd spacing would sample x = 0, where a law that jumps has no one value."""


def curvature(law: Law, reach: float) -> float:
    """Largest departure from a straight line over -reach..reach, relative to the largest force there."""
    x = np.linspace(-1.0, 1.0, SAMPLES)
    y = np.array([law(reach * value) for value in x])
    size = float(np.max(np.abs(y)))
    if size == 0.0 or not np.all(np.isfinite(y)):
        return 0.0
    line = np.polynomial.Polynomial.fit(x, y, 1)
    return float(np.max(np.abs(y - line(x)))) / size


def telling_reach(law: Law, unit: str, *, beyond: float = 1.5) -> float:
    """A round reach at which the law is far from straight: `beyond` times the first one at which it is plainly bent.

    The usual one of a unit where it is straight, or bent alike at every scale.
    """
    reaches = np.logspace(np.log10(LEAST), np.log10(MOST[unit]), round(PER_DECADE * np.log10(MOST[unit] / LEAST)) + 1)
    found = np.array([curvature(law, float(reach)) for reach in reaches])
    most = float(found.max())
    if most < 0.02 or found[0] > 0.8 * most:
        return USUAL[unit]
    return rounded(beyond * float(reaches[int(np.argmax(found >= min(BENT, 0.8 * most)))]))


def rounded(value: float) -> float:
    """The next round value above."""
    power = 10.0 ** np.floor(np.log10(value))
    return float(power * next(step for step in ROUND if value <= step * power * (1.0 + 1e-9)))


def differs_along(values: FloatArray) -> bool:
    """Whether a curve is more than a constant."""
    return bool(np.ptp(values) > 1e-9 * max(float(np.max(np.abs(values))), 1e-300))
