"""Lines of the raw signal over orders: shaft harmonics and mesh sidebands, and how they changed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import fft

from reconcile.kinematics.observe import Observation
from reconcile.speed.excess import EXPONENTIAL_MEDIAN, running_median
from signals.series import FloatArray
from signals.spectra.angle import resample_in_angle
from sim.core.errors import SpecError

SAME_SPEED = 0.03
CLEAR_DB = 15.0
"""By which the peak of a line stands above the floor that is held against a baseline by itself."""
STRONGEST_TO = 10.0
PRESENT_DB = 6.0
"""A line is there if it holds this much more power than the floor under it."""


@dataclass(frozen=True, kw_only=True)
class OrderLines:
    """`level_db` (bins,) and `floor_db` (bins,): power of the lines and of the noise beside them, over orders."""

    level_db: FloatArray
    floor_db: FloatArray
    order_step: float

    @cached_property
    def totals(self) -> tuple[FloatArray, FloatArray]:
        """Power of the lines and of the noise in all bins below one, (bins + 1,)."""
        lines, noise = (np.concatenate(([0.0], np.cumsum(10 ** (db / 10)))) for db in (self.level_db, self.floor_db))
        return lines, noise

    def within(self, orders: FloatArray, half_width: float) -> tuple[FloatArray, FloatArray]:
        """(power, floor power) within `half_width` of orders (n,); NaN beyond the spectrum."""
        reach = max(1, round(half_width / self.order_step))
        place = np.rint(orders / self.order_step).astype(np.int64)
        inside = (place > reach) & (place < self.level_db.size - reach - 1)
        safe = np.clip(place, reach, self.level_db.size - reach - 1)
        lines, noise = (np.where(inside, t[safe + reach + 1] - t[safe - reach], np.nan) for t in self.totals)
        return lines, noise

    def strongest(self, highest_order: float) -> float:
        """Level of the strongest line up to an order, dB."""
        top = max(3, int(highest_order / self.order_step))
        return float(np.max(self.level_db[2:top]))

    def at(self, orders: FloatArray) -> tuple[FloatArray, FloatArray]:
        """(largest level within a bin, floor) at orders (n,); NaN beyond the spectrum."""
        place = np.rint(orders / self.order_step).astype(np.int64)
        inside = (place >= 2) & (place < self.level_db.size - 2)
        safe = np.clip(place, 2, self.level_db.size - 3)
        top = np.max(np.stack([self.level_db[safe + k] for k in (-1, 0, 1)]), axis=0)
        return np.where(inside, top, np.nan), np.where(inside, self.floor_db[safe], np.nan)


def order_lines(observation: Observation, channel: str) -> OrderLines | None:
    """Order spectrum of a channel over the reference shaft (Hann); None where the angle covers no turn."""
    kept = observation.kept.lines
    if channel not in kept:
        kept[channel] = _order_lines(observation, channel)
    return kept[channel]


def _order_lines(observation: Observation, channel: str) -> OrderLines | None:
    e = observation.channel(channel)
    assert e is not None
    series = observation.recording.series(channel)
    per_turn = max(16, int(series.sampling_rate_hz / observation.speed.speed_hz))
    try:
        values = resample_in_angle(series, e.angle_rad, per_turn)
    except SpecError:
        return None
    window = np.hanning(values.size)
    power = np.abs(fft.rfft((values - np.mean(values)) * window)) ** 2 * (2 / np.sum(window)) ** 2 / 2
    floor = running_median(power) / EXPONENTIAL_MEDIAN
    tiny = max(float(np.max(power)) * 1e-18, np.finfo(np.float64).tiny)
    return OrderLines(
        level_db=10 * np.log10(power + tiny), floor_db=10 * np.log10(floor + tiny), order_step=per_turn / values.size
    )


def matched(test: Observation, baselines: Sequence[Observation]) -> Observation | None:
    """The baseline nearest in speed, within 3 %: levels of lines change with speed, depths less."""
    near = min(
        (b for b in baselines if b.recording.sampling_rate_hz == test.recording.sampling_rate_hz),
        key=lambda b: abs(b.speed.speed_hz / test.speed.speed_hz - 1),
        default=None,
    )
    if near is None or abs(near.speed.speed_hz / test.speed.speed_hz - 1) > SAME_SPEED:
        return None
    return near


def at_half_of_speeds(tests: Sequence[tuple[float, bool]]) -> bool:
    """Whether what is told of tests (speed in Hz, whether it has grown) has grown at half of their speeds or more.

    Tests within 3 % are of one speed, at which one that shows it is enough: a fault may be as new as the last of them.
    """
    groups: list[tuple[float, bool]] = []
    for speed, grown in sorted(tests):
        if groups and speed / groups[-1][0] - 1 <= SAME_SPEED:
            groups[-1] = (groups[-1][0], groups[-1][1] or grown)
        else:
            groups.append((speed, grown))
    return 2 * sum(grown for _, grown in groups) >= len(groups)


def level_changes(now: OrderLines, before: OrderLines, orders: FloatArray, half_width: float) -> FloatArray:
    """Change of the power within `half_width` of each order, dB, (n,); NaN where the line is not there now.

    Power over a width, not the peak: a speed that wanders more spreads every line without weakening it.
    """
    power, floor = now.within(orders, half_width)
    old, _ = before.within(orders, half_width)
    return np.where(power > floor * 10 ** (PRESENT_DB / 10), 10 * np.log10(power / old), np.nan)


def spectra_of(test: Observation, base: Observation) -> list[tuple[str, OrderLines, OrderLines]]:
    """(channel, its lines now, its lines before) of the channels both have."""
    rows = []
    for channel in (n for n in test.recording.names if n in base.recording.names):
        now, before = order_lines(test, channel), order_lines(base, channel)
        if now is not None and before is not None:
            rows.append((channel, now, before))
    return rows


def line_growth(now: OrderLines, before: OrderLines, orders: FloatArray, within_db: float) -> FloatArray:
    """Growth of the peaks at orders, dB, (n,), after the channel's own change of floor; NaN where no line is clear or
    it is more than `within_db` below the strongest up to order 10."""
    level, floor = now.at(orders)
    old, old_floor = before.at(orders)
    with np.errstate(invalid="ignore"):
        there = (level - floor >= CLEAR_DB) & (level >= now.strongest(STRONGEST_TO) - within_db)
        return np.where(there & np.isfinite(old), level - np.maximum(old, old_floor) - (floor - old_floor), np.nan)
