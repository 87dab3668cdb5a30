"""Lines of the envelope as they were measured: those that stand out, each with its own change.

The level of a line is its depth of modulation (`reconcile.kinematics.envelopes`), in the band in which its family was
found; expected there is what the baselines have at that order, the highest of them, or without one the noise beside it.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reconcile.kinematics.contrast import band_turns
from reconcile.kinematics.envelopes import order_depth
from reconcile.kinematics.observe import Observation
from reconcile.kinematics.octaves import PRESENT_DB, WIDTH
from reconcile.speed.excess import power_over_floor
from reconcile.verdict import LineChange
from signals.series import FloatArray


def measured_lines(
    wanted: Sequence[tuple[str, float]],
    channel: str,
    band_hz: tuple[float, float],
    test: Observation,
    baselines: Sequence[Observation],
    locked_to: str = "",
) -> tuple[LineChange, ...]:
    """Of the lines `wanted`, (label, order of the reference shaft), those that stand out of the test's noise."""
    power, excess, step = _spectrum(test, channel, band_hz)
    before = [
        _spectrum(b, channel, band_hz)
        for b in baselines
        if channel in b.recording.names and band_hz[1] < b.recording.sampling_rate_hz / 2
    ]
    found = []
    for label, order in wanted:
        near = _near(order, step, power.size)
        if order <= 0 or not near.size:
            continue
        place = int(near[np.argmax(power[near])])
        over_db = float(10 * np.log10(excess[place] + 1e-12))
        if over_db <= PRESENT_DB:
            continue
        had = [float(np.max(p[_near(order, s, p.size)], initial=0.0)) for p, _, s in before]
        change = 10 * np.log10(power[place] / max(*had, 1e-12)) if had else over_db
        found.append(
            LineChange(
                label=label,
                frequency_hz=float(_order_of(place, order, step) * test.speed.speed_hz),
                change_db=float(change),
                channel=channel,
                locked_to=locked_to,
                speed_hz=test.speed.speed_hz,
            )
        )
    return tuple(found)


def _order_of(place: int, order: float, step: float) -> float:
    """The order of a line in bin `place`: the wanted one, which all of the family's lines tell and which is finer than
    a bin, where the line stands at it, so that sentence and table say the same; else the bin's."""
    return order if abs(place - order / step) <= 1.0 else place * step


def _spectrum(one: Observation, channel: str, band_hz: tuple[float, float]) -> tuple[FloatArray, FloatArray, float]:
    """(square of the depth (bins,), the same over its noise (bins,), order step)."""
    depth, step = order_depth(*band_turns(one, channel, band_hz))
    power = np.asarray(depth**2, dtype=np.float64)
    return power, power_over_floor(power), step


def _near(order: float, step: float, size: int) -> np.ndarray[tuple[int], np.dtype[np.int64]]:
    """Bins around an order that its line may lie in; none beyond the spectrum."""
    middle, reach = round(order / step), max(1, round(WIDTH * order / step))
    return np.arange(max(middle - reach, 1), min(middle + reach + 1, size), dtype=np.int64)
