"""Which outputs of a simulation a chain needs, checked before anything is computed."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from signals.sensors.place import Pickup, pickup_at
from signals.sensors.shafts import shaft_named, torque_pickup, torsion_channel
from signals.sensors.spec import ProximityProbe, SensorChain, Tacho, TorqueSensor
from sim.core.errors import Problem, SpecError
from sim.core.spec import MachineSpec

QUANTITIES = ("displacement", "velocity", "acceleration")


def quantities_of(names: Iterable[str]) -> dict[str, str]:
    """Quantity of every output of a machine by its name: `pinion.y.acceleration`, `input.theta.velocity`."""
    found = {}
    for name in names:
        stem, _, last = name.rpartition(".")
        turning = stem.endswith(".theta") and last in QUANTITIES
        found[name] = f"angular_{last}" if turning else last
    return found


def pickups(
    chain: SensorChain, machine: MachineSpec | None, known: Mapping[str, str], field: str = "sensors"
) -> tuple[Pickup, ...]:
    """One for every channel of the chain; SpecError lists every channel that the machine cannot serve.

    `known` is the quantity of every output by its name.
    """
    found: list[Pickup] = []
    problems: list[Problem] = []
    for i, channel in enumerate(chain.channels):
        at = f"{field}.channels.{i}"
        try:
            if isinstance(channel, Tacho):
                shaft_named(machine, channel.shaft, f"{at}.shaft")
                body = channel.pulser.body
                seen = [] if body is None else [torsion_channel(body, known, f"{at}.pulser.body")]
                found.append(Pickup(factors=dict.fromkeys(seen, 1.0), location=channel.shaft, axis="theta"))
            elif isinstance(channel, TorqueSensor):
                found.append(torque_pickup(machine, channel.shaft, known, f"{at}.shaft"))
            else:
                if isinstance(channel, ProximityProbe) and channel.probe.shaft is not None:
                    shaft_named(machine, channel.probe.shaft, f"{at}.probe.shaft")
                found.append(pickup_at(channel.place, channel.QUANTITY, known, f"{at}.place"))
        except SpecError as error:
            problems += error.problems
    if problems:
        raise SpecError(problems)
    return tuple(found)


def outputs_needed(found: Iterable[Pickup]) -> list[str]:
    """Names of the outputs, each once, in the order in which they are first needed."""
    return list(dict.fromkeys(name for pickup in found for name in pickup.factors))
