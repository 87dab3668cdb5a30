"""What is known of a machine of which only the drawing's frequencies are known: shafts, bearings, teeth."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Annotated

from pydantic import Field, ValidationError, model_validator
from pydantic_core import ErrorDetails

from reconcile.kinematics.plausible import implausible
from signals.validation import problem_of
from sim.core.errors import Problem, SpecError
from sim.core.near import did_you_mean
from sim.core.spec import MachineSpec, Name, SpecModel
from sim.core.spec.base import MAX_ITEMS, WHOLE
from sim.parts.bearing.geometry import RollingGeometry
from sim.parts.bearing.uncatalogued import uncatalogued


class KinematicShaft(SpecModel):
    """A shaft; its nominal speed is needed where no mesh ties it to the shaft whose speed the recording states."""

    name: Name
    speed_hz: Annotated[float, Field(gt=0, le=2000)] | None = None


class BearingOrders(SpecModel):
    """Cycles per revolution of the shaft, as a maker's table prints them. `bsf` is the spin of a ball, or its line,
    twice that: told by the size. What cannot be of one bearing is refused (`reconcile.kinematics.plausible`)."""

    bpfo: Annotated[float, Field(gt=0)]
    bpfi: Annotated[float, Field(gt=0)]
    bsf: Annotated[float, Field(gt=0)] | None = None
    ftf: Annotated[float, Field(gt=0)] | None = None


class KinematicBearing(SpecModel):
    """A rolling bearing with a fixed outer ring, known in exactly one of four ways: `catalogue`; `balls` with both
    diameters; `balls` with their ratio; `orders`."""

    name: Name
    shaft: Name
    catalogue: Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9 ./-]{0,31}$")] | None = None
    balls: Annotated[int, Field(ge=3, le=64, strict=False), WHOLE] | None = None
    ball_diameter_m: Annotated[float, Field(gt=0, le=0.5)] | None = None
    pitch_diameter_m: Annotated[float, Field(gt=0, le=5)] | None = None
    diameter_ratio: Annotated[float, Field(gt=0, lt=0.9)] | None = None
    contact_angle_deg: Annotated[float, Field(ge=0, le=50)] = 0.0
    orders: BearingOrders | None = None

    @model_validator(mode="after")
    def _one_way(self) -> KinematicBearing:
        ways = [self.catalogue is not None, self.balls is not None, self.orders is not None]
        if sum(ways) != 1:
            raise ValueError("give exactly one of catalogue, balls (with diameters or their ratio) and orders")
        if self.balls is not None:
            lengths = self.ball_diameter_m is not None and self.pitch_diameter_m is not None
            if lengths == (self.diameter_ratio is not None):
                raise ValueError("balls need both diameters, or diameter_ratio")
            if lengths and float(self.ball_diameter_m or 0) >= 0.9 * float(self.pitch_diameter_m or 0):
                raise ValueError("ball_diameter_m must be smaller than pitch_diameter_m")
        return self


class KinematicGear(SpecModel):
    """A gear: its shaft and teeth."""

    name: Name
    shaft: Name
    teeth: Annotated[int, Field(ge=3, le=2000, strict=False), WHOLE]


class KinematicMesh(SpecModel):
    """Two gears in mesh."""

    name: Name
    gears: Annotated[list[Name], Field(min_length=2, max_length=2)]


class KinematicSpec(SpecModel):
    """Shafts with what turns on them. Names are the sites of the report."""

    name: Annotated[str, Field(max_length=80)] = ""
    shafts: Annotated[list[KinematicShaft], Field(min_length=1, max_length=MAX_ITEMS)]
    bearings: Annotated[list[KinematicBearing], Field(max_length=MAX_ITEMS)] = Field(default_factory=list)
    gears: Annotated[list[KinematicGear], Field(max_length=MAX_ITEMS)] = Field(default_factory=list)
    meshes: Annotated[list[KinematicMesh], Field(max_length=MAX_ITEMS)] = Field(default_factory=list)

    @model_validator(mode="after")
    def _tied(self) -> KinematicSpec:
        problems = [*_repeated(self), *_untied(self), *_contradicted(self), *_implausible(self)]
        if problems:
            raise NotTied(problems)
        return self

    @property
    def parts(self) -> tuple[str, ...]:
        """Names of all parts: what a channel's location may be."""
        return tuple(x.name for several in (self.shafts, self.bearings, self.gears, self.meshes) for x in several)


