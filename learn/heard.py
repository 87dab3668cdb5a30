"""Whether a recording can hold what is looked for at all: its lines below half the rate."""

from __future__ import annotations

import math
from collections.abc import Sequence

from learn.describe import Site
from sim.core.errors import Problem, SpecError

HARMONICS = 3
"""Of a race's line that a recording should hold: so many are scored."""
USUAL = 3.0
"""Order of the outer race of usual bearings, at least (6 balls and more)."""


def check_rate(rate_hz: float, speed_hz: float, sites: Sequence[Site]) -> list[str]:
    """What is said where a bearing's lines are not all below half the rate; SpecError where not even the first of each
    race is, of any bearing: the answer would say nothing."""
    wanted = {s.name: (s.orders.outer, s.orders.inner, speed_hz * s.ratio) for s in sites}
    wanted = wanted or {"bearing": (USUAL, USUAL, speed_hz)}
    least = min(max(outer, inner) * hz for outer, inner, hz in wanted.values())
    most = max(max(outer, inner) * hz for outer, inner, hz in wanted.values())
    if least >= rate_hz / 2:
        message = f"cannot carry the lines that are looked for, of which a race's first is at {least:.4g} Hz"
        allowed = f">= {math.ceil(2.0 * HARMONICS * most)}"
        raise SpecError(Problem(field="sampling_rate_hz", message=message, given=rate_hz, allowed=allowed, unit="Hz"))
    return [
        f"{name}: of {max(outer, inner) * hz:.4g} Hz, a race's line, not {HARMONICS} harmonics are below half the "
        "sampling rate: faults may go unheard"
        for name, (outer, inner, hz) in wanted.items()
        if HARMONICS * max(outer, inner) * hz >= rate_hz / 2
    ]
