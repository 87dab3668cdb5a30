"""How long a spall is: a ball entering it and striking its far edge make two events, apart by its length.

N. Sawalhi and R. B. Randall, "Vibration response of spalled rolling element bearings: observations, simulations and
signal processing techniques to track the spall size", Mech. Syst. Signal Process. 25 (2011) 846-870. In the
autocorrelation of the squared envelope the two are a peak at their distance and satellites around the period; random
slip between balls does not smear it. The strike comes when the ball's centre is between half way (an edge it falls
against while the other still carries it) and the whole way over the spall: the interval says so.

A rotor or ring that the pit threw off its balls falls back as a second event too, after a time that has little to do
with the pit's length. Only speeds tell the two apart: over a spall the lag is one angle, a fall is none.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy
from scipy import fft

from reconcile.kinematics.envelopes import squared_envelope
from reconcile.kinematics.evidence import Evidence
from reconcile.kinematics.families import Ties
from reconcile.kinematics.observe import Observation
from reconcile.verdict import Severity
from signals.series import FloatArray

STRIKE = 0.75
"""Where on the way over the spall the ball strikes: the middle of what geometry allows."""
STRIKE_RANGE = (0.5, 1.0)
PROMINENCE = 0.1
"""Of a peak of the autocorrelation, over the height of the peak at the period."""
MATE_SHARE = 0.4
"""Prominence asked for of the satellite over that of the peak: it sits on the slope of the period's."""
NOISE_TIMES = 6.0
LEAST_PERIOD = 0.03
"""Height of the peak at the period (1 at lag 0) without which a second event would not be seen either."""
FIRST_SHARE, LAST_SHARE = 0.03, 0.45
"""Lags looked at, share of the period: nearer is ringing, at half lie second defects."""
SURE_SHARE = 0.25
"""Of the period, up to which a second event is the far edge: a ring that a deep pit threw off its balls falls back
later (of a simulated pit of 1 mm after 0.39 of it), and spalls that long are rare."""
APART = 0.08
"""Of the period, further than which from the pair's own peaks and the period another one is a strike of its own: of
equal strikes many a ball pass, as fluting makes them, of an edge half way to the next ball. Two strikes 8 mm apart of
16 have it at 0.48, a washboard three; pits of three measured rigs whose size is told none."""
SPEEDS_APART, ANGLES_ALIKE = 1.25, 1.15
"""Ratio of the speeds that two lags are heard at from which on they are compared, and by which their angles may differ:
of one fall, a constant time, they would differ as the speeds do."""
BANDS = ((0.02, 0.24), (0.05, 0.5), (0.01, 0.49), (0.24, 0.48))
"""Of the sampling rate."""
EXTREME = 0.999
CUT_SHARE = 2e-3
"""Of samples at the extreme value: signals that are not cut off have a few."""


@dataclass(frozen=True, kw_only=True)
class Extent:
    """Angle on the race with its interval, degrees; `resolved` False: only `high_deg` is known; `struck`: what is heard
    second may be a rebound."""

    degrees: float
    low_deg: float
    high_deg: float
    lag_s: float
    resolved: bool
    struck: bool = False


def spall_extent(evidence: Evidence, test: Observation, ties: Ties) -> Extent | None:
    """Extent of an outer or inner spall; None for other families, where the record cannot resolve anything, where its
    channel is cut off (what stands at the limit has lost the heights of both events), where the second event may be a
    rebound, and where strikes stand more than a quarter of the period apart, or many of them."""
    family = evidence.family
    if family.kind not in ("outer", "inner") or family.site not in ties.races or _cut_off(test, evidence.channel):
        return None
    race = ties.races[family.site]
    rate_hz = evidence.order * test.speed.speed_hz
    period = 1 / rate_hz
    lags, curve = _autocorrelation(test, evidence, 1.6 * period)
    degrees_per_s = 360.0 * rate_hz / race.balls
    fallen = np.flatnonzero(curve < 0.2)
    first = max(FIRST_SHARE * period, 1.5 * float(lags[fallen[0]]) if fallen.size else period)
    if first > LAST_SHARE * period:
        return None
    near = curve[np.abs(lags / period - 1) < 0.05]
    height = float(np.max(near) - np.median(curve))
    if height < LEAST_PERIOD:
        return None
    lag, more = _pair_lag(lags, curve, period, first, PROMINENCE * height)
    if more or (lag or 0.0) > SURE_SHARE * period:
        return None
    if lag is None:
        high = degrees_per_s * first / STRIKE_RANGE[0]
        return Extent(degrees=high / 2, low_deg=0.0, high_deg=high, lag_s=first, resolved=False)
    angle = degrees_per_s * lag
    return Extent(
        degrees=angle / STRIKE,
        low_deg=angle / STRIKE_RANGE[1],
        high_deg=angle / STRIKE_RANGE[0],
        lag_s=lag,
        resolved=True,
    )


