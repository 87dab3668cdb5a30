"""Where a recorded channel sits in the machine: the simulated channel that stands for it."""

from __future__ import annotations

from collections.abc import Sequence

from sim.core.errors import Problem, SpecError
from sim.core.near import did_you_mean
from sim.core.response import Channel
from sim.core.spec import MachineSpec


def _on_bearing(machine: MachineSpec, name: str, axis: str) -> str:
    for resonator in machine.resonators:
        if resonator.bearing == name and resonator.axis == axis:
            return f"{resonator.name}.{axis}.acceleration"
    return f"{name}.outer.{axis}.acceleration"


def simulated_channel(machine: MachineSpec, channel: Channel) -> str | None:
    """Name of the acceleration that moves the sensor, or None when its location is not in the machine.

    A sensor at a bearing sits on its resonator (the seed's sensor mount) where there is one on that axis, else on
    the outer ring. Any further path to the sensor is unknown and calibrated; so is the quantity's integration.
    """
    axis = (channel.axis or "y").lower()
    if axis not in ("x", "y"):
        axis = "y"
    location = (channel.location or "").split(".")[0]
    if location in {b.name for b in machine.bearings}:
        return _on_bearing(machine, location, axis)
    for resonator in machine.resonators:
        if location == resonator.name:
            return f"{resonator.name}.{resonator.axis}.acceleration"
    if location in {g.name for g in machine.gears if g.translates} | {b.name for b in machine.bodies}:
        return f"{location}.{axis}.acceleration"
    return None


def sensor_sites(machine: MachineSpec, simulated: Sequence[str]) -> tuple[str, ...]:
    """The part that each simulated channel is heard at; a resonator is at its bearing."""
    at = {r.name: r.bearing for r in machine.resonators}
    return tuple(at.get(name.split(".")[0], name.split(".")[0]) for name in simulated)


def simulated_channels(machine: MachineSpec, channels: Sequence[Channel]) -> tuple[str, ...]:
    """One simulated channel a recorded one; SpecError names locations the machine does not have."""
    found = [simulated_channel(machine, c) for c in channels]
    known = [b.name for b in machine.bearings] + [r.name for r in machine.resonators]
    known += [b.name for b in machine.bodies]
    known += [g.name for g in machine.gears if g.translates]
    problems = [
        Problem(
            field=f"channels.{c.name}.location",
            message=_not_heard(machine, c, known),
            given=c.location or "",
            allowed=", ".join(known) or "none: no part of this machine moves along x or y",
        )
        for c, name in zip(channels, found, strict=True)
        if name is None
    ]
    if problems:
        raise SpecError(problems)
    return tuple(name for name in found if name is not None)


def _not_heard(machine: MachineSpec, channel: Channel, known: Sequence[str]) -> str:
    """Why no simulated acceleration stands for the channel."""
    if (channel.location or "").split(".")[0] in {g.name for g in machine.gears}:
        return "only turns in this machine: a sensor needs a part that moves along x or y"
    return f"is not a place of this machine{did_you_mean(channel.location or '', known)}"


def standard_channels(machine: MachineSpec, wanted: Sequence[str]) -> tuple[str, ...]:
    """Both axes at every bearing, and what is wanted beside them: one atlas serves any choice of sensors."""
    usual = {_on_bearing(machine, b.name, axis) for b in machine.bearings for axis in ("x", "y")}
    return tuple(sorted(usual | set(wanted)))
