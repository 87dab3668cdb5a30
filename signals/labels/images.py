"""Lines that the steps of a simulation make: what is faster than the steps can follow comes back folded.

Where teeth or balls enter contact the force has a kink, whose harmonics go on beyond half the step rate f_s. They and
the step's own error at every kink return at |n f - m f_s|, as in any sampling (C. E. Shannon, Proc. IRE 37 (1949)
10-21). Such a line moves when the step is changed; one of the machine does not.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from signals.labels.combinations import RANK_STEP, Carrier, Grid, Modulator
from signals.peaks import FoundPeaks
from signals.series import BoolArray

STEP_BASE = "f_s"
FAMILY = "numerical"
MECHANISM = "step_image"
MAX_FOLDS = 24
"""Largest multiple of the step rate looked at."""
MAX_ORDER = 3000
"""Largest multiple of a base looked at: a kink's harmonics fall as the 2.5th power, nothing is left of later ones."""
MAX_SHARE = 0.03
"""Largest amplitude of an image over that of the strongest line, -30 dB: the harmonics that fold lie far out."""
RANK = 3 * RANK_STEP
"""Beyond all combinations: a line of the machine is the simpler explanation."""


def faint(found: FoundPeaks) -> BoolArray:
    """Peaks that may be images: `MAX_SHARE` of the strongest or less; shape (peaks,)."""
    return np.asarray(found.amplitude <= MAX_SHARE * np.max(found.amplitude, initial=0.0), dtype=np.bool_)


def image_grids(
    carriers: Sequence[Carrier], bases_hz: Mapping[str, float], *, step_hz: float, top_hz: float, resolution_hz: float
) -> Iterator[Grid]:
    """Images of every carrier's harmonics below `top_hz`, at the step rate `step_hz`.

    Every multiple of the step rate adds two images a carrier's frequency; beyond one in four bins they prove nothing.
    """
    for carrier in carriers:
        hz = bases_hz[carrier.base]
        most = min(MAX_FOLDS, int(hz / (8 * resolution_hz)))
        if most == 0:
            continue
        folds = [m * step_hz for m in range(1, most + 1)]
        numbers = [np.arange(np.ceil((f - top_hz) / hz), np.floor((f + top_hz) / hz) + 1) for f in folds]
        rows = [np.stack([n, np.full_like(n, -m)], axis=1) for m, n in enumerate(numbers, start=1)]
        orders = np.concatenate(rows).astype(np.int64)
        orders = orders[(orders[:, 0] > 0) & (orders[:, 0] <= MAX_ORDER)]
        frequency = np.abs(orders @ np.array([hz, step_hz]))
        kept = frequency > 1e-6 * hz
        step = Modulator(base=STEP_BASE, frequency_hz=step_hz, reach=MAX_FOLDS, components=carrier.components)
        yield Grid(
            carrier=carrier,
            modulators=(step,),
            orders=orders[kept],
            frequency_hz=frequency[kept],
            rank=RANK - orders[kept, 1],
            mechanisms=(MECHANISM,),
            family=FAMILY,
        )
