"""Kinematics are checked in steps, each only where the one before found nothing: here every step is made of every part,
so that all that is wrong is told at once."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from reconcile.kinematics import KinematicSpec, read_kinematic_spec
from sim.core.errors import Problem, SpecError
from sim.core.spec.base import MAX_ITEMS

_ANY_BEARING = {"orders": {"bpfo": 3.0, "bpfi": 5.0}}
_ANY_TEETH = {"teeth": 20}
_KINDS = ("shafts", "bearings", "gears", "meshes")


def read_every_part(kinematics: object) -> KinematicSpec:
    """`read_kinematic_spec` of {"kinematics": kinematics}; SpecError also with what its later steps would find."""
    try:
        return read_kinematic_spec({"kinematics": kinematics})
    except SpecError as error:
        problems = list(error.problems)
    if isinstance(kinematics, Mapping):
        told = {p.field for p in problems}
        problems += [p for p in _behind(kinematics) if not _within(p.field, told)]
    raise SpecError(problems)


def _within(field: str, told: set[str]) -> bool:
    """Whether this field, or a part of it, is told of already."""
    return any(one == field or one.startswith(f"{field}.") for one in told)


def _behind(kinematics: Mapping[str, object]) -> Iterator[Problem]:
    parts = {kind: _objects(kinematics.get(kind)) for kind in _KINDS}
    shafts = [{"name": shaft.get("name")} for shaft in parts["shafts"]]
    bearings = [{**_placed(bearing), **_ANY_BEARING} for bearing in parts["bearings"]]
    gears = [{**_placed(gear), **_ANY_TEETH} for gear in parts["gears"]]
    yield from _told({"shafts": shafts, "bearings": bearings, "gears": gears, "meshes": list(parts["meshes"])})
    for i, bearing in enumerate(parts["bearings"]):
        alone = {**bearing, "name": "bearing", "shaft": "shaft"}
        for problem in _told({"shafts": [{"name": "shaft"}], "bearings": [alone]}):
            field = problem.field.replace("kinematics.bearings.0", f"kinematics.bearings.{i}", 1)
            yield replace(problem, field=field)


def _objects(parts: object) -> list[Mapping[str, object]]:
    """The parts of a list in their places; nothing where one is no object, which is told already."""
    several = list(parts)[:MAX_ITEMS] if isinstance(parts, list) else []
    return several if all(isinstance(part, Mapping) for part in several) else []


def _placed(part: Mapping[str, object]) -> dict[str, object]:
    return {key: part.get(key) for key in ("name", "shaft")}


def _told(kinematics: Mapping[str, object]) -> Sequence[Problem]:
    try:
        read_kinematic_spec({"kinematics": kinematics})
    except SpecError as error:
        return error.problems
    return ()
