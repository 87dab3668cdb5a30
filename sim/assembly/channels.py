"""Every output a machine can give, by name."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

from sim.core.elements import Element, Output
from sim.core.response import Channel

STRAIGHT = ("x", "y")
MOTION = (
    ("displacement", "m", "rad"),
    ("velocity", "m/s", "rad/s"),
    ("acceleration", "m/s^2", "rad/s^2"),
)


def machine_channels(dofs: Sequence[str], elements: Sequence[Element]) -> tuple[Channel, ...]:
    """Motion of every DOF, then the outputs of every element (`mesh1.stiffness`, `bearing1.wall.normal_force`)."""
    return _channels(tuple(dofs), tuple((e.name, e.site, e.outputs) for e in elements))


@lru_cache(maxsize=256)
def _channels(dofs: tuple[str, ...], elements: tuple[tuple[str, str, tuple[Output, ...]], ...]) -> tuple[Channel, ...]:
    """Elements by name, site and outputs: machines of one structure share their channels."""
    result = []
    for dof in dofs:
        location, axis = dof.split(".")[0], dof.rsplit(".", 1)[1]
        for quantity, straight, turning in MOTION:
            unit = straight if axis in STRAIGHT else turning
            kind = quantity if axis in STRAIGHT else f"angular_{quantity}"
            result.append(Channel(name=f"{dof}.{quantity}", quantity=kind, unit=unit, location=location, axis=axis))
    for element, site, outputs in elements:
        result.extend(
            Channel(
                name=f"{element}.{output.name}",
                quantity=output.quantity,
                unit=output.unit,
                location=site,
                axis=output.axis,
            )
            for output in outputs
        )
    return tuple(result)
