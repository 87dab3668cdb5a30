"""Speed of a shaft from a recording: tacho, else the harmonics it makes around the speed it was said to have.

Labels can be several per cent wrong (a motor slips, a file is named after the nominal speed). The score of a speed is
the sum over its orders and over channels of the logarithm of power over the local floor, the multi-order idea of
Q. Leclere, H. Andre and J. Antoni, Mech. Syst. Signal Process. 81 (2016) 375-386. The same search on combs of other
spacings says what the best of so many speeds reaches by chance.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.ndimage import maximum_filter1d

from reconcile.compiled.speeds import add_combs
from reconcile.speed.excess import line_excess, mains_bins, skirts
from reconcile.speed.octave import octave_rival
from reconcile.speed.refine import refined
from signals.recording import Recording
from signals.series import FloatArray
from sim.core.errors import Problem, SpecError

Method = Literal["tacho", "harmonics", "stated"]
HARMONICS = tuple(float(k) for k in range(1, 9))
SEARCH = 0.1
LARGEST_LOG = 11.0
"""A line counts up to this log power over what noise reaches: one strong foreign line must not outweigh a comb."""
NOISE_LOG = 3.0
"""Log power over the floor that one bin in 5e8 of noise exceeds (exp(-e^3)); below it nothing counts."""
LOBE_BINS = 3
"""Half width of a steady line in the spectrum, with a bin to spare."""
STEADY_LOG = 5.5
"""Log power by which a steady line has fallen two bins from its middle: by the Hann window 14 dB at least, 24 on the
mean."""
CONTROLS = 60
USUAL_ERROR = 0.03
"""Standard deviation of what a stated speed is wrong by: labels up to 7 % off have been met."""
ENOUGH = 0.8
"""Confidence from which the found speed replaces the stated one."""
MIN_TURNS = 4.0
SAME = 1e-9
"""Scores that differ by less are of the same bins."""


@dataclass(frozen=True, kw_only=True)
class SpeedEstimate:
    """Mean speed of `shaft` with an interval; `confidence` 0..1 that lines (or pulses) of the shaft were found."""

    shaft: str
    speed_hz: float
    low_hz: float
    high_hz: float
    confidence: float
    method: Method
    stated_hz: float | None
    rival_hz: float | None = None
    """Half or twice the speed, where that explains the shaft's lines as well: harmonics don't decide then."""

    @property
    def mismatch(self) -> float | None:
        """Relative difference from the stated speed."""
        return None if self.stated_hz is None else self.speed_hz / self.stated_hz - 1


def estimate_speed(
    recording: Recording,
    *,
    shaft: str | None = None,
    stated_hz: float | None = None,
    orders: Sequence[float] = (),
    search: float = SEARCH,
    seed: int = 0,
) -> SpeedEstimate:
    """Mean speed of `shaft` (default: that of the operating point), Hz.

    `stated_hz` defaults to the operating point's; `orders` are further cycles per revolution that surely belong to
    the shaft (teeth of its gears and their multiples). Without pulses and without a clear comb the stated speed is
    returned with its low confidence and the whole search range as interval.
    """
    operating = recording.operating
    name = shaft or (operating.shaft if operating else "shaft")
    stated = stated_hz if stated_hz is not None else (operating.speed_hz if operating else None)
    if recording.tacho is not None and recording.tacho.shaft == name:
        return _by_pulses(recording, name, stated)
    stated = _checked(recording, stated, search)
    combs = line_logs(recording)
    coarse, confidence, found_by = coarse_speed(combs, orders, stated, search, seed)
    if confidence < ENOUGH:
        low, high = stated * (1 - search), stated * (1 + search)
        return SpeedEstimate(
            shaft=name,
            speed_hz=stated,
            low_hz=low,
            high_hz=high,
            confidence=confidence,
            method="stated",
            stated_hz=stated,
        )
    # a line near the shaft's own must not lead away from the teeth
    speed, half = refined(combs, coarse, found_by)
    return SpeedEstimate(
        shaft=name,
        speed_hz=speed,
        low_hz=speed - half,
        high_hz=speed + half,
        confidence=confidence,
        method="harmonics",
        stated_hz=stated,
        rival_hz=octave_rival(combs, speed, HARMONICS, orders),
    )


def coarse_speed(
    combs: Sequence[tuple[FloatArray, float]], orders: Sequence[float], stated: float, search: float, seed: int
) -> tuple[float, float, tuple[float, ...]]:
    """Speed, confidence and the orders to refine it by: `orders` alone, being finer, where they are sure and lie with
    the shaft's harmonics or explain more; else the harmonics too, if these are sure."""
    by_shaft = _found(combs, HARMONICS, stated, search, seed)
    if not orders:
        return *by_shaft, HARMONICS
    by_orders = _found(combs, orders, stated, search, seed)
    first, second = by_shaft[0], by_orders[0]
    alike = abs(first - second) <= combs[0][1]
    surer = by_orders[1] >= ENOUGH and (alike or _explains_more(combs, orders, second, first))
    if by_shaft[1] >= ENOUGH and not surer:
        return *by_shaft, (*HARMONICS, *orders)
    return second, max(by_shaft[1], by_orders[1]), tuple(orders)


