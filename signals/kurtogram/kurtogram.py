"""Fast kurtogram: the spectral kurtosis of a binary/ternary tree of bands.

J. Antoni, "Fast computation of the kurtogram for the detection of transient faults", Mech. Syst. Signal Process. 21
(2007) 108-124: bandwidths (fs/2)/{1, 2, 3, 4, 6, 8, 12, ...}, kurtosis E|x|^4 / (E|x|^2)^2 - 2 of the complex envelope.
The bands are cut ideally from transforms of blocks instead of by his cascade of quasi-analytic filters (same cost,
n log n); a test compares the two. Moments are summed over blocks, so memory does not grow with the record.

`signals.spectra.band.choose_band` looks at the same tree and prefers repetitive bands; here kurtosis alone decides.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import scipy
from scipy import fft

from signals.series import FloatArray, Series
from signals.spectra.band import FALSE_ALARM, MIN_BAND_SAMPLES, MIN_POWER_SHARE, chance_level, tree
from signals.spectra.types import Band
from sim.core.errors import Problem, SpecError

BLOCK_SAMPLES = 2**20
TAPER = 0.05
"""Share of a block at each end that is faded in and out and not judged: a transform takes the jump from the last sample
to the first for a click, which in a quiet band would be the largest there is."""
MAX_LEVEL = 7
RULE = "largest spectral kurtosis of the fast kurtogram's tree, among the bands above chance if there are any"


@dataclass(frozen=True, kw_only=True)
class Cell:
    """One band of the tree, and its spectral kurtosis (None where it holds rounding only)."""

    parts: int
    low_hz: float
    high_hz: float
    kurtosis: float | None
    threshold: float
    """Kurtosis a stationary Gaussian signal exceeds anywhere in the tree with probability 5 %."""


@dataclass(frozen=True, kw_only=True)
class Kurtogram:
    """All cells, by widths falling, then by frequency, and the proposed band."""

    cells: tuple[Cell, ...]
    band: Band
    channel: str = ""

    def row(self, parts: int) -> FloatArray:
        """Kurtosis of the bands of one width, (parts,), NaN where None."""
        values = [np.nan if c.kurtosis is None else c.kurtosis for c in self.cells if c.parts == parts]
        return np.array(values)


def kurtogram(
    series: Series,
    *,
    max_level: int = MAX_LEVEL,
    min_bandwidth_hz: float = 0.0,
    block_samples: int = BLOCK_SAMPLES,
) -> Kurtogram:
    """Kurtogram down to bands of (fs/2)/2^max_level, not narrower than `min_bandwidth_hz` or too short to judge.

    Blocks are equally long; up to one sample a block is left out at the end.
    """
    nyquist = series.sampling_rate_hz / 2
    _check(max_level, min_bandwidth_hz, nyquist)
    blocks = -(-series.samples.size // block_samples)
    length = series.samples.size // blocks
    bins = length // 2 + 1
    levels = [
        parts
        for parts in tree(max_level)
        if (bins // parts) * blocks >= MIN_BAND_SAMPLES and nyquist / parts >= min_bandwidth_hz * (1 - 1e-9)
    ]
    second = {parts: np.zeros(parts) for parts in levels}
    fourth = {parts: np.zeros(parts) for parts in levels}
    for transform in _transforms(series, blocks, length):
        for parts in levels:
            size = bins // parts
            # twice the critical rate: the squared envelope of a band is twice as wide as the band
            envelope = fft.ifft(transform[: size * parts].reshape(parts, size), n=2 * size, axis=1)
            edge = int(np.ceil(TAPER * envelope.shape[1]))
            inside = envelope[:, edge : envelope.shape[1] - edge]
            power = inside.real**2 + inside.imag**2
            second[parts] += np.mean(power, axis=1) / blocks
            fourth[parts] += np.mean(power**2, axis=1) / blocks
    alarm = FALSE_ALARM / max(1, sum(levels))
    cells = [
        cell
        for parts in levels
        for cell in _cells(
            parts,
            second[parts],
            fourth[parts],
            nyquist / bins * (bins // parts),
            chance_level(int((1 - 2 * TAPER) * (bins // parts) * blocks), alarm),
        )
    ]
    return Kurtogram(cells=tuple(cells), band=_proposed(cells, nyquist), channel=series.name)


def _check(max_level: int, min_bandwidth_hz: float, nyquist: float) -> None:
    problems = []
    if not 0 <= max_level <= 12:
        problems.append(Problem(field="max_level", message="is out of range", given=max_level, allowed="0 to 12"))
    if not 0 <= min_bandwidth_hz <= nyquist:
        message, allowed = "no band can be that wide", f"0 to {nyquist:g}"
        problems.append(
            Problem(field="min_bandwidth_hz", message=message, given=min_bandwidth_hz, allowed=allowed, unit="Hz")
        )
    if problems:
        raise SpecError(problems)


def _transforms(series: Series, blocks: int, length: int) -> Iterator[np.ndarray[tuple[int], np.dtype[np.complex128]]]:
    mean = float(np.mean(series.samples))
    fade = scipy.signal.windows.tukey(length, 2 * TAPER)
    for i in range(blocks):
        block = series.samples[i * length : (i + 1) * length] - mean
        yield np.asarray(fft.rfft(block * fade), dtype=np.complex128)


def _cells(parts: int, second: FloatArray, fourth: FloatArray, width_hz: float, threshold: float) -> list[Cell]:
    enough = second > MIN_POWER_SHARE * np.sum(second)
    return [
        Cell(
            parts=parts,
            low_hz=i * width_hz,
            high_hz=(i + 1) * width_hz,
            kurtosis=float(fourth[i] / second[i] ** 2 - 2) if enough[i] else None,
            threshold=threshold,
        )
        for i in range(parts)
    ]


def _proposed(cells: list[Cell], nyquist: float) -> Band:
    judged = [(c.kurtosis, c) for c in cells if c.kurtosis is not None]
    if not judged:
        return Band(low_hz=0.0, high_hz=nyquist, rule="whole axis: the signal is too short or silent to choose from")
    above = [(k, c) for k, c in judged if k > c.threshold]
    kurtosis, best = max(above or judged, key=lambda found: (found[0], found[1].high_hz - found[1].low_hz))
    return Band(
        low_hz=best.low_hz,
        high_hz=min(best.high_hz, nyquist),
        rule=RULE,
        spectral_kurtosis=kurtosis,
        threshold=best.threshold,
    )
