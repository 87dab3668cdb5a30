"""How a line's phase differs between sensors: what their paths add to it is the same before and after a change.

A recording's phases depend on where it begins, and each sensor's on its path. The difference between two sensors at one
line does not depend on the beginning, and its change against the baseline not on the paths. Slow wander of the speed
smears a line on all sensors alike and leaves it as it is.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from signals.series import FloatArray

DB_PER_RAD = 20.0 / np.log(10.0)
"""A phase in decibels: the imaginary part of the logarithm of which a level is the real part."""
HALF_TURN_DB = DB_PER_RAD * np.pi
TURNED = 0.21
"""Variance of a line's phase over the noise in its lobe by its power: half of the noise turns it, of that which falls
upon the line's own shape; read off white noise."""
FREE_DB = HALF_TURN_DB / np.sqrt(3.0)
"""Standard deviation of a phase of which nothing is known."""


def line_phases(
    spectrum: np.ndarray, bin_hz: float, lines_hz: FloatArray, slack: FloatArray, top_hz: float, lobe_bins: int
) -> FloatArray:
    """Phases (C, Q) of lines in a spectrum (C, bins), radians, up to a number that all channels of a line share.

    The lobe is the strongest within `slack` (share of the frequency), each channel counting alike. NaN above `top_hz`.
    """
    channels = spectrum.shape[0]
    found = np.full((channels, lines_hz.size), np.nan)
    here = np.flatnonzero((lines_hz >= (lobe_bins + 1) * bin_hz) & (lines_hz <= top_hz))
    if not here.size:
        return found
    low, high = reach_bins(lines_hz[here], slack[here], bin_hz)
    low = np.maximum(low, lobe_bins)
    lobes = np.empty((here.size, channels, 2 * lobe_bins + 1), dtype=complex)
    for width in np.unique(high - low):
        alike = np.flatnonzero(high - low == width)
        windows = (low[alike] - lobe_bins)[:, None] + np.arange(width + 2 * lobe_bins + 1)
        lobes[alike] = _lobes(np.take(spectrum, windows, axis=1, mode="clip"), 2 * lobe_bins + 1)
    found[:, here] = shared(lobes @ lobes.conj().swapaxes(1, 2))
    return found


def reach_bins(lines_hz: FloatArray, slack: FloatArray, bin_hz: float) -> tuple[np.ndarray, np.ndarray]:
    """First and last bins (L,) in which lines are looked for: within `slack` (share of the frequency), half a bin at
    least."""
    reach = np.maximum(lines_hz * slack, 0.5 * bin_hz)
    low = np.floor((lines_hz - reach) / bin_hz + 0.5).astype(int)
    return low, np.floor((lines_hz + reach) / bin_hz + 0.5).astype(int)


def _lobes(parts: np.ndarray, bins: int) -> np.ndarray:
    """Strongest `bins` of parts of a spectrum (C, Q, width), each channel of unit power: (Q, C, bins)."""
    power = parts.real**2 + parts.imag**2
    power = power / np.maximum(power.sum(axis=2, keepdims=True), 1e-300)
    all_channels = power.sum(axis=0)
    sums = sum(all_channels[:, k : all_channels.shape[1] - bins + 1 + k] for k in range(bins))
    first = np.argmax(sums, axis=1)[None, :, None]
    lobe = np.take_along_axis(parts, first + np.arange(bins), axis=2)
    size = np.sqrt(np.sum(lobe.real**2 + lobe.imag**2, axis=2, keepdims=True))
    return np.asarray(lobe / np.maximum(size, 1e-300)).swapaxes(0, 1)


def shared(matrices: np.ndarray) -> FloatArray:
    """Phases (C, Q) of the strongest common part of cross powers (Q, C, C), against the first channel's."""
    strongest = np.linalg.eigh(matrices)[1][:, :, -1]
    return np.asarray(np.angle(strongest * strongest[:, :1].conj()).T)


def mean_phases(several: Sequence[FloatArray]) -> FloatArray:
    """Of recordings of one condition, each (C, Q)."""
    if len(several) == 1:
        return several[0]
    known = np.all(np.isfinite(several), axis=(0, 1))
    total = np.zeros((int(known.sum()), several[0].shape[0], several[0].shape[0]), dtype=complex)
    for phases in several:
        unit = np.exp(1j * phases[:, known]).T
        total += unit[:, :, None] * unit[:, None, :].conj()
    found = np.full(several[0].shape, np.nan)
    if known.any():
        found[:, known] = shared(total)
    return found


def between_sensors(phases: FloatArray) -> FloatArray:
    """(..., C, Q) radians -> the same shape, dB: each channel's phase against the next one's, the last one's against
    the first's."""
    return wrapped(DB_PER_RAD * (phases - np.roll(phases, -1, axis=-2)))


def wrapped(phases_db: FloatArray) -> FloatArray:
    """Within half a turn either way."""
    return np.asarray((phases_db + HALF_TURN_DB) % (2.0 * HALF_TURN_DB) - HALF_TURN_DB)


def phase_deviations(power: FloatArray, noise: FloatArray) -> FloatArray:
    """(C, Q), dB: standard deviation of `between_sensors` for lines of mean square `power` in noise of `noise`.

    At most that of a free phase.
    """
    one = np.minimum(TURNED * noise / np.maximum(power, 1e-300), (FREE_DB / DB_PER_RAD) ** 2)
    both = one + np.roll(one, -1, axis=-2)
    return np.asarray(DB_PER_RAD * np.sqrt(np.minimum(both, (FREE_DB / DB_PER_RAD) ** 2)))
