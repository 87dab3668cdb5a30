"""What one recording shows, in numbers that a smooth sensor path and independent noise change in a known way."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from reconcile.observe.phases import mean_phases
from signals.series import FloatArray

SHAPE_BANDS_HZ = ((60.0, 600.0), (600.0, 2000.0), (2000.0, 4500.0), (4500.0, 8000.0))
"""Bands of the envelopes and of the moments, Hz: the same for all points, as structural resonances are, but for what
`bands_beside` moves."""
LOWEST_BAND_HZ = 25.0
HIGHEST_HZ = 8200.0
CLEAR_OF_LINES = 0.015
"""Share of its frequency by which a line of the teeth is clear of the bands' edges: three bins at 200 Hz."""
CLEAR_OF_SHARP = 0.003
"""The same for shape bands, which are cut out without a window: two bins at 600 Hz."""
LOBE = 10.0 / 3.0
"""Noise that a line's lobe of five bins gathers, over that in the noise bandwidth of the Hann window (1.5 bins)."""
LOBE_SCATTER = 2.1
"""Standard deviation of that noise, in the same unit: neighbouring bins of a Hann spectrum are correlated."""


def third_octaves() -> FloatArray:
    """Edges of the bands, shape (bands + 1,), Hz: sixths of a decade-like grid, three an octave."""
    count = int(np.floor(3 * np.log2(HIGHEST_HZ / LOWEST_BAND_HZ)))
    return np.asarray(LOWEST_BAND_HZ * 2.0 ** (np.arange(count + 1) / 3.0))


@dataclass(frozen=True, kw_only=True)
class Bands:
    """Edges of the third octaves, shape (bands + 1,), Hz, and of the shape bands, Hz; `factor`: by which all of them
    are off where they are usually."""

    edges_hz: FloatArray
    shapes_hz: tuple[tuple[float, float], ...]
    factor: float = 1.0

    @property
    def usual(self) -> bool:
        """Whether they are those of any machine."""
        return self.shapes_hz == SHAPE_BANDS_HZ and bool(np.array_equal(self.edges_hz, third_octaves()))

    def at(self, factor: float) -> Bands:
        """The same at another speed."""
        shapes = tuple((low * factor, high * factor) for low, high in self.shapes_hz)
        return Bands(edges_hz=self.edges_hz * factor, shapes_hz=shapes, factor=self.factor * factor)


def bands_beside(lines_hz: Sequence[float]) -> Bands:
    """The usual bands, but an edge that would cut one of these lines (Hz) stands above it: which band holds the power
    of a strong line must not hang on a hundredth of its frequency."""
    edges = _beside(third_octaves(), lines_hz, CLEAR_OF_LINES)
    low, high = (_beside(np.array(side), lines_hz, CLEAR_OF_SHARP) for side in zip(*SHAPE_BANDS_HZ, strict=True))
    return Bands(edges_hz=edges, shapes_hz=tuple((float(a), float(b)) for a, b in zip(low, high, strict=True)))


def _beside(edges: FloatArray, lines_hz: Sequence[float], near: float) -> FloatArray:
    for line in sorted(lines_hz):
        edges[np.abs(edges / line - 1.0) < near] = (1.0 + CLEAR_OF_LINES) * line
    return edges


@dataclass(frozen=True, kw_only=True)
class Statistics:
    """Of C channels over L watched lines, B third octaves, E shape bands, M modulations and S shafts with gears.

    `line`: mean square of each line, (C, L), unit^2. `floor`: density between lines, (C, B), unit^2/Hz.
    `total`: mean square in the band, (C, B). `band`: mean square in the shape band, (C, E).
    `depth`: (C, E, M) squared amplitude of a modulation of the squared envelope over its mean squared.
    `turn`: (C, E, S) mean square in the fullest window of the mean turn.
    `kurtosis` (excess) and `skewness`: (C, E). `phase`: (C, Q) of the lines whose phases are compared, radians, up to a
    number that all channels of a line share. `resolution_hz`: noise bandwidth of one line, Hz.
    NaN marks what the sampling rate or the duration does not cover.
    """

    line: FloatArray
    floor: FloatArray
    total: FloatArray
    band: FloatArray
    depth: FloatArray
    turn: FloatArray
    kurtosis: FloatArray
    skewness: FloatArray
    phase: FloatArray
    resolution_hz: float
    duration_s: float


def averaged(several: list[Statistics]) -> Statistics:
    """Mean of several recordings of the same condition, of those that tell a figure; the duration adds up."""
    if len(several) == 1:
        return several[0]

    def mean(name: str) -> FloatArray:
        told = np.array([getattr(s, name) for s in several])
        known = ~np.isnan(told)
        count = known.sum(axis=0)
        return np.where(count > 0, np.where(known, told, 0.0).sum(axis=0) / np.maximum(count, 1), np.nan)

    return Statistics(
        line=mean("line"),
        floor=mean("floor"),
        total=mean("total"),
        band=mean("band"),
        depth=mean("depth"),
        turn=mean("turn"),
        kurtosis=mean("kurtosis"),
        skewness=mean("skewness"),
        phase=mean_phases([s.phase for s in several]),
        resolution_hz=float(np.mean([s.resolution_hz for s in several])),
        duration_s=float(sum(s.duration_s for s in several)),
    )
