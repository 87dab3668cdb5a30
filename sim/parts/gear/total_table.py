"""Total mesh stiffness over (centre-distance error, mesh phase): computed, or the user's own."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from sim.core.errors import Problem, SpecError
from sim.parts.gear.pair import GearPair, pair_stiffness_n_per_m
from sim.parts.gear.tooth import FloatArray


@dataclass(frozen=True, kw_only=True)
class TotalTable:
    """Rows (R, N) N/m over centre-distance error (R,) m and phase j/N; refused unless rising, finite, positive.

    Bilinear, periodic in phase, clamped in the centre distance; 0 is where a new pair enters. One row is a curve.
    """

    centre_distance_error_m: FloatArray
    stiffness_n_per_m: FloatArray

    def __post_init__(self) -> None:
        """Refuse a table that can't be interpolated."""
        problems = _problems(np.asarray(self.centre_distance_error_m), np.asarray(self.stiffness_n_per_m))
        if problems:
            raise SpecError(problems)

    def total_n_per_m(self, phase: FloatArray, centre_distance_error_m: float = 0.0) -> FloatArray:
        """Stiffness at mesh phases (cycles, any shape), N/m."""
        grid = self.centre_distance_error_m
        at = float(np.interp(centre_distance_error_m, grid, np.arange(grid.size)))
        low = min(int(at), max(grid.size - 2, 0))
        high = min(low + 1, grid.size - 1)
        row = self.stiffness_n_per_m[low] * (1 - at + low) + self.stiffness_n_per_m[high] * (at - low)
        column = np.mod(np.asarray(phase, dtype=np.float64), 1.0) * row.size
        first = column.astype(np.intp) % row.size
        share = column - np.floor(column)
        return np.asarray(row[first] * (1 - share) + row[(first + 1) % row.size] * share)


def _problems(errors_m: FloatArray, stiffness: FloatArray) -> list[Problem]:
    where, found = "table.centre_distance_error_m", []
    if errors_m.ndim != 1 or errors_m.size == 0 or not np.all(np.isfinite(errors_m)):
        found.append(Problem(field=where, message="must be a list of finite numbers", unit="m", allowed="1 or more"))
    elif np.any(np.diff(errors_m) <= 0):
        found.append(Problem(field=where, message="must rise from row to row", given=errors_m.tolist()))
    where = "table.stiffness_n_per_m"
    if stiffness.ndim != 2 or stiffness.shape[0] != errors_m.size or stiffness.shape[-1] < 2:
        allowed = f"{errors_m.size} rows of equal length, 2 or more columns"
        message = "needs one row for every centre-distance error"
        found.append(Problem(field=where, message=message, given=stiffness.shape, allowed=allowed))
    elif not np.all(np.isfinite(stiffness) & (stiffness > 0)):
        row, column = np.argwhere(~(np.isfinite(stiffness) & (stiffness > 0)))[0]
        message, given = f"row {row}, column {column} is not a finite positive number", float(stiffness[row, column])
        found.append(Problem(field=where, message=message, given=given, allowed="> 0", unit="N/m"))
    return found


def total_row_n_per_m(
    pair: GearPair, phase: FloatArray, centre_distance_error_m: float = 0.0, tilt_rad: float = 0.0
) -> FloatArray:
    """Sum over all pairs at mesh phases in [0, 1) (cycles since a pair entered), calculated directly, N/m."""
    first = np.asarray(phase, dtype=np.float64)
    count = int(np.ceil(pair.engagement(centre_distance_error_m)))
    position = first + np.arange(count).reshape(-1, *([1] * first.ndim))
    return np.asarray(pair_stiffness_n_per_m(pair, position, centre_distance_error_m, tilt_rad).sum(axis=0))


def total_table(
    pair: GearPair, centre_distance_errors_m: FloatArray, columns: int = 400, tilt_rad: float = 0.0
) -> TotalTable:
    """Rows over centre-distance error, columns over phase j/columns. Interpolating it smears the jumps; pairs don't."""
    phase = np.arange(columns) / columns
    errors = np.asarray(centre_distance_errors_m, dtype=np.float64)
    rows = [total_row_n_per_m(pair, phase, float(e), tilt_rad) for e in errors]
    return TotalTable(centre_distance_error_m=errors, stiffness_n_per_m=np.array(rows))