def told_extent(found: Sequence[tuple[float, Extent]]) -> Extent | None:
    """What recordings say together, of (speed, extent) of each: the median length where most have a second event, with
    its interval where the events are one angle at speeds that differ, from nothing on where all speeds are about one;
    else the tightest bound."""
    if not found:
        return None
    resolved = sorted((pair for pair in found if pair[1].resolved), key=lambda pair: pair[1].degrees)
    middle = resolved[len(resolved) // 2][1] if 2 * len(resolved) >= len(found) else None
    if middle is not None and all(x.high_deg >= middle.degrees for _, x in found):
        speeds = [hz for hz, _ in resolved]
        if max(speeds) < SPEEDS_APART * min(speeds):
            return replace(middle, low_deg=0.0, struck=True)
        if resolved[-1][1].degrees <= ANGLES_ALIKE * resolved[0][1].degrees:
            return middle
    least = min((x for _, x in found), key=lambda x: x.high_deg)
    if not least.resolved:
        return least
    return replace(least, degrees=least.high_deg / 2, low_deg=0.0, resolved=False, struck=True)


def _cut_off(test: Observation, channel: str) -> bool:
    """Whether the channel stands at its extreme value for more than a moment."""
    size = np.abs(test.recording.series(channel).samples)
    return bool(np.mean(size >= EXTREME * np.max(size)) > CUT_SHARE)


def as_severity(extent: Extent, evidence: Evidence, ties: Ties) -> Severity:
    """Arc length in m where the sizes are known (the severity parameter of the spall terms), else degrees."""
    race = ties.races[evidence.family.site]
    if race.pitch_m is None:
        return Severity(name="extent", value=extent.degrees, unit="deg", low=extent.low_deg, high=extent.high_deg)
    side = 1 + race.ratio if evidence.family.kind == "outer" else 1 - race.ratio
    metre = race.pitch_m / 2 * side * np.pi / 180
    return Severity(
        name="width",
        value=float(extent.degrees * metre),
        unit="m",
        low=float(extent.low_deg * metre),
        high=float(extent.high_deg * metre),
    )


def _autocorrelation(test: Observation, evidence: Evidence, longest_s: float) -> tuple[FloatArray, FloatArray]:
    """(lags in s, mean over bands of the squared envelope's autocorrelation), both (lags,): wide ones and its own."""
    series = test.recording.series(evidence.channel)
    rate = series.sampling_rate_hz
    white = test.white(evidence.channel)
    lags = np.arange(int(longest_s * rate / 2)) * 2 / rate
    total = np.zeros(lags.size)
    bands = [*((low * rate, high * rate) for low, high in BANDS), evidence.band_hz]
    for low, high in bands:
        square, envelope_rate, _ = squared_envelope(white, low, high, rate, np.inf)
        centred = np.minimum(square, np.quantile(square, EXTREME))
        centred = centred - np.mean(centred)
        power = np.abs(fft.rfft(centred, fft.next_fast_len(2 * centred.size))) ** 2
        curve = fft.irfft(power)[: int(longest_s * envelope_rate) + 2]
        total += np.interp(lags, np.arange(curve.size) / envelope_rate, curve / curve[0]) / len(bands)
    return lags, total


def _pair_lag(
    lags: FloatArray, curve: FloatArray, period: float, first: float, least: float
) -> tuple[float | None, bool]:
    """(lag of a peak that has a satellite at the period less it, s; whether strikes stand further apart as well)."""
    step = float(lags[1])
    smooth = np.convolve(curve, np.ones(3) / 3, mode="same")
    # ringing of the structure makes ripples: peaks closer than half the first lag are one event
    # the second difference of white noise has six times its variance; slopes and peaks hardly show in its median
    noise = 1.4826 * float(np.median(np.abs(np.diff(smooth[lags > 0.3 * period], 2)))) / np.sqrt(6)
    least = max(least, NOISE_TIMES * noise)
    places, facts = scipy.signal.find_peaks(
        smooth, prominence=MATE_SHARE * least, distance=max(1, int(first / 2 / step))
    )
    prominence = dict(zip(places.tolist(), facts["prominences"].tolist(), strict=True))
    best: tuple[float, float] | None = None
    for place, height in prominence.items():
        at = float(lags[place])
        if height < least or not first <= at <= LAST_SHARE * period:
            continue
        mates = [p for p in prominence if abs(lags[p] - (period - at)) < max(0.02 * period, 3 * step)]
        if not mates:
            continue
        score = height + max(prominence[p] for p in mates)
        if best is None or score > best[0]:
            best = (score, at)
    lag = None if best is None else best[1]
    own = (period,) if lag is None else (lag, period - lag, period)
    later = [p for p, height in prominence.items() if height >= least and SURE_SHARE * period < lags[p] < period]
    return lag, any(all(abs(lags[p] - place) > APART * period for place in own) for p in later)
