"""Time-synchronous average: the mean turn of a shaft. What is not locked to it falls with the root of the turns.

P. D. McFadden, "Interpolation techniques for time domain averaging of gear vibration", Mech. Syst. Signal Process. 3
(1989) 87-97, and "A revised model for the extraction of periodic waveforms by time domain averaging", ibid. 1 (1987)
83-95: the average is a comb filter with teeth at the orders of the shaft.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from signals.recording import Tacho
from signals.series import FloatArray, Series
from signals.spectra.angle import samples_at
from signals.spectra.order import shaft_angle
from sim.core.errors import Problem, SpecError

BLOCK_SAMPLES = 2**18
"""Samples resampled at a time: memory beyond the record and its angle stays flat."""
PAD_SAMPLES = 64
"""Samples kept to each side of a block: the interpolation's filters are shorter."""
MIN_TURNS = 2


@dataclass(frozen=True, kw_only=True)
class SynchronousAverage:
    """Mean turn: `samples` has shape (samples_per_revolution,), in `unit`, from angle 0 of the averaged turns on.

    `scatter_rms` is the RMS, over all turns, of what differs from the mean turn: noise and everything that belongs to
    other shafts. Of noise, `scatter_rms / sqrt(revolutions)` is left in the average.
    """

    samples: FloatArray
    unit: str
    shaft: str
    revolutions: int
    mean_speed_hz: float
    scatter_rms: float
    channel: str = ""

    @property
    def samples_per_revolution(self) -> int:
        """Samples of the turn."""
        return int(self.samples.size)

    @property
    def noise_rms(self) -> float:
        """What the average still holds of the scatter, if turns scatter independently."""
        return self.scatter_rms / float(np.sqrt(self.revolutions))


def synchronous_average(
    series: Series,
    *,
    shaft: str,
    rotation: float | Tacho | FloatArray,
    ratio: float = 1.0,
    samples_per_revolution: int | None = None,
    max_revolutions: int | None = None,
) -> SynchronousAverage:
    """Mean turn of the shaft that turns `ratio` times as fast as the one `rotation` is given for.

    `rotation`: constant speed (Hz), a tacho, or the angle at each sample ((n,), rad, NaN where unknown). By default a
    turn has as many samples as at the slowest speed, so nothing aliases. `max_revolutions`: only the first turns.
    """
    if not (np.isfinite(ratio) and ratio > 0):
        raise SpecError(Problem(field="ratio", message="must be positive", given=ratio, allowed="above 0"))
    angle = shaft_angle(series, rotation) * ratio
    known = _known(angle, series)
    speed = np.diff(angle[known]) * (series.sampling_rate_hz / (2 * np.pi))
    if not float(np.min(speed)) > 0:
        message, allowed = "the shaft must turn forwards all the time", "above 0"
        raise SpecError(
            Problem(field="rotation", message=message, given=float(np.min(speed)), allowed=allowed, unit="Hz")
        )
    per_turn = samples_per_revolution or max(4, int(np.ceil(series.sampling_rate_hz / float(np.min(speed)) - 1e-6)))
    turns = int((angle[known.stop - 1] - angle[known.start]) / (2 * np.pi) * (1 + 1e-12))
    turns = turns if max_revolutions is None else min(turns, max_revolutions)
    if turns < MIN_TURNS:
        raise SpecError(
            Problem(
                field="rotation",
                message=f"covers too few turns of {shaft} to average",
                given=turns,
                allowed=f"at least {MIN_TURNS}",
            )
        )
    level = float(np.mean(series.samples))  # taken out and put back: the resampling filter's gain is 1 to 7e-4 only
    total, square, seen = np.zeros(per_turn), 0.0, 0
    for block in _turns(series.samples - level, angle, known, per_turn, turns):
        total += np.sum(block, axis=0)
        square += float(np.sum(block**2))
        seen += block.shape[0]
    mean = total / seen
    scatter = max(square / (seen * per_turn) - float(np.mean(mean**2)), 0.0) * seen / (seen - 1)
    return SynchronousAverage(
        samples=mean + level,
        unit=series.unit,
        shaft=shaft,
        revolutions=seen,
        mean_speed_hz=float(np.mean(speed)),
        scatter_rms=float(np.sqrt(scatter)),
        channel=series.name,
    )


def _known(angle: FloatArray, series: Series) -> slice:
    """The stretch where the angle is known; it may be unknown at both ends only."""
    finite = np.flatnonzero(np.isfinite(angle))
    if angle.shape != series.samples.shape or finite.size < 2 or finite[-1] - finite[0] + 1 != finite.size:
        raise SpecError(
            Problem(
                field="rotation",
                message="must give an angle for each sample, without gaps between its ends",
                given=f"shape {angle.shape}, {finite.size} finite",
                allowed=f"shape {series.samples.shape}",
                unit="rad",
            )
        )
    return slice(int(finite[0]), int(finite[-1]) + 1)


def _turns(samples: FloatArray, angle: FloatArray, known: slice, per_turn: int, turns: int) -> Iterator[FloatArray]:
    """The turns in order, in blocks of shape (some, per_turn)."""
    start = angle[known.start]
    together = max(1, BLOCK_SAMPLES // per_turn)
    step = 2 * np.pi / per_turn
    for first in range(0, turns, together):
        count = min(together, turns - first)
        targets = start + 2 * np.pi * first + np.arange(count * per_turn) * step
        low = known.start + int(np.searchsorted(angle[known], targets[0])) - PAD_SAMPLES
        high = known.start + int(np.searchsorted(angle[known], targets[-1])) + PAD_SAMPLES
        low, high = max(low, known.start), min(high, known.stop)
        index = CubicSpline(angle[low:high], np.arange(high - low, dtype=np.float64))(targets)
        values = samples_at(samples[low:high], np.asarray(index, dtype=np.float64))
        yield values.reshape(count, per_turn)
