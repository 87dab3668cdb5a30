"""What a parameter file leaves out, derived; what it gives twice, compared."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from sim.core.errors import Problem, SpecError
from sim.core.response import FloatArray
from sim.core.spec import MeshTable
from sim.parts.gear import GearGeometry, GearPair, total_table
from sim.parts.gear.checks import check_centre_distance
from sim.parts.gear.from_spec import BORE_SHARE

YOUNGS_MODULUS_PA = 2.16e11
"""Seed, Table 3."""
POISSON_RATIO = 0.3
TABLE_REACH_M, TABLE_ROWS, TABLE_COLUMNS = 2e-4, 9, 400
"""Grid of the reference solutions' tables."""
RESAMPLED_ROWS = 201
AGREEMENT = 1e-4
"""Relative difference of two values that still say the same: files round to four digits or more."""


@dataclass(frozen=True, kw_only=True)
class Table:
    """A mesh table on an even grid, and how it came about."""

    table: MeshTable
    said: str
    warning: str = ""


def kinematic_values(p: Mapping[str, float], notes: dict[str, str], warnings: list[str]) -> dict[str, float]:
    """fm, fr2, Rb_pin, Rb_ge, a0 and Tout; refused where the file contradicts its own teeth, module and speed.

    The equations of the reference solutions have T on the input and -T Rb_ge / Rb_pin on the output, so Tout is no
    input of its own: one that says something else is warned of, and the balance is what acts.
    """
    cosine = math.cos(math.radians(p["al"]))
    rules = {
        "fm": (p["z1"] * p["fr1"], "z1 fr1", "Hz"),
        "fr2": (p["fr1"] * p["z1"] / p["z2"], "fr1 z1 / z2", "Hz"),
        "Rb_pin": (0.5 * p["m"] * p["z1"] * cosine, "m z1 cos(al) / 2", "m"),
        "Rb_ge": (0.5 * p["m"] * p["z2"] * cosine, "m z2 cos(al) / 2", "m"),
    }
    problems = []
    values: dict[str, float] = {}
    for name, (value, rule, unit) in rules.items():
        given = p.get(name)
        values[name] = value
        if given is None:
            notes[name] = f"derived: {value:.9g} {unit} ({rule})"
        elif abs(given - value) > AGREEMENT * abs(value):
            message = f"contradicts {rule} = {value:.9g}"
            allowed = f"{value:.9g} (within {AGREEMENT:.2g} of it), or left out"
            problems.append(Problem(field=f"parameters.{name}", message=message, given=given, allowed=allowed))
    if problems:
        raise SpecError(problems)
    balance = p["T"] * p["z2"] / p["z1"]
    if "Tout" not in p:
        notes["Tout"] = f"derived: {balance:.9g} N m (T Rb_ge / Rb_pin, in balance)"
    elif abs(p["Tout"] - balance) > AGREEMENT * max(abs(balance), abs(p["Tout"])):
        warnings.append(
            f"Tout = {p['Tout']:g} N m is not T Rb_ge / Rb_pin = {balance:.9g} N m; the latter acts on the output "
            "shaft, as in the equations of the reference solutions"
        )
    standard = 0.5 * p["m"] * (p["z1"] + p["z2"])
    if "a0" not in p:
        notes["a0"] = f"derived: {standard:.9g} m (m (z1 + z2) / 2)"
    return values | {"Tout": balance, "a0": p.get("a0", standard)}


def check_a0(p: Mapping[str, float]) -> None:
    """SpecError names a0 and the distances at which the teeth work, where a given one is none of them."""
    if "a0" not in p:
        return
    try:
        check_centre_distance(_geometry(p, "z1"), _geometry(p, "z2"), p["a0"])
    except SpecError as error:
        raise SpecError([replace(problem, field="parameters.a0") for problem in error.problems]) from error


def _geometry(p: Mapping[str, float], teeth: str) -> GearGeometry:
    return GearGeometry(
        teeth=int(p[teeth]),
        module_m=p["m"],
        face_width_m=p["W"],
        bore_radius_m=BORE_SHARE * 0.5 * p["m"] * p[teeth],
        youngs_modulus_pa=YOUNGS_MODULUS_PA,
        pressure_angle_rad=math.radians(p["al"]),
        poisson_ratio=POISSON_RATIO,
    )


