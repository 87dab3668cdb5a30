"""A reference solution on disk: parameters, time, motion and mesh table, checked before anything is computed."""

from __future__ import annotations

import zipfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from app.cli.files import read_json
from sim.core.errors import Problem, SpecError
from sim.core.response import FloatArray

DOFS = 28
RESONATORS = (5, 13, 18, 26)
"""Columns of y_r1 to y_r4."""
RING_1 = (3, 4)
"""Columns of x_p1 and y_p1."""


@dataclass(frozen=True, kw_only=True)
class MeshArrays:
    """`rows` (errors, phases) N/m over `errors` m."""

    rows: FloatArray
    errors: FloatArray


@dataclass(frozen=True, kw_only=True)
class Case:
    """`t` (n,) s; `a` (4, n) m/s^2 of the resonators; `ring` (2, n) m of outer ring 1, if the file has positions."""

    name: str
    parameters: Mapping[str, object]
    t: FloatArray
    a: FloatArray
    ring: FloatArray | None
    mesh: MeshArrays | None

    @property
    def irregular(self) -> bool:
        """Irregular motion by its name."""
        return self.name.startswith("rattle")


def read_case(path: Path) -> Case:
    """The case of NAME.json with NAME.npz beside it; SpecError says what is wrong with which file."""
    parameters = read_json(path)
    arrays = read_arrays(path.with_suffix(".npz"))
    t = _array(arrays, "t", path, 1)
    a = _array(arrays, "a", path, 2)
    if a.shape != (t.size, DOFS) or t.size < 2:
        message = "does not hold one row of 28 accelerations a time"
        raise SpecError(Problem(field=f"{path.stem}.a", message=message, given=f"t {t.shape}, a {a.shape}"))
    ring = None
    if "q" in arrays and arrays["q"].shape == a.shape:
        ring = np.asarray(arrays["q"][:, RING_1].T, dtype=np.float64)
    inner = parameters.get("parameters", parameters)
    if not isinstance(inner, Mapping):
        raise SpecError(Problem(field=f"{path.stem}.parameters", message="is not an object"))
    return Case(
        name=path.stem,
        parameters=parameters,
        t=t,
        a=np.asarray(a[:, RESONATORS].T),
        ring=ring,
        mesh=mesh_arrays(arrays),
    )


def read_arrays(path: Path) -> dict[str, FloatArray]:
    """Numeric arrays of an npz file."""
    if not path.is_file():
        raise SpecError(Problem(field=str(path), message="is missing beside its JSON file"))
    try:
        with path.open("rb") as stream, np.load(stream, allow_pickle=False) as stored:
            found = {name: np.asarray(stored[name]) for name in stored.files}
    except (ValueError, OSError, EOFError, KeyError, zipfile.BadZipFile) as error:
        raise SpecError(Problem(field=str(path), message=f"is not a readable npz file: {error}")) from error
    return {
        k: v.astype(np.float64) for k, v in found.items() if np.issubdtype(v.dtype, np.number) and v.dtype.kind != "c"
    }


def mesh_arrays(arrays: Mapping[str, FloatArray]) -> MeshArrays | None:
    """The file's mesh table, if it has one; a table without its centre-distance errors is refused."""
    if "mesh_table" not in arrays:
        return None
    if "centre_distance_error" not in arrays:
        message = "is missing: the mesh table has no centre-distance errors"
        raise SpecError(Problem(field="centre_distance_error", message=message))
    return MeshArrays(rows=arrays["mesh_table"], errors=arrays["centre_distance_error"])


def _array(arrays: Mapping[str, FloatArray], name: str, path: Path, dimensions: int) -> FloatArray:
    field = f"{path.stem}.{name}"
    if name not in arrays:
        known = ", ".join(arrays) or "none"
        raise SpecError(Problem(field=field, message="is missing", given=f"arrays: {known}", allowed=name))
    value = arrays[name]
    if value.ndim != dimensions or not np.all(np.isfinite(value)):
        message = f"must have {dimensions} dimensions and finite numbers only"
        raise SpecError(Problem(field=field, message=message, given=str(value.shape)))
    return value