def _found(
    combs: Sequence[tuple[FloatArray, float]], orders: Sequence[float], stated: float, search: float, seed: int
) -> tuple[float, float]:
    """Best speed of a comb and the confidence in it."""
    lines = [(maximum_filter1d(narrowed(log), 3), width) for log, width in combs]
    speeds, score = _best_speed(lines, orders, stated, search)
    best = int(np.argmax(score))
    confidence = _confidence(lines, orders, float(score[best]), stated, search, seed)
    return _middle(speeds, score - _log_prior(speeds, stated), best), confidence


def _middle(speeds: FloatArray, score: FloatArray, best: int) -> float:
    """Middle of the speeds around that at `best` for which the same bins speak.

    Few lines are in reach of a range of speeds, of which the prior takes the end nearest to the stated one.
    """
    low = high = best
    while low > 0 and abs(score[low - 1] - score[best]) <= SAME:
        low -= 1
    while high + 1 < score.size and abs(score[high + 1] - score[best]) <= SAME:
        high += 1
    return float((speeds[low] + speeds[high]) / 2)


def _explains_more(
    combs: Sequence[tuple[FloatArray, float]], orders: Sequence[float], one: float, other: float
) -> bool:
    """Whether shaft's harmonics and `orders` together have more at the speed `one` than at the `other`."""
    totals = []
    for speed in (one, other):
        near = np.array([speed])
        totals.append(
            sum(
                float(comb_score(maximum_filter1d(log, 3), width, near, comb)[0])
                for log, width in combs
                for comb in (HARMONICS, orders)
            )
        )
    return totals[0] > totals[1]


def _checked(recording: Recording, stated: float | None, search: float) -> float:
    if stated is None or not (np.isfinite(stated) and stated > 0):
        raise SpecError(
            Problem(
                field="operating.speed_hz",
                message="is needed where there is no tacho: the search starts from it",
                given=stated,
                allowed="above 0",
                unit="Hz",
            )
        )
    if not 0 < search <= 0.3:
        raise SpecError(Problem(field="search", message="is out of range", given=search, allowed="above 0, up to 0.3"))
    _long_enough(recording, stated)
    return float(stated)


def _long_enough(recording: Recording, speed_hz: float) -> None:
    if speed_hz * recording.duration_s < MIN_TURNS:
        raise SpecError(
            Problem(
                field="samples",
                message="are too short to hold the turns needed to read a speed",
                given=f"{recording.duration_s:.4g} s, {speed_hz * recording.duration_s:.3g} turns",
                allowed=f"at least {MIN_TURNS:g} turns, {MIN_TURNS / speed_hz:.3g} s at {speed_hz:.4g} Hz",
            )
        )


def _by_pulses(recording: Recording, shaft: str, stated: float | None) -> SpeedEstimate:
    """Mean speed of the pulses; the interval is that of the jitter of their intervals."""
    assert recording.tacho is not None
    pulses = np.asarray(recording.tacho.pulse_times_s, dtype=np.float64)
    steps = np.diff(pulses)
    if pulses.size < 3 or not np.all(steps > 0):
        message, given = "must be at least three rising times", f"{pulses.size} pulses"
        allowed = "3 or more, each later than the one before"
        raise SpecError(Problem(field="tacho.pulse_times_s", message=message, given=given, allowed=allowed, unit="s"))
    per_turn = recording.tacho.pulses_per_revolution
    speed = (pulses.size - 1) / float(pulses[-1] - pulses[0]) / per_turn
    _long_enough(recording, speed)
    half = float(np.std(steps)) / float(np.mean(steps)) * speed * 2 / (pulses.size - 1)
    return SpeedEstimate(
        shaft=shaft,
        speed_hz=speed,
        low_hz=speed - half,
        high_hz=speed + half,
        confidence=1.0,
        method="tacho",
        stated_hz=stated,
    )


