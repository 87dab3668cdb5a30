"""How far apart in angle a ball strikes the two edges of a pit: the second peak of its impacts' autocorrelation.

A ball that enters a pit and one that leaves it strike twice, the pit's length over the rolling speed apart (N. Sawalhi
and R. B. Randall, Mech. Syst. Signal Process. 25 (2011) 846-870). Over the ball's period that is one share at every
speed, while ringing and a ring that falls back take a time: autocorrelations of squared envelopes are laid over each
other by shares, of all bands, channels and speeds, and what is left of a rise is the second strike. Teeth in mesh come
at one share too: what comes with all multiples of their period is taken off, and what of it the baseline shows.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import fft

from reconcile.kinematics.envelopes import KNOCK_LIMIT, LINE_LIMIT
from reconcile.observe.impact_bands import HIGHEST_SHARE, ComplexArray
from signals.series import FloatArray

BANDS_HZ = ((300.0, 2500.0), (1500.0, 5000.0), (3000.0, 9400.0), (300.0, 9400.0))
"""Wide, so that strikes a fraction of a millisecond apart are two."""
Places = np.ndarray[tuple[int], np.dtype[np.intp]]
SHARES = np.exp(np.linspace(np.log(0.015), np.log(1.12), 320))
"""Of the ball's period, at which an autocorrelation is taken."""
FINE, COARSE = 0.05, 0.2
"""Widths in the logarithm of the share: a rise is what the finer mean shows over the coarser."""
MIDDLE, BETWEEN = (0.28, 0.56), (0.3, 0.7)
"""Shares where no second strike of one pit is: multiples of the teeth's period there say what teeth show; and those
over whose middle the peak at the period is measured."""
FIRST, LAST = 0.03, 0.21
"""Shares between which a rise may be the far edge: nearer is ringing, later a ring that falls back, or another pit."""
APART = 2.0
"""Least lag at every speed, over the resolution of the widest band."""
LEAST = 0.006
"""Height of a rise that counts, of the autocorrelation at no lag: what is not a second strike reaches 0.004 in pits of
the proof that are too short to part."""
EACH, AGAINST = 0.003, 0.3
"""Height that most speeds must show at the same share, and how far below none, in shares of that of all, one may
lie."""
BESIDE_TEETH = 0.08
"""Of the teeth's period, within which a rise is theirs."""
ASIDE = 1.5
"""Ratio of shares to either side within which a rise is the highest."""
ROW, ROW_WIDE = 0.4, 1.1
"""Share of its height from which another rise, half or twice as far within this ratio, makes it one of a row."""
LEAST_SHARES = 3
"""That are looked at."""
FASTER = 1.25
"""Ratio of the fastest to the slowest speed: at one speed nothing parts a length from a time."""


@dataclass(frozen=True, kw_only=True)
class Struck:
    """What is heard at one speed: transforms of the test and of the baseline, (C, count // 2 + 1), over the roots of
    one floor's density, and the rates in Hz at which balls pass the pit in each; `speed_hz` of the shaft, `teeth_hz`:
    rates of meshes."""

    test: ComplexArray
    baseline: ComplexArray
    count: int
    rate_hz: float
    test_hz: float
    baseline_hz: float
    speed_hz: float
    teeth_hz: tuple[float, ...] = ()


def second_strike(points: Sequence[Struck]) -> float | None:
    """Share of the ball's period between its two strikes; None where no rise is heard at all speeds, or these are
    nearly one."""
    if not points or max(p.speed_hz for p in points) < FASTER * min(p.speed_hz for p in points):
        return None
    heard = [both for p in points if (both := _rises(p)) is not None]
    if len(heard) < len(points):
        return None
    weight = sum(w for _, _, w in heard)
    test, baseline = (np.asarray(sum(one[k] * one[2] for one in heard) / weight) for k in (0, 1))
    nearest = max(APART / max(high - low for low, high in _bands(p.rate_hz)) * p.test_hz for p in points)
    inside = _within(max(nearest, FIRST), LAST)
    if inside.size < LEAST_SHARES:
        return None
    rise, *each = _new(test, baseline, inside, [(t, b) for t, b, _ in heard])
    teeth = [p.test_hz / hz for p in points for hz in p.teeth_hz]
    speeds = [p.speed_hz for p in points]
    told = [
        int(k)
        for k in inside
        if _peak(rise, int(k))
        and _at_speeds(speeds, [float(one[k]) for one in each], float(rise[k]))
        and all(abs(SHARES[k] / period - 1.0) > BESIDE_TEETH for period in teeth)
        and not _in_a_row(rise, int(k))
    ]
    return float(SHARES[max(told, key=lambda k: float(rise[k]))]) if told else None


def _new(
    test: FloatArray, baseline: FloatArray, inside: Places, each: Sequence[tuple[FloatArray, FloatArray]]
) -> list[FloatArray]:
    """What of the rises of a test, and of each of its speeds, is not in the baseline's, as far as these are there."""
    power = max(float(baseline[inside] @ baseline[inside]), 1e-30)
    old = float(np.clip(test[inside] @ baseline[inside] / power, 0.0, 1.0))
    return [t - old * np.maximum(b, 0.0) for t, b in ((test, baseline), *each)]


