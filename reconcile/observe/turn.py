"""Where in a shaft's turn the residual of the mean turn gathers: the angle of a local tooth fault."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy

from reconcile.tail import tail_chance
from reconcile.verdict import AngleWindow
from signals.series import FloatArray, Series
from signals.synchronous import separate, synchronous_average
from sim.core.errors import SpecError

LOCAL = 2.0
"""A window of the mean turn is a place if it stands out this many times more than in the baseline."""
LOCAL_LEAST = 5.0
"""The same over the mean of its own turn: 14 concealed healthy cases of development reach 4.0, faulty teeth 6 to 39."""
TURNED = 200
"""Angles by which the halves are turned against each other for the chance of a height."""


@dataclass(frozen=True, kw_only=True)
class LocalEnergy:
    """`windows`: power of the mean turn's residual in windows of two teeth over the mean turn's, (steps,).

    `halves`: residuals of the mean turns of the first and the second half; `width` of a window, steps.
    """

    windows: FloatArray
    halves: tuple[np.ndarray, np.ndarray]
    width: int

    @property
    def height(self) -> float:
        """Of the fullest window."""
        return float(np.max(self.windows))

    def chance(self) -> float:
        """Chance of such a height where nothing comes back: the halves turned against each other, tail as in
        `tail_chance`."""
        one, other = self.halves
        rng = np.random.default_rng(one.size)
        shifts = rng.integers(2 * self.width, max(one.size - 2 * self.width, 2 * self.width + 1), TURNED)
        level = _level(one, other)
        controls = np.array([_windows(one, np.roll(other, int(k)), self.width).max() / level for k in shifts])
        return tail_chance(controls, self.height)


def local_energy(series: Series, *, shaft: str, rotation: FloatArray, ratio: float, teeth: int) -> LocalEnergy | None:
    """Where in the turn of a gear of so many `teeth` something comes back.

    `rotation`: angle at each sample (n,), rad, of the shaft that `shaft` turns `ratio` times as fast as. The power is
    that of the mean turns of the first and the second half together, their residuals multiplied: what does not come
    back at the same angle (balls, noise) is in either mean turn, but not in both. None for a recording that is too
    short for two mean turns.
    """
    turns = rotation * (ratio / (2 * np.pi))
    known = np.flatnonzero(np.isfinite(turns))
    if known.size < 2:
        return None
    first, last = int(known[0]), int(known[-1])
    half = np.floor((turns[last] - turns[first]) / 2)
    middle = int(np.searchsorted(turns[known], turns[first] + half)) + first
    per_turn = int(np.ceil((last - first) / max(turns[last] - turns[first], 1e-9)))
    halves = []
    for part in (slice(first, middle), slice(middle, last + 1)):
        try:
            cut = replace(series, samples=series.samples[part])
            mean = synchronous_average(
                cut, shaft=shaft, rotation=rotation[part], ratio=ratio, samples_per_revolution=per_turn
            )
            halves.append(scipy.signal.hilbert(separate(mean, teeth=(teeth,)).difference))
        except SpecError:
            return None
    one, other = halves
    width = max(3, 2 * one.size // teeth)
    return LocalEnergy(windows=_windows(one, other, width) / _level(one, other), halves=(one, other), width=width)


def _level(one: np.ndarray, other: np.ndarray) -> float:
    square = float(np.mean(np.abs(one) ** 2)) * float(np.mean(np.abs(other) ** 2))
    return max(float(np.sqrt(square)), 1e-300)


def _windows(one: np.ndarray, other: np.ndarray, width: int) -> FloatArray:
    """Mean of the product over windows of `width` steps around each step, (steps,)."""
    power = np.real(one * np.conj(other))
    kernel = np.zeros(power.size)
    kernel[:width] = 1 / width
    smooth = np.fft.irfft(np.fft.rfft(power) * np.fft.rfft(np.roll(kernel, -(width // 2))), power.size)
    return np.asarray(smooth, dtype=np.float64)


def prominence(now: LocalEnergy | None, before: LocalEnergy | None) -> float:
    """How far the fullest window stands out, over what the baseline's does; 0 where that is no place."""
    if now is None or before is None:
        return 0.0
    top, rest = now.height, before.height
    return top / rest if top >= LOCAL_LEAST and top >= LOCAL * rest else 0.0


def window_of(energy: LocalEnergy, *, shaft: str, start_turns: float = 0.0) -> AngleWindow:
    """The fullest window to half its height; `start_turns`: angle of the shaft at the first sample."""
    now = energy.windows
    at = int(np.argmax(now))
    middle = now.size // 2
    below = np.flatnonzero(np.roll(now, middle - at) <= float(now[at]) / 2)
    low = int(np.max(below[below < middle], initial=-1)) + 1
    high = int(np.min(below[below > middle], initial=now.size)) - 1
    centre = 360.0 * (at / now.size + start_turns % 1.0)
    step = 360.0 / now.size
    return AngleWindow(
        shaft=shaft,
        centre_deg=centre % 360.0,
        low_deg=centre % 360.0 - step * (middle - low),
        high_deg=centre % 360.0 + step * (high - middle),
    )