SPEEDS_AGREE = 0.02
"""Relative difference up to which rounded nominal speeds of two shafts fit the teeth between them."""


class NotTied(ValueError):
    """Parts that name parts which are not there, or contradict each other; `problems` say the field, from
    `kinematics` on."""

    def __init__(self, problems: Sequence[Problem]) -> None:
        self.problems = tuple(problems)
        super().__init__("; ".join(str(p) for p in problems))


def _repeated(spec: KinematicSpec) -> Iterator[Problem]:
    seen: set[str] = set()
    for kind in ("shafts", "bearings", "gears", "meshes"):
        for i, part in enumerate(getattr(spec, kind)):
            if part.name in seen:
                message = "is used twice: every part needs a name of its own"
                yield Problem(field=f"{kind}.{i}.name", message=message, given=part.name, allowed="a name not yet used")
            seen.add(part.name)


def _untied(spec: KinematicSpec) -> Iterator[Problem]:
    """Shafts of bearings and gears, and gears of meshes, that do not exist."""
    shafts, gears = [s.name for s in spec.shafts], {g.name: g for g in spec.gears}
    carried = [(f"bearings.{i}.shaft", b.shaft) for i, b in enumerate(spec.bearings)]
    carried += [(f"gears.{i}.shaft", g.shaft) for i, g in enumerate(spec.gears)]
    for field, name in carried:
        if name not in shafts:
            message = f"is no shaft{did_you_mean(name, shafts)}"
            yield Problem(field=field, message=message, given=name, allowed=", ".join(shafts))
    for i, mesh in enumerate(spec.meshes):
        for j, name in enumerate(mesh.gears):
            if name not in gears:
                allowed = ", ".join(gears) or "none is listed under gears"
                message = f"is no gear{did_you_mean(name, gears)}"
                yield Problem(field=f"meshes.{i}.gears.{j}", message=message, given=name, allowed=allowed)
        turned = [gears[name].shaft for name in mesh.gears if name in gears]
        if len(turned) == 2 and turned[0] == turned[1]:
            allowed = "gears of two shafts"
            yield Problem(
                field=f"meshes.{i}.gears", message=f"are both on {turned[0]}", given=mesh.gears, allowed=allowed
            )


def _contradicted(spec: KinematicSpec) -> Iterator[Problem]:
    """Nominal speeds of two shafts that the teeth between them do not make."""
    gears, speeds = {g.name: g for g in spec.gears}, {s.name: s.speed_hz for s in spec.shafts}
    for i, mesh in enumerate(spec.meshes):
        one, other = (gears.get(name) for name in mesh.gears)
        if one is None or other is None:
            continue
        hz, had = speeds.get(one.shaft), speeds.get(other.shaft)
        if hz is None or had is None or abs(hz * one.teeth / (had * other.teeth) - 1.0) <= SPEEDS_AGREE:
            continue
        made = hz * one.teeth / other.teeth
        yield Problem(
            field=f"meshes.{i}.gears",
            message=f"{one.teeth} teeth on {one.shaft} at {hz:.4g} Hz turn {other.shaft} at {made:.4g} Hz, but its "
            f"speed_hz is {had:.4g}",
            given=had,
            allowed=f"{made:.4g}, or no speed_hz where a mesh makes it",
            unit="Hz",
        )


def _implausible(spec: KinematicSpec) -> Iterator[Problem]:
    """Stated orders that cannot be of one bearing."""
    for i, bearing in enumerate(spec.bearings):
        if (o := bearing.orders) is not None:
            yield from implausible(f"bearings.{i}.orders", o.bpfo, o.bpfi, o.bsf, o.ftf)