def line_logs(recording: Recording) -> tuple[tuple[FloatArray, float], ...]:
    """Log power over noise of each channel (0 in noise; mains lines and the skirts of strong lines left out) with the
    resolution, Hz."""
    found = []
    for name in recording.names:
        ratio, resolution = line_excess(recording.series(name))
        ratio[skirts(ratio)] = 1.0
        raw = np.log(np.maximum(ratio, 1.0)) - NOISE_LOG
        beyond = np.maximum(maximum_filter1d(raw, 2 * LOBE_BINS + 1) - LARGEST_LOG, 0.0)  # keeps the shape of the line
        log = np.clip(raw - beyond, 0.0, LARGEST_LOG)
        log[mains_bins(log.size, resolution)] = 0.0
        found.append((log, resolution))
    return tuple(found)


def _best_speed(
    lines: Sequence[tuple[FloatArray, float]], orders: Sequence[float], stated: float, search: float
) -> tuple[FloatArray, FloatArray]:
    """Speeds of the grid and their scores by lines that are `narrowed`, both of shape (speeds,)."""
    resolution = lines[0][1]
    step = resolution / (2 * max(orders))
    speeds = stated * (1 - search) + step * np.arange(int(2 * search * stated / step) + 1, dtype=np.float64)
    total = np.zeros(speeds.size)
    for wide, width in lines:
        total += comb_score(wide, width, speeds, orders)
    return speeds, total / len(lines) + _log_prior(speeds, stated)


def narrowed(log: FloatArray) -> FloatArray:
    """Log power of lines, of a steady one its middle alone: its flanks are in reach of speeds that it denies."""
    padded = np.pad(log, 2)
    near = np.stack([padded[1:-3], padded[3:-1]])
    far = np.stack([padded[:-4], padded[4:]])
    steady = (log > 0.0) & np.all(log >= near, axis=0) & np.all(far <= np.maximum(log - STEADY_LOG, 0.0), axis=0)
    found = log.copy()
    places = np.flatnonzero(steady)
    for step in (-1, 1):
        flank = places + step
        flank = flank[(flank >= 0) & (flank < log.size)]
        found[flank[~steady[flank]]] = 0.0
    return found


def _log_prior(speeds: FloatArray, stated: float) -> FloatArray:
    """Of a speed where one is stated, shape (speeds,)."""
    return np.asarray(-0.5 * ((speeds / stated - 1) / USUAL_ERROR) ** 2, dtype=np.float64)


def comb_score(log: FloatArray, resolution_hz: float, speeds_hz: FloatArray, orders: Sequence[float]) -> FloatArray:
    """Sum over orders of the value at order * speed (nearest bin; 0 beyond Nyquist), shape (speeds,).

    Weights 1/sqrt(order over the lowest): low harmonics are the ones a part has, high ones fall on anything.
    """
    total = np.zeros(speeds_hz.size)
    multiples = np.asarray(orders, dtype=np.float64)
    add_combs(log, resolution_hz, speeds_hz, multiples, np.sqrt(multiples / np.min(multiples)), total)
    return total


def _confidence(
    lines: Sequence[tuple[FloatArray, float]],
    orders: Sequence[float],
    best: float,
    stated: float,
    search: float,
    seed: int,
) -> float:
    """Share of combs of foreign spacing whose best score in an equally wide search is lower (smoothed, Gumbel)."""
    rng = np.random.default_rng(seed)
    tops: list[float] = []
    while len(tops) < CONTROLS:
        # a foreign comb: its harmonics must not be the shaft's (k j / 8 with small j would share many)
        factor = float(rng.uniform(1.1, 2.4))
        if abs(factor - round(2 * factor) / 2) < 2 * search / 3:
            continue
        tops.append(float(np.max(_best_speed(lines, orders, stated * factor, search)[1])))
    scale = max(float(np.std(tops)) * np.sqrt(6) / np.pi, 1.0)  # one unit of log power: no line, no confidence
    place = float(np.mean(tops)) - 0.5772 * scale
    return float(np.exp(-np.exp(-np.clip((best - place) / scale, -50.0, 50.0))))
