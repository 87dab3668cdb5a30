"""A channel whose numbers are another unit's: its level changed by the ratio of two units, evenly over the spectrum.

A loose mount is a filter: it changes some bands more than others. Lines that moved with the speed or grew with a defect
leave single bands uneven, so evenness is asked of most bands, not of all.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from reconcile.gate.findings import Finding
from signals.series import FloatArray
from signals.units import ELECTRICAL

GRAVITY = "g against m/s^2"
METRE, INCH, VOLT = "m against mm", "inch against mm", "V against mV"
UNIT_RATIOS: Mapping[str, float] = {GRAVITY: 9.80665, METRE: 1000.0, INCH: 25.4, VOLT: 1000.0}
UNITS_OF = {
    "acceleration": (GRAVITY, METRE),
    "velocity": (METRE, INCH),
    "displacement": (METRE, INCH),
    ELECTRICAL: (VOLT,),
    "": (GRAVITY, METRE, INCH),
}
"""What numbers of a quantity may be taken for; where the quantity is not known, any; of all others, volts."""
UNIT_TOLERANCE_DB = 0.8
"""Of the one gain of a channel that all bands share."""
DRIFTED_DB = 1.8
"""The same for g against m/s^2, the likeliest, where the channel's gain drifted by up to 1.5 dB too."""
UNIT_SHARE = 0.15
"""By which the ratio may be missed where bands scatter: drift of levels and defects move a channel's median by as
much (made recordings with impacts 15 dB above the noise: 1.5 dB)."""
EVEN_DB = 1.5
"""Half of the bands, and the medians of the lower and the upper half of them, within this of the median: a repeat at
another speed scatters by 0.4 dB, impacts raise it to 0.8; a loose mount falls by 6 dB an octave or more."""
EDGE, EDGE_DB, SHARP_DB = (5, 10, 25), 3.0, 2.0
"""Percentiles of the changes of a channel's bands; by which the first may lie below a unit's ratio and the second miss
it; and the width from the first to the third that one channel at least must keep. Of 73 tests of two sensors and more
against their baselines (measured, a rig's with pits that raise all bands of the nearer sensor by up to 48 dB,
gearboxes, made ones) none is told as it is; multiplied or divided by 9.8 all channels of 65 are, without this of 52."""
OTHERS_SHARE = 0.3
"""Of the change, that other channels may have changed by."""


def possible(quantity: str) -> Mapping[str, float]:
    """The ratios of units that a channel of a quantity may be wrong by."""
    return {k: UNIT_RATIOS[k] for k in UNITS_OF.get(quantity, (VOLT,))}


def unit_of(
    gain_db: float, tolerance_db: float = UNIT_TOLERANCE_DB, ratios: Mapping[str, float] = UNIT_RATIOS
) -> str | None:
    """The pair of units, of those `possible`, whose ratio a gain is, either way."""
    near = {k: abs(abs(gain_db) - 20 * np.log10(r)) for k, r in ratios.items()}
    best = min(near, key=lambda k: near[k])
    return best if near[best] < max(tolerance_db, DRIFTED_DB if best == GRAVITY else 0.0) else None


def even_unit_gain(change: Sequence[FloatArray], c: int, quantities: Sequence[str] = ()) -> float | None:
    """The gain, dB, of channel `c` if it is a unit's ratio, even over most bands, and other channels kept theirs.

    `change`: dB by channel, mean or floor, and band, of each pair of recordings; `quantities`: of the channels. A lone
    channel has nothing to be held against, nor have channels that all changed alike: None.
    """
    tolerance = float(20 * np.log10(1 / (1 - UNIT_SHARE)))
    medians = [float(np.median(np.concatenate([d[k].ravel() for d in change]))) for k in range(change[0].shape[0])]
    units = [unit_of(m, tolerance, possible(quantities[k] if quantities else "")) for k, m in enumerate(medians)]
    own = medians[c]
    if units[c] is None:
        return None
    rest = [k for k, m in enumerate(medians) if units[k] != units[c] or m * own < 0]
    if not rest and len(medians) > 1:  # no load raises every sensor's whole spectrum so evenly by ten
        return own if all(_even(change, k, medians[k]) for k in range(len(medians))) else None
    loudest = max((float(np.median(np.abs(d[k]))) for d in change for k in rest), default=np.inf)
    return own if loudest < OTHERS_SHARE * abs(own) and _even(change, c, own) else None


def edge_unit_gain(change: Sequence[FloatArray], quantities: Sequence[str]) -> float | None:
    """The ratio of two units, dB, from which on upwards all channels changed, beside a fault that raised most bands.

    A fault adds: what it leaves alone stands at the lower edge of the changes, and the same edge of all channels at the
    ratio of a unit is the unit's. A lone channel has nothing to be held against.
    """
    rows = [np.concatenate([d[k].ravel() for d in change]) for k in range(len(quantities))]
    if len(rows) < 2 or any(possible(q) != possible(quantities[0]) for q in quantities):
        return None
    edges = [np.percentile(row, EDGE) for row in rows]
    if min(float(e[2] - e[0]) for e in edges) > SHARP_DB:
        return None
    for ratio in possible(quantities[0]).values():
        for exact in (-20 * float(np.log10(ratio)), 20 * float(np.log10(ratio))):
            if all(e[0] >= exact - EDGE_DB and abs(e[1] - exact) <= EDGE_DB for e in edges):
                return exact
    return None


def lowest_share(change: Sequence[FloatArray], c: int) -> FloatArray:
    """The changes, dB, of the quarter of the bands of channel `c` that rose least, (bands,)."""
    values = np.sort(np.concatenate([d[c].ravel() for d in change]))
    return values[: max(1, values.size * EDGE[2] // 100)]


def _even(change: Sequence[FloatArray], c: int, middle: float) -> bool:
    """Whether the bulk of the bands, and each half of the spectrum, changed by `middle`."""
    values = np.concatenate([d[c].ravel() for d in change])
    quarter = float(np.subtract(*np.percentile(values, [75, 25]))) / 2
    halves = [part for d in change for part in np.array_split(d[c], 2, axis=1)]
    edge = max(abs(float(np.median(part)) - middle) for part in halves)
    return quarter < EVEN_DB and edge < EVEN_DB


def unit_finding(gain_db: float, unit: str, name: str, change_db: FloatArray, what: str = "bands") -> Finding:
    """`unit_mismatch`; undoing it takes back the exact ratio. `change_db`: of all bands, or lines, as measured."""
    exact = float(np.sign(gain_db) * 20 * np.log10(UNIT_RATIOS[unit]))
    low, high = np.percentile(change_db, [10, 90])
    detail = f"eight tenths of its {what} changed by {low:+.1f} to {high:+.1f} dB, "
    detail += f"and {exact:+.1f} dB is the ratio of {unit}"
    if unit == GRAVITY:
        numbers, said = ("g", "m/s^2") if gain_db < 0 else ("m/s^2", "g")
        detail += f": against the baseline its numbers are {numbers} described as {said}"
    return Finding(
        kind="unit_mismatch",
        channel=name,
        recording="all tests",
        detail=detail,
        severity=1.0,
        fault=True,
        gain_db=exact,
    )
