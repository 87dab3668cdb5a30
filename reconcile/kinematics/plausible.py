"""Whether the orders that are stated of a bearing can be those of one: refused before a line is looked for at them.

With Z balls and the ratio g of ball to pitch diameter (times the cosine of the contact angle) BPFO is Z/2 (1 - g) and
BPFI Z/2 (1 + g), whichever ring turns; FTF is BPFO/Z where the inner ring turns and BPFI/Z where the outer one does;
BSF is (1 - g^2)/(2 g) times that cosine (R. B. Randall and J. Antoni, Mech. Syst. Signal Process. 25 (2011) 485-520,
eqs (1)-(4)).
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from sim.core.errors import Problem

LEAST_BALLS, MOST_BALLS = 3, 64
SLACK = 0.5
"""Of the sum of both races' orders, which is the number of balls but for rounding."""
ROWS = 2
"""Rows whose balls may be counted together: so many times more fit in than in one."""
LARGEST_RATIO = 0.9
CAGE = 0.05
"""By which a cage's order may differ from that of the races."""
ROUNDED = 0.1
"""To which races' orders may be rounded: near each other they tell the ball's size badly."""
SPIN_LOW, SPIN_HIGH = 0.5, 1.5
"""Times the spin that the races' orders make: contact angles up to 50 degrees, and rounding."""
LINE = 1.13
"""Times that spin from which a number is the line of a ball, twice its spin: at 50 degrees that is 1.29, and the spin
itself at 0 degrees 1. Many makers' tables print the line."""


def implausible(field: str, bpfo: float, bpfi: float, bsf: float | None, ftf: float | None) -> Iterator[Problem]:
    """What of a bearing's orders (cycles per revolution, above 0), stated in `field`, cannot be."""
    races = _races(field, bpfo, bpfi)
    if races is not None:
        yield races
        return
    balls = bpfo + bpfi
    if ftf is not None and min(abs(ftf - bpfo / balls), abs(ftf - bpfi / balls)) > CAGE:
        message = "is no order of a cage between these races"
        allowed = f"about {bpfo / balls:.3g} (the inner ring turns) or {bpfi / balls:.3g} (the outer one)"
        yield Problem(field=f"{field}.ftf", message=message, given=ftf, allowed=allowed)
    if bsf is not None:
        yield from _spin(f"{field}.bsf", bsf, balls, (bpfi - bpfo) / balls)


def _races(field: str, bpfo: float, bpfi: float) -> Problem | None:
    balls = bpfo + bpfi
    if not LEAST_BALLS - SLACK <= balls <= MOST_BALLS + SLACK:
        message = "make no number of balls together"
        if balls > MOST_BALLS:
            message += ": they are orders, multiples of the shaft's speed, not Hz"
        allowed = f"bpfo + bpfi from {LEAST_BALLS} to {MOST_BALLS}"
        return Problem(field=field, message=message, given={"bpfo": bpfo, "bpfi": bpfi}, allowed=allowed)
    if bpfo >= bpfi:
        message = "is not below bpfi: whichever ring turns, balls pass the outer race less often; are they exchanged?"
        return Problem(field=f"{field}.bpfo", message=message, given=bpfo, allowed=f"below bpfi, {bpfi:g}")
    ratio = _largest_ratio(balls)
    if (bpfi - bpfo) / balls > ratio:
        message = f"is too small beside bpfi, {bpfi:g}: of balls that large {balls:.3g} do not fit in"
        allowed = f"{balls / 2 * (1 - ratio):.3g} to {balls / 2:.3g} for {balls:.3g} balls"
        return Problem(field=f"{field}.bpfo", message=message, given=bpfo, allowed=allowed)
    return None


def _largest_ratio(balls: float) -> float:
    """Of ball to pitch diameter at which the balls of two rows touch."""
    return min(LARGEST_RATIO, math.sin(min(math.pi / 2, ROWS * math.pi / balls)))


def spin_of(bpfo: float, bpfi: float, bsf: float) -> float:
    """The spin that a stated `bsf` means: itself, or half of it where it is the line of a ball."""
    return bsf / 2 if bsf > LINE * _turns((bpfi - bpfo) / (bpfo + bpfi)) else bsf


def _spin(field: str, bsf: float, balls: float, ratio: float) -> Iterator[Problem]:
    """A ball's spin, or its line, that is not that of balls of this size."""
    doubt = ROUNDED / balls
    low, high = SPIN_LOW * _turns(ratio + doubt), SPIN_HIGH * _turns(max(ratio - doubt, doubt))
    if not low <= bsf <= 2 * high:
        message = "is neither spin nor line of the balls that these races have"
        yield Problem(field=field, message=message, given=bsf, allowed=f"{low:.3g} to {high:.3g}, or twice that")


def _turns(ratio: float) -> float:
    return max(1 - ratio**2, 0.0) / (2 * ratio)
