"""Explaining what the families leave: sums of a mesh, a shaft and a ball-pass frequency, j f_m + n f_r + k f_o.

A nonlinear machine makes every such intermodulation product, so a family of them all would explain any peak by chance.
They are therefore tried only on peaks that nothing else explains, and one is accepted only when so simple a
sum would hardly lie so near by chance: the density of all sums at most as heavy decides.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from signals.labels.families import Bound, predicted
from signals.labels.kinematics import Kinematics
from signals.peaks import FoundPeaks
from signals.series import FloatArray, IntArray
from sim.core.lines import Line

FAMILY = "combination"


@dataclass(frozen=True, kw_only=True)
class _Grid:
    """All sums of one mesh, shaft and bearing: `orders` shape (sums, 3) over `bases`, `components` of the three."""

    bases: tuple[str, str, str]
    components: tuple[str, str, str]
    orders: IntArray
    frequency_hz: FloatArray

    @property
    def weight(self) -> IntArray:
        """Sum of |orders| of each sum, shape (sums,)."""
        return np.asarray(np.sum(np.abs(self.orders), axis=1), dtype=np.int64)


@dataclass(frozen=True, kw_only=True)
class Combinations:
    """`lines` that lie at the peaks asked about; frequencies and weights of *all* distinct sums, sorted, for chance."""

    lines: tuple[Line, ...]
    frequency_hz: FloatArray
    weight: IntArray

    def up_to(self, weight: int) -> FloatArray:
        """Frequencies of the sums at most as heavy, sorted, Hz."""
        return self.frequency_hz[self.weight <= weight]


def combine(
    kinematics: Kinematics,
    bases_hz: Mapping[str, float],
    peaks: FoundPeaks,
    *,
    reach_hz: float,
    max_frequency_hz: float,
    bound: Bound,
) -> Combinations:
    """Sums within `reach_hz` of any of `peaks`."""
    grids = [g for g in _grids(kinematics, bases_hz, max_frequency_hz, bound) if g.frequency_hz.size]
    if not grids:
        return Combinations(lines=(), frequency_hz=np.zeros(0), weight=np.zeros(0, dtype=np.int64))
    lines = [line for grid in grids for line in _near(grid, peaks.frequency_hz, reach_hz)]
    every = np.concatenate([g.frequency_hz for g in grids])
    weight = np.concatenate([g.weight for g in grids])
    # Sums of equal frequency are one line here: the lightest counts (1 uHz: rounding of identical sums).
    order = np.lexsort((weight, np.round(every, 6)))
    first = np.diff(np.round(every[order], 6), prepend=-1.0) > 0
    return Combinations(lines=tuple(lines), frequency_hz=every[order][first], weight=weight[order][first])


def _grids(
    kinematics: Kinematics, bases_hz: Mapping[str, float], max_frequency_hz: float, bound: Bound
) -> Iterator[_Grid]:
    for mesh in kinematics.meshes:
        for shaft, wheel in ((mesh.pinion_shaft, mesh.pinion), (mesh.gear_shaft, mesh.gear)):
            for bearing in kinematics.bearings:
                bases = (mesh.base, shaft, bearing.base("o"))
                if any(base not in bases_hz for base in bases):
                    continue
                axes = (
                    np.arange(bound.mesh + 1),
                    np.arange(-bound.combination_shaft, bound.combination_shaft + 1),
                    np.arange(-bound.combination_outer, bound.combination_outer + 1),
                )
                orders = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
                frequency = np.abs(orders @ np.array([bases_hz[base] for base in bases]))
                # a sum that is zero by construction comes out as rounding
                kept = (frequency > 1e-6 * bases_hz[shaft]) & (frequency <= max_frequency_hz)
                yield _Grid(
                    bases=bases,
                    components=(mesh.component, wheel, bearing.site),
                    orders=orders[kept],
                    frequency_hz=frequency[kept],
                )


def _near(grid: _Grid, peak_hz: FloatArray, reach_hz: float) -> Iterator[Line]:
    """One line for each part that takes part, so that merging collects the components."""
    if not peak_hz.size:
        return
    right = np.clip(np.searchsorted(peak_hz, grid.frequency_hz), 1, max(peak_hz.size - 1, 1))
    nearest = np.minimum(
        np.abs(grid.frequency_hz - peak_hz[right - 1]),
        np.abs(grid.frequency_hz - peak_hz[np.minimum(right, peak_hz.size - 1)]),
    )
    for row in grid.orders[nearest <= reach_hz].tolist():
        orders = dict(zip(grid.bases, row, strict=True))
        # the mesh is the carrier: it counts as a component only where nothing modulates it
        modulators = [(c, n) for c, n in zip(grid.components[1:], row[1:], strict=True) if n]
        for component, _ in modulators or [(grid.components[0], 1)]:
            yield predicted(orders, component, FAMILY, mechanism="intermodulation")
