"""Coarse speed over time from the vibration: the speed whose harmonics hold most, frame by frame.

The score of a speed is the sum over its orders of the logarithm of the amplitude found there, the multi-order idea of
Q. Leclere, H. Andre and J. Antoni, "A multi-order probabilistic approach for instantaneous angular speed tracking",
Mech. Syst. Signal Process. 81 (2016) 375-386. The best course through the frames is found by dynamic programming
(A. J. Viterbi, IEEE Trans. Inf. Theory 13 (1967) 260-269) with a bound on the change of speed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from signals.series import FloatArray, IntArray, Series
from signals.spectra.spectrogram import spectrogram
from sim.core.errors import Problem, SpecError

TURNS_A_FRAME = 8.0
"""Turns of the slowest speed in a frame: orders one apart are four Hann main lobes from each other."""
MAX_FRAMES = 4000
MAX_SPEEDS = 4000


@dataclass(frozen=True, kw_only=True)
class SpeedTrack:
    """Speed at the centres of frames: `time_s` and `speed_hz` have shape (frames,); `step_hz` is the grid's."""

    time_s: FloatArray
    speed_hz: FloatArray
    step_hz: float


def track_speed(
    series: Series,
    *,
    orders: Sequence[float],
    low_hz: float,
    high_hz: float,
    max_slew_hz_per_s: float | None = None,
    frame_s: float | None = None,
) -> SpeedTrack:
    """Speed of the shaft between `low_hz` and `high_hz` by the lines at `orders` (cycles per revolution).

    `max_slew_hz_per_s` (default: the whole range within the record, at least a tenth of the range a frame) bounds how
    fast the speed may change. Lines of other parts that keep a constant ratio to the speed asked for do not mislead
    the track only if `orders` tells them apart.
    """
    highest = _checked(series, orders, low_hz, high_hz)
    length_s = TURNS_A_FRAME / low_hz if frame_s is None else frame_s
    frames = spectrogram(
        series, resolution_hz=1 / min(length_s, series.duration_s), overlap=0.75, max_frames=MAX_FRAMES
    )
    step = max(frames.resolution_hz / (4 * highest), (high_hz - low_hz) / MAX_SPEEDS)
    speeds = low_hz + step * np.arange(int((high_hz - low_hz) / step) + 1, dtype=np.float64)
    score = _score(
        np.log(np.maximum(frames.values, 1e-9 * np.max(frames.values) + 1e-300)), frames.resolution_hz, speeds, orders
    )
    slew = max_slew_hz_per_s
    if slew is None:
        slew = max((high_hz - low_hz) / series.duration_s, (high_hz - low_hz) / 10 / frames.hop_s)
    reach = max(1, min(speeds.size - 1, int(np.ceil(slew * frames.hop_s / step)))) if speeds.size > 1 else 0
    return SpeedTrack(time_s=frames.time_s, speed_hz=speeds[_best_course(score, reach)], step_hz=step)


def _checked(series: Series, orders: Sequence[float], low_hz: float, high_hz: float) -> float:
    problems = []
    if not (np.isfinite([low_hz, high_hz]).all() and 0 < low_hz <= high_hz):
        problems.append(
            Problem(
                field="low_hz/high_hz",
                message="are no range of speeds",
                given=(low_hz, high_hz),
                allowed="0 < low_hz <= high_hz",
                unit="Hz",
            )
        )
    if not orders or not all(np.isfinite(k) and k > 0 for k in orders):
        problems.append(
            Problem(
                field="orders", message="must be positive", given=list(orders), allowed="at least one order above 0"
            )
        )
    if problems:
        raise SpecError(problems)
    highest = float(max(orders))
    if highest * high_hz > series.sampling_rate_hz / 2:
        allowed = f"up to {series.sampling_rate_hz / 2 / high_hz:g} at {high_hz:g} Hz"
        raise SpecError(Problem(field="orders", message="lie above Nyquist", given=highest, allowed=allowed))
    if low_hz * series.duration_s < TURNS_A_FRAME:
        raise SpecError(
            Problem(
                field="low_hz",
                message=f"makes fewer than {TURNS_A_FRAME:g} turns in the record",
                given=low_hz,
                allowed=f"at least {TURNS_A_FRAME / series.duration_s:.4g}",
                unit="Hz",
            )
        )
    return highest


def _score(log_values: FloatArray, resolution_hz: float, speeds: FloatArray, orders: Sequence[float]) -> FloatArray:
    """Sum over orders of the log amplitude there (linear between bins), shape (speeds, frames)."""
    total = np.zeros((speeds.size, log_values.shape[1]))
    for order in orders:
        place = np.minimum(order * speeds / resolution_hz, log_values.shape[0] - 1.000001)
        low = place.astype(np.int64)
        share = (place - low)[:, np.newaxis]
        total += (1 - share) * log_values[low] + share * log_values[low + 1]
    return total


def _best_course(score: FloatArray, reach: int) -> IntArray:
    """Row a frame, shape (frames,), that maximises the summed score with steps of at most `reach` rows."""
    speeds, frames = score.shape
    best = score[:, 0].copy()
    back = np.zeros((frames, speeds), dtype=np.int32)
    rows = np.arange(speeds)
    for j in range(1, frames):
        from_row = _argmax_within(best, reach)
        back[j] = from_row
        # an arbitrarily small preference for standing still settles ties
        best = best[from_row] + score[:, j] - 1e-9 * np.abs(from_row - rows)
    course = np.empty(frames, dtype=np.int64)
    course[-1] = int(np.argmax(best))
    for j in range(frames - 1, 0, -1):
        course[j - 1] = back[j, course[j]]
    return course


def _argmax_within(values: FloatArray, reach: int) -> IntArray:
    """Index of the largest value within `reach` of each index, shape (n,): doubling windows, n log(reach) steps."""
    n = values.size
    padded = np.concatenate([np.full(reach, -np.inf), values, np.full(reach, -np.inf)])
    index = np.arange(padded.size)
    width, wanted = 1, 2 * reach + 1
    while width < wanted:
        shift = min(width, wanted - width)
        other = index[shift:]
        mine = index[: other.size]
        index = np.where(padded[other] > padded[mine], other, mine)
        width += shift
    return np.asarray(index[:n] - reach, dtype=np.int64)
