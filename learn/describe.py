"""What a description (`R.json`) or a machine file says of bearings: the geometry that the classifier may use."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from learn.orders import FaultOrders
from reconcile.kinematics.families import ties
from reconcile.kinematics.spec import KinematicSpec, read_kinematic_spec
from sim.core.errors import Problem, SpecError

KINEMATICS, BEARING = "kinematics", "bearing"
SHAFT = "shaft"


@dataclass(frozen=True, kw_only=True)
class Site:
    """A bearing: its orders per turn of its own shaft, and how often that turns in a turn of the shaft measured."""

    name: str
    orders: FaultOrders
    ratio: float


def kinematics_in(extra: Mapping[str, object], shaft: str | None) -> KinematicSpec | None:
    """`kinematics` (as in a machine file) or `bearing` (one bearing) beside the other keys of a description."""
    if KINEMATICS in extra and BEARING in extra:
        raise SpecError(Problem(field=BEARING, message="stands beside kinematics", allowed="one of the two"))
    if KINEMATICS in extra:
        return read_kinematic_spec({KINEMATICS: extra[KINEMATICS]})
    if BEARING not in extra:
        return None
    one = extra[BEARING]
    if isinstance(one, str):
        one = {"catalogue": one}
    if not isinstance(one, Mapping):
        allowed = "a catalogue name, or an object as in kinematics.bearings"
        raise SpecError(
            Problem(field=BEARING, message="must say one bearing", given=type(one).__name__, allowed=allowed)
        )
    name = shaft or SHAFT
    row = {"name": "bearing", "shaft": name, **one}
    return read_kinematic_spec({KINEMATICS: {"shafts": [{"name": name}], "bearings": [row]}})


def sites(spec: KinematicSpec, shaft: str | None) -> list[Site]:
    """Bearings of a specification, seen from the shaft whose speed is told."""
    names = [s.name for s in spec.shafts]
    tied = ties(spec, shaft if shaft in names else None)
    found: list[Site] = []
    for bearing in spec.bearings:
        ratio = tied.shafts[bearing.shaft]
        order = {f.kind: f.order / ratio for f in tied.families if f.site == bearing.name}
        orders = FaultOrders(outer=order["outer"], inner=order["inner"], ball=order["ball"], cage=order["cage"])
        if all(orders != s.orders or ratio != s.ratio for s in found):
            found.append(Site(name=bearing.name, orders=orders, ratio=ratio))
    return found