def _within(low: float, high: float) -> Places:
    """Places of the shares between two."""
    return np.asarray(np.flatnonzero((low < SHARES) & (high > SHARES)))


def _peak(rise: FloatArray, at: int) -> bool:
    """Whether a rise is the highest near a share, and as high over what is on either side."""
    before, after = rise[_within(SHARES[at] / ASIDE, SHARES[at])], rise[_within(SHARES[at], SHARES[at] * ASIDE)]
    highest = rise[at] > before.max() and rise[at] >= after.max()
    return bool(highest and rise[at] - max(before.min(), after.min(), 0.0) >= LEAST)


def _in_a_row(rise: FloatArray, at: int) -> bool:
    """Whether about half or twice as far another rise is, as of what comes again and again."""
    others = [rise[_within(SHARES[at] * far / ROW_WIDE, SHARES[at] * far * ROW_WIDE)] for far in (0.5, 2.0)]
    return any(float(one.max(initial=0.0)) >= ROW * rise[at] for one in others)


def _at_speeds(speeds_hz: Sequence[float], heights: Sequence[float], height: float) -> bool:
    """Whether most speeds show a rise at a share, not such alone as are nearly one, and none the contrary."""
    shown = [hz for hz, own in zip(speeds_hz, heights, strict=True) if own >= EACH]
    if len(shown) <= len(heights) / 2 or min(heights) < -AGAINST * height:
        return False
    return max(shown) >= FASTER * min(shown)


def _bands(rate_hz: float) -> list[tuple[float, float]]:
    return [(low, high) for low, high in BANDS_HZ if high <= HIGHEST_SHARE * rate_hz]


def _rises(point: Struck) -> tuple[FloatArray, FloatArray, float] | None:
    """Rises (shares,) of test and baseline, bands and channels weighted by how firmly the test strikes there, and the
    sum of weights; None where it does nowhere."""
    if not _bands(point.rate_hz):
        return None
    test, baseline = (
        np.array([_autocorrelations(np.asarray(row), point, hz) for row in white])
        for white, hz in ((point.test, point.test_hz), (point.baseline, point.baseline_hz))
    )
    weights = np.apply_along_axis(_period, 2, test)
    total = float(weights.sum())
    if total <= 0.0:
        return None
    mean = (np.einsum("cb,cbs->s", weights, one) / total for one in (test, baseline))
    first, second = (_rise(_without_teeth(one, point)) for one in mean)
    return first, second, total


def _autocorrelations(white: ComplexArray, point: Struck, hz: float) -> list[FloatArray]:
    """Of the squared envelope in each band at the shares of the period, 1 at no lag."""
    size = np.abs(white) / np.sqrt(0.5 * point.count * point.rate_hz)
    limited = white * np.minimum(1.0, LINE_LIMIT / np.maximum(size, 1e-12))
    found = []
    for low, high in _bands(point.rate_hz):
        first, last = (int(edge * point.count / point.rate_hz) for edge in (low, high))
        wide = fft.next_fast_len(2 * (last - first))
        padded = np.zeros(wide, dtype=np.complex128)
        padded[: last - first] = limited[first:last]
        envelope = fft.ifft(padded)
        square = envelope.real**2 + envelope.imag**2
        square = np.minimum(square, KNOCK_LIMIT * square.mean())
        power = np.abs(fft.rfft(square - square.mean(), fft.next_fast_len(2 * wide))) ** 2
        curve = fft.irfft(power)[:wide]
        lags = np.arange(wide) * point.count / point.rate_hz / wide
        found.append(np.interp(SHARES / hz, lags, curve / max(float(curve[0]), 1e-300)))
    return found


def _period(curve: FloatArray) -> float:
    """Height of the peak at the ball's period over the middle between two; 0 without one."""
    middle = np.median(curve[_within(*BETWEEN)])
    return max(float(curve[np.abs(SHARES - 1.0) < 0.05].max() - middle), 0.0)


def _without_teeth(curve: FloatArray, point: Struck) -> FloatArray:
    """Less the mean of what comes whole periods of the teeth later, in the middle between two balls."""
    for hz in point.teeth_hz:
        period = point.test_hz / hz
        later = [k * period for k in range(1, int(MIDDLE[1] / period) + 1) if k * period > MIDDLE[0]]
        if later:
            logs = np.log(np.minimum(SHARES[:, None] + np.array(later), SHARES[-1]))
            curve = curve - np.interp(logs, np.log(SHARES), curve).mean(axis=1)
    return curve


def _rise(curve: FloatArray) -> FloatArray:
    return _smooth(curve, FINE) - _smooth(curve, COARSE)


def _smooth(curve: FloatArray, width: float) -> FloatArray:
    """Normal mean over the logarithm of the share."""
    step = float(np.log(SHARES[1] / SHARES[0]))
    reach = int(np.ceil(4.0 * width / step))
    kernel = np.exp(-0.5 * (np.arange(-reach, reach + 1) * step / width) ** 2)
    return np.asarray(np.convolve(np.pad(curve, reach, "edge"), kernel / kernel.sum(), "valid"))
