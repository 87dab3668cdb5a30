"""Every machine of a plan built once, one after the other: what tells it from others is kept, the machines are not."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from sideband_datasets.plan.machines import Machine


@dataclass(frozen=True, kw_only=True, slots=True)
class Known:
    """What tells a machine and its transfer paths from others: see `Machine`."""

    machine_id: str
    measurement: int | None
    content: str
    channel_paths: Mapping[str, str]


def known_of(machine: Machine) -> Known:
    """What is kept of a machine."""
    return Known(
        machine_id=machine.machine_id,
        measurement=machine.measurement,
        content=machine.content,
        channel_paths=machine.channel_paths,
    )


def walked(machines: Iterable[Machine]) -> Sequence[Known]:
    """What tells all machines of a plan; SpecError for the first that cannot be built."""
    return [known_of(machine) for machine in machines]
