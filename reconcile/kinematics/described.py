"""The machine's kinematics as the description of a recording tells them."""

from __future__ import annotations

from dataclasses import replace

from reconcile.kinematics.spec import KinematicSpec, read_kinematic_spec
from signals.ingest.description import Description
from sim.core.errors import Problem, SpecError

SHAFT, NAME = "shaft", "bearing"
"""What an only bearing and its shaft are called where nobody names them."""


def described_kinematics(description: Description) -> KinematicSpec | None:
    """From `kinematics`, or from `bearing`, the one bearing of the shaft whose speed is told; None without either.

    SpecError names the field that is wrong, or both where both are there.
    """
    if description.kinematics is not None and description.bearing is not None:
        raise SpecError(Problem(field=NAME, message="stands beside kinematics", allowed="one of the two"))
    if description.kinematics is not None:
        return read_kinematic_spec({"kinematics": description.kinematics})
    if description.bearing is None:
        return None
    shaft = _shaft(description)
    told = {"catalogue": description.bearing} if isinstance(description.bearing, str) else description.bearing
    bearing = {"name": NAME, "shaft": shaft, **told}
    try:
        return read_kinematic_spec({"kinematics": {"shafts": [{"name": shaft}], "bearings": [bearing]}})
    except SpecError as error:
        # The field that was written, not the one it was put into.
        here = [replace(p, field=p.field.replace("kinematics.bearings.0", NAME, 1)) for p in error.problems]
        raise SpecError(here) from None


def _shaft(description: Description) -> str:
    if description.operating is not None:
        return description.operating.shaft
    return description.tacho.shaft if description.tacho is not None else SHAFT
