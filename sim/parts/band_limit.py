"""A step of a sampled signal without what would fold: the step response of a low-pass about a jump.

A jump sampled as it stands holds harmonics without end, and those near the sampling rate fold onto low frequencies. A
jump drawn as the step response of a filter that ends below that rate has none there, and below the filter's edge it is
the same jump (Stilson & Smith 1996, Proc. ICMC, 332-335: band-limited steps).
"""

from __future__ import annotations

from functools import cache

import numpy as np

from sim.core.choose import floor, pick, select, size, smaller
from sim.core.compiled import inline
from sim.core.response import FloatArray

REACH = 5
"""Sampling intervals on either side of a jump over which its step response differs from the jump itself."""
CELLS = 64
"""Samples of the response an interval: linear between them it is true to 4e-5 of the jump."""
STOP_BAND_DB = 80.0
"""With `REACH` the pass band ends at 0.25 of the sampling rate, the stop band begins at 0.75 (Kaiser's formula)."""
BETA = 0.1102 * (STOP_BAND_DB - 8.7)
"""Oppenheim & Schafer, Discrete-Time Signal Processing, 3rd ed., eq. 7.75."""
POINTS = REACH * CELLS + 1


@cache
def step_response() -> FloatArray:
    """Response of the filter to a unit step, 0 to `REACH` intervals behind it, (POINTS,); before it, 1 minus that."""
    fine = 16
    at = np.linspace(0.0, REACH, (POINTS - 1) * fine + 1)
    shape = np.sinc(at) * np.i0(BETA * np.sqrt(1.0 - (at / REACH) ** 2)) / np.i0(BETA)
    area = np.concatenate([[0.0], np.cumsum(0.5 * (shape[1:] + shape[:-1]))])
    response = np.asarray(0.5 + 0.5 * area[::fine] / area[-1])
    response.flags.writeable = False
    return response


@inline
def step_share(par, base, x):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """The response `x` intervals behind a step (before it where negative); its table begins at `base`."""
    place = smaller(size(x), 5.0) * 64.0
    cell = smaller(floor(place), 319.0)
    share = place - cell
    value = pick(par, base + cell) * (1.0 - share) + pick(par, base + cell + 1.0) * share
    return select(x < 0.0, 1.0 - value, value)
