"""Stiffness of one tooth pair tabulated over (tilt, centre-distance error, normalised position).

Entry and exit of a pair move with the centre distance. The table therefore runs over xi = position / contact ratio
in [0, 1] and keeps the contact ratio of each row: the jump at either end stays sharp at any centre distance.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from sim.core.errors import Problem, SpecError
from sim.parts.gear.helix import POINTS, spread
from sim.parts.gear.offset import torsion_arm_m
from sim.parts.gear.pair import GearPair, pair_compliance, pair_stiffness_n_per_m
from sim.parts.gear.tooth import FloatArray

ERROR_SHARE = 0.1
"""Default reach of the table: centre-distance errors up to this share of the module."""


@dataclass(frozen=True, kw_only=True)
class PairTable:
    """Linear interpolation on equal steps, clamped at the ends of tilt and centre-distance error.

    `stiffness_n_per_m` (T, R, N) over `tilts_rad` (T,), `centre_distance_error_m` (R,) and xi = 0..1 (N points);
    `contact_ratio` (R,), with the overlap of a helical pair; `start_m` (R,): path coordinate of entry from the pinion's
    base point.
    """

    tilts_rad: FloatArray
    centre_distance_error_m: FloatArray
    contact_ratio: FloatArray
    start_m: FloatArray
    stiffness_n_per_m: FloatArray

    def ratio_at(self, centre_distance_error_m: float) -> float:
        """Contact ratio at a centre-distance error."""
        return float(np.interp(centre_distance_error_m, self.centre_distance_error_m, self.contact_ratio))

    def pair_n_per_m(
        self, position: FloatArray, centre_distance_error_m: float = 0.0, tilt_rad: float = 0.0
    ) -> FloatArray:
        """Stiffness of one pair at positions (any shape; base pitches since entry), N/m; 0 outside engagement."""
        curve = self._curve(centre_distance_error_m, tilt_rad)
        xi = np.asarray(position, dtype=np.float64) / self.ratio_at(centre_distance_error_m)
        found = np.interp(xi, np.linspace(0.0, 1.0, curve.size), curve)
        return np.asarray(np.where((xi >= 0) & (xi < 1), found, 0.0))

    def total_n_per_m(
        self, phase: FloatArray, centre_distance_error_m: float = 0.0, tilt_rad: float = 0.0
    ) -> FloatArray:
        """Sum over all pairs at mesh phases (cycles; 0 = a pair enters), N/m."""
        first = np.mod(np.asarray(phase, dtype=np.float64), 1.0)
        pairs = int(np.ceil(self.contact_ratio.max()))
        parts = [self.pair_n_per_m(first + n, centre_distance_error_m, tilt_rad) for n in range(pairs)]
        return np.asarray(np.sum(parts, axis=0))

    def _curve(self, error_m: float, tilt_rad: float) -> FloatArray:
        plane = _blend(self.stiffness_n_per_m, self.tilts_rad, tilt_rad)
        return _blend(plane, self.centre_distance_error_m, error_m)


@dataclass(frozen=True, kw_only=True)
class InterpolationError:
    """Largest differences between table and direct calculation in the middle of the cells."""

    stiffness_relative: float
    contact_ratio_absolute: float


def _blend(values: FloatArray, grid: FloatArray, at: float) -> FloatArray:
    position = float(np.interp(at, grid, np.arange(grid.size)))
    low = min(int(position), max(grid.size - 2, 0))
    high = min(low + 1, grid.size - 1)
    return np.asarray(values[low] + (position - low) * (values[high] - values[low]))


def legal_errors_m(pair: GearPair, reach_m: float, rows: int) -> FloatArray:
    """`rows` (odd) equal steps over -reach..reach, drawn in symmetrically until the teeth still work at both ends."""
    if rows < 1 or rows % 2 == 0:
        raise SpecError(Problem(field="rows", message="must be odd, so that zero is a row", given=rows))
    low, high = 0.0, 1.0
    if _works(pair, reach_m):
        low = high
    while high - low > 1e-9:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if _works(pair, middle * reach_m) else (low, middle)
    return np.linspace(-low * reach_m, low * reach_m, rows) if rows > 1 else np.zeros(1)


def _works(pair: GearPair, reach_m: float) -> bool:
    try:
        pair.contact(reach_m)
        pair.contact(-reach_m)
    except SpecError:
        return False
    return True


def build_pair_table(
    pair: GearPair,
    *,
    centre_distance_errors_m: FloatArray | None = None,
    tilts_rad: FloatArray | None = None,
    points: int = 129,
    rows: int = 33,
) -> PairTable:
    """Tabulate a pair; errors default to +-0.1 module (less where the teeth stop working), tilts to aligned only."""
    if centre_distance_errors_m is None:
        errors = legal_errors_m(pair, ERROR_SHARE * pair.pinion.module_m, rows)
    else:
        errors = np.asarray(centre_distance_errors_m, dtype=np.float64)
    tilts = np.zeros(1) if tilts_rad is None else np.asarray(tilts_rad, dtype=np.float64)
    contacts = [pair.contact(float(e)) for e in errors]
    xi = np.linspace(0.0, 1.0, points)
    arms_m = torsion_arm_m(tilts, pair.width_m, pair.mean_deflection_m)
    helix = pair.helix
    samples = xi if helix.overlap_ratio == 0.0 else np.linspace(0.0, 1.0, POINTS)
    stiffness = np.empty((tilts.size, errors.size, points))
    for row, contact in enumerate(contacts):
        parts = pair_compliance(pair, contact, samples * contact.contact_ratio)
        for layer, (tilt, arm_m) in enumerate(zip(tilts, arms_m, strict=True)):
            spur = 1 / parts.total_m_per_n(float(tilt), float(arm_m))
            ratio = contact.contact_ratio
            helical = helix.overlap_ratio > 0.0
            stiffness[layer, row] = spread(spur, ratio, helix, xi * (ratio + helix.overlap_ratio)) if helical else spur
    return PairTable(
        tilts_rad=tilts,
        centre_distance_error_m=errors,
        contact_ratio=np.array([c.contact_ratio + helix.overlap_ratio for c in contacts]),
        start_m=np.array([c.start_m for c in contacts]),
        stiffness_n_per_m=stiffness,
    )


def interpolation_error(table: PairTable, pair: GearPair) -> InterpolationError:
    """Measure the table against direct calculation in the middle of every cell of tilt, error and position."""
    points = table.stiffness_n_per_m.shape[-1]
    xi = (np.arange(points - 1) + 0.5) / (points - 1)
    worst, ratio_worst = 0.0, 0.0
    for error_m in _middles(table.centre_distance_error_m):
        ratio = pair.engagement(error_m)
        ratio_worst = max(ratio_worst, abs(ratio - table.ratio_at(error_m)))
        for tilt in _middles(table.tilts_rad):
            exact = pair_stiffness_n_per_m(pair, xi * ratio, error_m, tilt)
            curve = table.pair_n_per_m(xi * table.ratio_at(error_m), error_m, tilt)
            worst = max(worst, float(np.max(np.abs(curve / exact - 1))))
    return InterpolationError(stiffness_relative=worst, contact_ratio_absolute=ratio_worst)


def _middles(grid: FloatArray) -> list[float]:
    return [float(v) for v in (0.5 * (grid[1:] + grid[:-1]) if grid.size > 1 else grid)]
