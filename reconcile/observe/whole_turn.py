"""What comes back at one place of a gear's turn, heard by all channels and in all bands together.

The mean turn of a gear (S. Braun, "The extraction of periodic waveforms by time domain averaging", Acustica 32 (1975)
69-77) without the lines of its meshes is a residual in which a faulty tooth stands out as a short burst (P. D.
McFadden, "Examination of a technique for the early detection of failure in gears by signal processing of the time
domain average of the meshing vibration", Mech. Syst. Signal Process. 1 (1987) 173-183). Here each order of it is
divided by its own error, which the turns give by how they differ, so that bands in which the burst is weak but clean
count as much as those in which it is loud and drowned; orders that only a few turns make large, or that stand out of
all around them, are lines of something else and are held down.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy

from signals.series import FloatArray

ComplexArray = np.ndarray[tuple[int, ...], np.dtype[np.complex128]]

LEAST_TURNS, MOST_TURNS = 5, 400
MOST_SAMPLES = 600_000
"""A channel, after resampling: more turns than these hold are left out."""
LEAST_ORDERS = 3
"""Unbalance, a bend and a coupling move the first two orders of a shaft."""
MESHES = 2
"""Harmonics of the teeth that the sampling rate must reach."""
WINDOW_TEETH = 1.2
BESIDE_TEETH = 2.0
"""From the middle of the fullest window on all else is the rest of the turn: a tooth is in mesh for one and a half to
two pitches."""
LEVELLED = 2.5
"""Times the level of the orders around it that an order may have at most."""
HELD = 1e-9
"""Share of its largest value by which a channel must move at least."""
STRONG = 0.2
"""Share of the strongest line of the teeth from which one tells by how much a record is louder."""
SOUND = 1.7
"""Height of the fullest window of sound gears heard by three sensors (298 mean turns of the proof's split `entire`:
half below 1.5, nine of ten below 1.8), which stands for a baseline's where there is none."""


