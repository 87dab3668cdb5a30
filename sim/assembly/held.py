"""Whether everything is held: free motions are the null vectors of the stiffness, contacts counted as closed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from sim.assembly.linear import Linear
from sim.core.elements import Element
from sim.core.errors import Problem, SpecError
from sim.core.laws import SupportLaw
from sim.core.response import FloatArray
from sim.core.spec import MachineSpec

BoolArray = NDArray[np.bool_]

RANK = 1e-9
"""Singular value, over the largest, below which a motion meets no stiffness: rows and columns are brought to size 1
first, so a held motion lies near 1 and a free one at rounding."""
BALANCING = 8
"""Rounds of scaling rows and columns to unit length (Ruiz 2001, RAL-TR-2001-034); each halves what is left."""
SHARE = 1e-6
"""Part of the largest entry below which a DOF takes no part in a free motion."""
MOST_NAMED = 12


def element_rows(element: Element, names: Sequence[str]) -> FloatArray:
    """What a closed contact resists, as rows (at most `forces`, n) over the DOFs; excitations resist nothing.

    A wall (`stiff`) holds all its coordinates; others hold the range of their mean stiffness.
    """
    place = {name: i for i, name in enumerate(names)}
    rows = np.zeros((element.forces, len(names)))
    for k, coordinate in enumerate(element.coordinates[: element.forces]):
        for dof, weight in coordinate.weights:
            rows[k, place[dof]] += weight
    if element.linear_stiffness is not None:
        values, vectors = np.linalg.eigh(np.atleast_2d(element.linear_stiffness))
        kept = values > RANK * max(float(values[-1]), np.finfo(np.float64).tiny)
        return np.asarray(vectors[:, kept].T @ rows, dtype=np.float64)
    return rows if element.stiff else np.zeros((0, len(names)))


def free_motions(rows: FloatArray, owned: BoolArray) -> FloatArray:
    """Basis (d, n) of the motions that no row (m, n) resists, each with an `owned` DOF (n,) of its own if it can; to be
    read only."""
    return _kept_motions(rows.tobytes(), rows.shape[0], owned.tobytes())


@lru_cache(maxsize=256)
def _kept_motions(held: bytes, count: int, own: bytes) -> FloatArray:
    """Machines that differ in speed or elsewhere than in what holds them share it."""
    owned = np.frombuffer(own, dtype=np.bool_)
    n = owned.size
    rows = np.frombuffer(held).reshape(count, n)
    balanced, scale = rows[np.any(rows != 0.0, axis=1)], np.ones(n)
    for _ in range(BALANCING):
        balanced = balanced / np.sqrt(np.linalg.norm(balanced, axis=1, keepdims=True))
        columns = np.sqrt(np.linalg.norm(balanced, axis=0))
        columns = np.where(columns > 0.0, columns, 1.0)
        balanced, scale = balanced / columns, scale / columns
    _, sizes, vectors = np.linalg.svd(balanced, full_matrices=True)
    rank = int(np.sum(sizes > RANK * sizes[0])) if sizes.size else 0
    found = _reduced(vectors[rank:], np.where(owned, 1.0, SHARE)) * scale
    found.flags.writeable = False  # many callers hold it
    return found


def _reduced(basis: FloatArray, weight: FloatArray) -> FloatArray:
    """Gauss-Jordan elimination with full pivoting: every motion owns one DOF that the others leave at rest."""
    reduced = basis.copy()
    for k in range(reduced.shape[0]):
        i, j = np.unravel_index(int(np.argmax(np.abs(reduced[k:]) * weight)), reduced[k:].shape)
        reduced[[k, k + int(i)]] = reduced[[k + int(i), k]]
        reduced[k] /= reduced[k, j]
        others = np.arange(reduced.shape[0]) != k
        reduced[others] -= np.outer(reduced[others, j], reduced[k])
    return reduced


def _pins(rows: FloatArray, turning: BoolArray) -> FloatArray:
    """One DOF held, shape (rotations, n), for each motion of angles alone: shafts turning together, which may be free
    because the torques are in balance.
    """
    angles = np.flatnonzero(turning)
    spun = free_motions(rows[:, angles], np.ones(angles.size, dtype=np.bool_))
    pins = np.zeros((spun.shape[0], turning.size))
    part = np.abs(spun) > SHARE * np.max(np.abs(spun), axis=1, keepdims=True, initial=0.0)
    for pin, alone in zip(pins, part & (part.sum(axis=0) == 1), strict=True):
        pin[angles[np.argmax(alone)]] = 1.0
    return pins


def check_held(
    machine: MachineSpec,
    linear: Linear,
    elements: Sequence[Element],
    supports: Mapping[str, SupportLaw],
) -> None:
    """SpecError for each way the machine could drift off without bound; only its rotation may be free."""
    names = linear.names
    rows = np.vstack([linear.holds, *(element_rows(e, names) for e in elements)])
    turning = np.array([name.endswith(".theta") for name in names])
    rows = np.vstack([rows, _pins(rows, turning)])
    problems = []
    for motion in free_motions(rows, ~turning):
        moving = [names[i] for i in np.flatnonzero(np.abs(motion) > SHARE * np.max(np.abs(motion)))]
        problems.append(_problem(machine, supports, moving))
    if problems:
        raise SpecError(sorted(problems, key=lambda p: p.field))


def _problem(machine: MachineSpec, supports: Mapping[str, SupportLaw], moving: Sequence[str]) -> Problem:
    unborne = _unborne(machine)
    fields = _springs(supports, unborne, moving)
    listed = ", ".join(moving[:MOST_NAMED])
    more = f" and {len(moving) - MOST_NAMED} more" if len(moving) > MOST_NAMED else ""
    together = " together" if len(moving) > 1 else ""
    ways = [f"a bearing on {name}" for name in unborne if f"{name}.x" in moving or f"{name}.y" in moving]
    if fields:
        ways.insert(0, "a spring here" + "".join(f" or at {field}" for field in fields[1:]))
    remedy = " or ".join(ways) or "a spring, bearing or mesh that reaches it"
    return Problem(
        field=fields[0] if fields else moving[0],
        message=f"nothing holds {listed}{more}: free to drift away{together}; {remedy} would hold it",
        given=0.0 if fields else None,
        allowed="above 0" if fields else "",
        unit="N/m" if fields else "",
    )


def _springs(supports: Mapping[str, SupportLaw], unborne: Mapping[str, str], moving: Sequence[str]) -> list[str]:
    """Fields of the springs to ground that are zero along the moving axes."""
    found = []
    for dof in moving:
        name, _, axis = dof.rpartition(".")
        field = f"stiffness_{axis}_n_per_m"
        bearing = name.split(".")[0]
        if bearing in supports and not supports[bearing].released and getattr(supports[bearing], field) == 0.0:
            found.append(f"bearings.{bearing}.support.{field}")
        if name in unborne and axis in ("x", "y"):
            found.append(f"{unborne[name]}.{name}.{field}")
    return list(dict.fromkeys(found))


def _unborne(machine: MachineSpec) -> dict[str, str]:
    """Gears and bodies without a bearing, and the list each stands in."""
    rooms = {g.name: "gears" for g in machine.gears} | {b.name: "bodies" for b in machine.bodies}
    borne = {b.body for b in machine.bearings}
    return {name: room for name, room in rooms.items() if name not in borne}
