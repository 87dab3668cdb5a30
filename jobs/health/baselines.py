"""Which recordings a recording is compared with, and what its features are like in them."""

from __future__ import annotations

from collections.abc import Sequence

from jobs.health.points import Operating, Point
from jobs.health.rules import Baseline, baseline_of

LIKE_SPEED, LIKE_TORQUE = 0.03, 0.1
RATE_TOLERANCE = 1e-6
LEAST_SHARE = 0.5
"""Of a baseline's length that a recording must last. The level that noise puts where no line is rises as one over the
square root of the length (half: 3 dB, half of the least rise), and few impacts scatter a kurtosis."""
OF_ANY_LENGTH = ("rms",)
"""A mean power is the same however long one looks."""
SPOILING = ("not_finite", "constant", "stuck", "dropout", "clipping")
"""Defects with which a channel is no baseline."""


class Like:
    """Baselines of one operating point and rate. What they say of a feature is worked out once."""

    def __init__(self, points: Sequence[Point]) -> None:
        self._points = tuple(points)
        self._known: dict[tuple[str, tuple[str, ...], str], Baseline | None] = {}

    def __len__(self) -> int:
        return len(self._points)

    @property
    def longest_s(self) -> float:
        """Of the longest of them; 0 where there is none."""
        return max((p.duration_s for p in self._points), default=0.0)

    def of(self, channel: str, place: tuple[str, ...], feature: str) -> Baseline | None:
        """Of one feature of one channel; None where fewer than 8 recordings have it."""
        key = (channel, place, feature)
        if key not in self._known:
            values = [value for p in self._points if (value := _value(p, channel, place, feature))]
            self._known[key] = baseline_of(values)
        return self._known[key]


class Baselines:
    """The baseline recordings of a machine."""

    def __init__(self, points: Sequence[Point]) -> None:
        self._points = [p for p in points if p.baseline]
        self._groups: dict[tuple[str, ...], Like] = {}

    def like(self, point: Point) -> Like:
        """Those at the operating point and rate of `point`, none of them more than twice as long."""
        return self._group([p for p in self._points if alike(p, point) and lasts(point, p)])

    def of_any_length(self, point: Point) -> Like:
        """Those at the operating point and rate of `point`."""
        return self._group([p for p in self._points if alike(p, point)])

    def _group(self, found: Sequence[Point]) -> Like:
        return self._groups.setdefault(tuple(p.recording for p in found), Like(found))


def alike(a: Point, b: Point) -> bool:
    """Whether features may be compared: same version and rate, speed within 3 %, torque within 10 %."""
    same_rate = abs(a.sampling_rate_hz / b.sampling_rate_hz - 1) <= RATE_TOLERANCE
    return a.version == b.version and same_rate and _same_point(a.operating, b.operating)


def lasts(point: Point, baseline: Point) -> bool:
    """Whether a recording is long enough, beside a baseline, for features that read noise where no line is."""
    return point.duration_s >= LEAST_SHARE * baseline.duration_s * (1 - RATE_TOLERANCE)


def _same_point(a: Operating | None, b: Operating | None) -> bool:
    if a is None or b is None:
        return a is b
    if a.shaft != b.shaft or abs(a.speed_hz - b.speed_hz) > LIKE_SPEED * max(a.speed_hz, b.speed_hz):
        return False
    if a.torque_nm is None or b.torque_nm is None:
        return a.torque_nm is b.torque_nm
    return abs(a.torque_nm - b.torque_nm) <= LIKE_TORQUE * max(abs(a.torque_nm), abs(b.torque_nm))


def _value(point: Point, channel: str, place: tuple[str, ...], feature: str) -> float | None:
    """The feature, where the channel is the same and whole."""
    entry = point.channels.get(channel)
    if entry is None or entry.place != place:
        return None
    if any(f["channel"] == channel and f["kind"] in SPOILING for f in point.findings):
        return None
    return entry.features.get(feature)