@dataclass(frozen=True, kw_only=True)
class WholeTurn:
    """`windows`: power in windows of `WINDOW_TEETH` around each step of the turn over the middle of them, (steps,).

    `teeth`: of the gear; `turns`: that there are, of which all but the loudest at that
    place are averaged; `level`: that middle, over what noise alone makes.
    """

    windows: FloatArray
    teeth: int
    turns: int
    level: float = 1.0

    @property
    def at(self) -> int:
        """Step of the fullest window."""
        return int(np.argmax(self.windows))

    @property
    def height(self) -> float:
        """Of the fullest window."""
        return float(np.max(self.windows))

    @property
    def rest(self) -> float:
        """Of the fullest window of the rest of the turn."""
        steps = self.windows.size
        apart = min(int(BESIDE_TEETH * steps / self.teeth), steps // 2 - 1)
        turned = np.roll(self.windows, -self.at)
        return float(np.max(turned[apart : steps - apart + 1]))


@dataclass(frozen=True, kw_only=True)
class Turned:
    """`samples` (C, n) and the angle of the gear's shaft at each of them, turns (n,); NaN where it is not known."""

    samples: FloatArray
    turns: FloatArray


def whole_turns(
    now: Turned, before: Turned | None, *, teeth: Sequence[int]
) -> tuple[WholeTurn | None, WholeTurn | None]:
    """The mean turns of a gear of `teeth[0]` teeth in a test and its baseline (None without one).

    `teeth`: also of the other gears on that shaft. None where a recording is too short or too slowly sampled. Both are
    of as many turns and reach as high, and the cleaner one is made as noisy as the other over the lines of its teeth: a
    longer, louder or quieter record brings out of the noise what another one had too. A channel that holds one value in
    either is left out.
    """
    alive = _alive(now) & (_alive(before) if before is not None else True)
    if not np.any(alive):
        return None, None
    now = replace(now, samples=now.samples[alive])
    before = before if before is None else replace(before, samples=before.samples[alive])
    one, other = _each_turn(now), None if before is None else _each_turn(before)
    if one is not None and other is not None:
        count, orders = (min(one.shape[k], other.shape[k]) for k in (1, 2))
        one, other = _as_noisy(one[:, :count, :orders], other[:, :count, :orders], teeth)
    return _told(one, teeth), _told(other, teeth)


@dataclass(frozen=True, kw_only=True)
class Burst:
    """How far the fullest window of a test's mean turn stands above the middle of all windows (`power`), and that of
    its baseline (`usual`), both in units of what noise makes; `error` (C, orders): of the mean turn at each order, of
    which `kept` (orders,) count; `alive` (C,): channels that do."""

    power: float
    usual: float
    error: FloatArray
    kept: np.ndarray
    alive: np.ndarray
    teeth: int

    def power_of(self, added: Turned, factor: FloatArray) -> float:
        """The same of a motion without noise that reaches the recording by `factor` (C of those that count, orders);
        NaN where it holds too few turns."""
        each = _each_turn(replace(added, samples=added.samples[self.alive]))
        if each is None:
            return float("nan")
        mean = np.zeros(self.error.shape, dtype=np.complex128)
        count = min(self.kept.size, each.shape[2])
        mean[:, :count] = each[:, :, :count].mean(axis=1)
        white = np.where(self.kept, factor * mean / self.error, 0.0)
        power = np.mean(_power(white), axis=0)
        return float(_windows(power, max(3, int(WINDOW_TEETH * power.size / self.teeth))).max())


def burst_of(now: Turned, before: Turned, *, teeth: Sequence[int], orders: int) -> Burst | None:
    """Of the gear of `teeth[0]` teeth, below so many `orders`; None where a record is too short or too slow."""
    alive = _alive(now) & _alive(before)
    one, other = (_each_turn(replace(x, samples=x.samples[alive])) if alive.any() else None for x in (now, before))
    if one is None or other is None:
        return None
    count, width = min(one.shape[1], other.shape[1]), min(one.shape[2], other.shape[2], orders)
    if width <= MESHES * max(teeth):
        return None
    one, other = _as_noisy(one[:, :count, :width], other[:, :count, :width], teeth)
    kept = _kept(width, teeth)
    if np.count_nonzero(kept) < teeth[0]:
        return None
    heights = []
    for each in (one, other):
        windows = _power_windows(each, kept, teeth[0])
        heights.append(float(windows.max() - np.median(windows)))
    return Burst(
        power=heights[0],
        usual=heights[1],
        error=np.sqrt(np.maximum(_usual(one, kept, teeth[0]), 1e-300)),
        kept=kept,
        alive=alive,
        teeth=teeth[0],
    )


def _alive(one: Turned) -> np.ndarray:
    """Channels (C,) that hold more than one value."""
    return np.asarray(np.ptp(one.samples, axis=1) > HELD * np.max(np.abs(one.samples), axis=1))


def _told(each: ComplexArray | None, teeth: Sequence[int]) -> WholeTurn | None:
    if each is None or each.shape[2] <= MESHES * max(teeth):
        return None
    kept = _kept(each.shape[2], teeth)
    if np.count_nonzero(kept) < teeth[0]:
        return None
    windows = _power_windows(each, kept, teeth[0])
    each = np.delete(each, _loudest(each, kept, teeth[0], int(np.argmax(windows)) / windows.size), axis=1)
    windows = _power_windows(each, kept, teeth[0])
    middle = float(np.median(windows))
    if not middle > 0.0:
        return None
    return WholeTurn(windows=windows / middle, teeth=teeth[0], turns=each.shape[1] + 1, level=middle)


def _power_windows(each: ComplexArray, kept: np.ndarray, teeth: int) -> FloatArray:
    power = np.mean(_power(_whitened(each, kept, teeth)), axis=0)
    return _windows(power, max(3, int(WINDOW_TEETH * power.size / teeth)))


def _loudest(each: ComplexArray, kept: np.ndarray, teeth: int, at: float) -> int:
    """The turn that has most at a place (a share of the turn): a knock in one turn comes back in no other."""
    usual = np.maximum(_usual(each, kept, teeth), 1e-300)
    white = np.where(kept, each / np.sqrt(usual)[:, None], 0.0)
    power = np.mean([_power(channel) for channel in white], axis=0)
    steps = power.shape[1]
    width = max(3, int(WINDOW_TEETH * steps / teeth))
    window = (int(at * steps) + np.arange(width) - width // 2) % steps
    return int(np.argmax(np.mean(power[:, window], axis=1)))


def _as_noisy(one: ComplexArray, other: ComplexArray, teeth: Sequence[int]) -> tuple[ComplexArray, ComplexArray]:
    """Both at the same error of their orders, the test at the level of the baseline's lines where these have grown."""
    kept = _kept(one.shape[2], teeth)
    one = one / np.maximum(_gain(one, other, teeth[0]), 1.0)[:, None, None]
    errors = [_usual(x, kept, teeth[0]) if np.any(kept) else np.zeros(x.shape[::2]) for x in (one, other)]
    most = np.maximum(*errors)
    rng = np.random.default_rng(one.shape[1])
    made = []
    for each, error in zip((one, other), errors, strict=True):
        noise = rng.standard_normal((2, *each.shape))
        size = np.sqrt(np.maximum(most - error, 0.0) * each.shape[1] / 2)
        made.append(each + size[:, None] * (noise[0] + 1j * noise[1]))
    return made[0], made[1]


def standing(now: WholeTurn | None, before: WholeTurn | None) -> float:
    """Log of how far the fullest window stands out, over the baseline's and over the rest of its own turn; 0 where it
    cannot be told.

    A height is worth less by the square of how much the rest of the turn stands out of what it was: what rattles once
    a turn is heard for a third of it, a faulty tooth for its own pitch.
    """
    if now is None:
        return 0.0
    usual = before.height if before is not None else SOUND
    return float(np.log(now.height * usual / max(now.rest, usual) ** 2))


def _gain(one: ComplexArray, other: ComplexArray, teeth: int) -> FloatArray:
    """How much the strong lines of the teeth have grown on each channel, (C,)."""
    now, before = (np.abs(x.mean(axis=1)[:, teeth::teeth]) for x in (one, other))
    if not now.size:
        return np.ones(len(one))
    strong = before >= STRONG * before.max(axis=1, keepdims=True)
    grown = np.where(strong, now / np.maximum(before, 1e-300), np.nan)
    return np.asarray(np.nanmedian(grown, axis=1), dtype=np.float64)


def _each_turn(one: Turned) -> ComplexArray | None:
    """Spectra of all whole turns, (C, turns, orders)."""
    known = np.flatnonzero(np.isfinite(one.turns))
    if known.size < 2:
        return None
    cut = slice(int(known[0]), int(known[-1]) + 1)
    samples, turns = one.samples[:, cut], one.turns[cut]
    there, steps = np.isfinite(turns), np.arange(turns.size)
    turns = np.interp(steps, steps[there], turns[there])
    span = float(turns[-1] - turns[0])
    if not span > 0.0:
        return None
    per_turn = int((turns.size - 1) / span) // 2 * 2
    count = int(min(span, MOST_TURNS, MOST_SAMPLES // max(per_turn, 1)))
    if count < LEAST_TURNS or per_turn < 2:
        return None
    at = np.interp(turns[0] + np.arange(count * per_turn) / per_turn, turns, steps)
    even = scipy.interpolate.CubicSpline(steps, samples, axis=1)(at)
    spectra = np.fft.rfft(even.reshape(samples.shape[0], count, per_turn), axis=2) / per_turn
    return np.asarray(spectra, dtype=np.complex128)


def _kept(count: int, teeth: Sequence[int]) -> np.ndarray:
    """Mask of the orders that are neither a mesh nor next to it, nor the lowest."""
    orders = np.arange(count)
    kept = orders >= LEAST_ORDERS
    for z in teeth:
        kept &= np.abs((orders + z // 2) % z - z // 2) > 1
    return kept


def _spread(each: ComplexArray) -> FloatArray:
    """Squared error of the mean turn, (C, orders), by how the turns differ."""
    count = each.shape[1]
    square = np.sum(np.abs(each - each.mean(axis=1)[:, None]) ** 2, axis=1)
    return np.asarray(square / (count - 1) / count)


def _usual(each: ComplexArray, kept: np.ndarray, teeth: int) -> FloatArray:
    """The same of the orders around each, (C, orders)."""
    orders, at = np.arange(each.shape[2]), np.flatnonzero(kept)
    found = []
    for own in np.maximum(_spread(each), 1e-300):
        around = np.interp(orders, at, np.log(own[at]))
        found.append(np.exp(scipy.ndimage.uniform_filter1d(around, teeth // 2 * 2 + 1, mode="nearest")))
    return np.array(found)


def _whitened(each: ComplexArray, kept: np.ndarray, teeth: int) -> ComplexArray:
    """The mean turn over its error, order by order, (C, orders); the error is that of the orders around, or its own
    where that is larger."""
    mean = each.mean(axis=1)
    error = np.maximum(_usual(each, kept, teeth), np.maximum(_spread(each), 1e-300))
    white = np.where(kept, mean / np.sqrt(error), 0.0)
    orders, at = np.arange(mean.shape[1]), np.flatnonzero(kept)
    for c, size in enumerate(np.abs(white)):
        level = scipy.ndimage.median_filter(np.interp(orders, at, size[at]), 2 * teeth + 1, mode="nearest")
        white[c] *= np.minimum(1.0, LEVELLED * level / np.maximum(size, 1e-300))
    return np.asarray(white, dtype=np.complex128)


def _power(white: ComplexArray) -> FloatArray:
    """Power of the mean turn at each step, (C, steps), of mean 1 where there is noise alone."""
    channels, count = white.shape
    twice = np.zeros((channels, 2 * count), dtype=np.complex128)
    twice[:, :count] = white
    there = np.maximum(np.count_nonzero(white, axis=1), 1)[:, None]
    return np.asarray(np.abs(np.fft.ifft(twice, axis=1) * 2 * count) ** 2 / there)


def _windows(power: FloatArray, width: int) -> FloatArray:
    """Mean of `power` (steps,) over `width` steps around each, (steps,)."""
    kernel = np.zeros(power.size)
    kernel[:width] = 1 / width
    turned = np.roll(kernel, -(width // 2))
    return np.asarray(np.fft.irfft(np.fft.rfft(power) * np.fft.rfft(turned), power.size), dtype=np.float64)