def given_geometry(bearing: KinematicBearing) -> RollingGeometry:
    """Of a bearing whose balls are stated; SpecError where they can't be those of one."""
    assert bearing.balls is not None
    ball, pitch = bearing.ball_diameter_m, bearing.pitch_diameter_m
    ratio = bearing.diameter_ratio if bearing.diameter_ratio is not None else (ball or 0.0) / (pitch or 1.0)
    return RollingGeometry(
        balls=bearing.balls,
        diameter_ratio=ratio,
        ball_diameter_m=ball,
        pitch_diameter_m=pitch,
        contact_angle_rad=math.radians(bearing.contact_angle_deg),
    )


def _misfitting(bearing: KinematicBearing, field: str) -> Iterator[Problem]:
    """What of the stated sizes of a bearing cannot be together."""
    try:
        given_geometry(bearing)
    except SpecError as error:
        yield from (replace(p, field=f"{field}.{p.field}") for p in error.problems)


def read_kinematic_spec(document: object) -> KinematicSpec:
    """The specification in {"kinematics": {...}}, or SpecError with every wrong field."""
    if not isinstance(document, dict) or set(document) != {"kinematics"}:
        given = sorted(map(str, document)) if isinstance(document, dict) else type(document).__name__
        message = "must be an object with the one key 'kinematics'"
        raise SpecError(Problem(field="machine", message=message, given=given, allowed="kinematics"))
    try:
        spec = KinematicSpec.model_validate(document["kinematics"])
    except ValidationError as error:
        raise SpecError([problem for e in error.errors() for problem in _told(e)]) from None
    unknown = [
        problem
        for i, b in enumerate(spec.bearings)
        if b.catalogue is not None
        and (problem := uncatalogued(b.catalogue, f"kinematics.bearings.{i}.catalogue")) is not None
    ]
    for i, b in enumerate(spec.bearings):
        if b.balls is not None:
            unknown += _misfitting(b, f"kinematics.bearings.{i}")
    if unknown:
        raise SpecError(unknown)
    return spec


def _told(error: ErrorDetails) -> list[Problem]:
    """One problem of pydantic's, or those of parts that name parts which are not there."""
    cause = error.get("ctx", {}).get("error")
    if isinstance(cause, NotTied):
        return [replace(p, field=f"kinematics.{p.field}") for p in cause.problems]
    return [problem_of(error, "kinematics", KinematicSpec)]


def of_machine(machine: MachineSpec) -> KinematicSpec:
    """What of a full machine specification is kinematics; bearings without a shaft or sizes are left out."""
    carrier = {g.name: g.shaft for g in machine.gears} | {b.name: b.shaft for b in machine.bodies if b.shaft}
    bearings = []
    for b in machine.bearings:
        if b.body not in carrier or (b.geometry is None and b.catalogue is None):
            continue
        if b.geometry is None:
            bearings.append(KinematicBearing(name=b.name, shaft=carrier[b.body], catalogue=b.catalogue))
            continue
        g = b.geometry
        lengths = g.ball_diameter_m is not None and g.pitch_diameter_m is not None
        bearings.append(
            KinematicBearing(
                name=b.name,
                shaft=carrier[b.body],
                balls=g.balls,
                ball_diameter_m=g.ball_diameter_m if lengths else None,
                pitch_diameter_m=g.pitch_diameter_m if lengths else None,
                diameter_ratio=None if lengths else g.diameter_ratio,
                contact_angle_deg=g.contact_angle_deg,
            )
        )
    operating = machine.operating
    return KinematicSpec(
        name=machine.name,
        shafts=[
            KinematicShaft(
                name=s.name,
                speed_hz=operating.speed_hz if operating is not None and operating.shaft == s.name else None,
            )
            for s in machine.shafts
        ],
        bearings=bearings,
        gears=[KinematicGear(name=g.name, shaft=g.shaft, teeth=g.teeth) for g in machine.gears],
        meshes=[KinematicMesh(name=m.name, gears=[m.pinion, m.gear]) for m in machine.meshes],
    )