def derived_table(p: Mapping[str, float]) -> Table:
    """The potential-energy table on the reference grid: ha* = 1, c* = 0.25, nu = 0.3, bore 0.3 r, clamped at base."""
    pair = GearPair(pinion=_geometry(p, "z1"), gear=_geometry(p, "z2"), centre_distance_m=p.get("a0"))
    errors = np.linspace(-TABLE_REACH_M, TABLE_REACH_M, TABLE_ROWS)
    found = total_table(pair, errors, columns=TABLE_COLUMNS)
    said = (
        f"derived: {TABLE_ROWS} x {TABLE_COLUMNS}, mean {found.stiffness_n_per_m[TABLE_ROWS // 2].mean():.6g} N/m "
        "(potential-energy method, ha* = 1, c* = 0.25, nu = 0.3, bore 0.3 r, tooth clamped on the base circle, "
        f"E = {YOUNGS_MODULUS_PA:.4g} Pa)"
    )
    warnings = "; ".join(pair.warnings)
    return Table(table=_mesh_table(errors, found.stiffness_n_per_m), said=said, warning=warnings)


def given_table(table: FloatArray, errors: FloatArray) -> Table:
    """The file's own table (rows, columns) N/m over errors (rows,) m, put on an even grid where it is not."""
    rows, grid = np.asarray(table, dtype=np.float64), np.atleast_1d(np.asarray(errors, dtype=np.float64))
    rows = np.atleast_2d(rows)
    if grid.ndim != 1 or rows.ndim != 2 or rows.shape[0] != grid.size or rows.shape[1] < 2:
        message = "needs one row for every centre-distance error"
        raise SpecError(
            Problem(field="mesh_table", message=message, given=str(rows.shape), allowed=f"{grid.size} rows")
        )
    if not (np.all(np.isfinite(rows)) and np.all(rows > 0) and np.all(np.isfinite(grid)) and np.all(np.diff(grid) > 0)):
        message = "must be positive stiffness over rising centre-distance errors, all finite"
        raise SpecError(Problem(field="mesh_table", message=message, unit="N/m"))
    even = np.linspace(grid[0], grid[-1], grid.size)
    said = f"given: {rows.shape[0]} x {rows.shape[1]}, mean {_row_at_zero(rows, grid).mean():.6g} N/m"
    if grid.size < 3 or np.max(np.abs(even - grid)) <= 1e-6 * (even[1] - even[0]):
        return Table(table=_mesh_table(even, rows), said=said)
    fine = np.linspace(grid[0], grid[-1], RESAMPLED_ROWS)
    resampled = np.stack([np.interp(fine, grid, column) for column in rows.T], axis=1)
    warning = f"the table's centre-distance errors are not evenly spaced; resampled on {RESAMPLED_ROWS} even rows"
    return Table(table=_mesh_table(fine, resampled), said=said, warning=warning)


def mesh_damping(p: Mapping[str, float], table: MeshTable, base_radii_m: tuple[float, float]) -> float:
    """ct = 2 zeta_m sqrt(k m_eq), m_eq = 1 / (Rb_pin^2 / Ip + Rb_ge^2 / Ig), k the mean of the row at zero error."""
    rows = np.asarray(table.stiffness_n_per_m)
    mean = float(_row_at_zero(rows, np.asarray(table.centre_distance_error_m)).mean())
    mass = 1.0 / (base_radii_m[0] ** 2 / p["Ip"] + base_radii_m[1] ** 2 / p["Ig"])
    return 2.0 * p.get("zeta_m", 0.05) * math.sqrt(mean * mass)


def _row_at_zero(rows: FloatArray, grid: FloatArray) -> FloatArray:
    at = float(np.interp(0.0, grid, np.arange(grid.size)))
    low = min(int(at), max(grid.size - 2, 0))
    high = min(low + 1, grid.size - 1)
    return np.asarray(rows[low] * (1 - at + low) + rows[high] * (at - low))


def _mesh_table(errors: FloatArray, rows: FloatArray) -> MeshTable:
    return MeshTable(centre_distance_error_m=errors.tolist(), stiffness_n_per_m=rows.tolist())
