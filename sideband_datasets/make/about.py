"""What a recording's rows say of their machine: bearing and mesh frequencies, fault, place, operating point."""

from __future__ import annotations

from collections.abc import Mapping

from sideband_datasets.make.batch import Made
from sideband_datasets.plan.drawing import Drawing
from sim.core.response import Channel
from sim.core.spec import MachineSpec

FREQUENCIES = {"bpfo_hz": "f_o", "bpfi_hz": "f_i", "bsf_hz": "f_b", "ftf_hz": "f_c"}
"""Column to the letter of the base frequency, which the number of the bearing follows."""
ORIGIN = "simulated"


def bearing_at(machine: MachineSpec, location: str) -> str | None:
    """The bearing that a part belongs to, else the first; None without bearings."""
    names = [bearing.name for bearing in machine.bearings]
    mounts = {resonator.name: resonator.bearing for resonator in machine.resonators}
    place = location.split(".", maxsplit=1)[0]
    return next((name for name in (mounts.get(place, place), *names) if name in names), None)


def bearing_of(drawn: Drawing, channel: Channel) -> str | None:
    """The faulty bearing, else the one the sensor sits at, else the first; None without bearings."""
    names = [bearing.name for bearing in drawn.spec.bearings]
    faulty = [effect.site for effect in drawn.effects if effect.site in names]
    return faulty[0] if faulty else bearing_at(drawn.spec, channel.location)


def _mesh_base(machine: MachineSpec, drawn: Drawing) -> str:
    sites = {effect.site for effect in drawn.effects}
    for number, mesh in enumerate(machine.meshes, start=1):
        if sites & {mesh.name, mesh.pinion, mesh.gear}:
            return "f_m" if number == 1 else f"f_m{number}"
    return "f_m"


def frequencies(drawn: Drawing, bearing: str | None, bases_hz: Mapping[str, float]) -> dict[str, float | None]:
    """Columns of the defect frequencies of a bearing and of the mesh, Hz."""
    names = [b.name for b in drawn.spec.bearings]
    index = names.index(bearing) + 1 if bearing is not None else 0
    found: dict[str, float | None] = {name: bases_hz.get(f"{letter}{index}") for name, letter in FREQUENCIES.items()}
    return {**found, "mesh_hz": bases_hz.get(_mesh_base(drawn.spec, drawn))}


def planned_columns(drawn: Drawing) -> dict[str, object]:
    """Columns that the plan alone decides, before anything is simulated."""
    first = drawn.effects[0] if drawn.effects else None
    return {
        "recording_id": drawn.recording_id,
        "recording": drawn.number,
        "fault_type": drawn.fault_type,
        "fault_location": first.site if first else None,
        "fault_origin": ORIGIN,
        "fault_severity": first.severity if first else None,
        "fault_severity_name": (first.parameter or None) if first else None,
        "fault_severity_unit": (first.unit or None) if first else None,
        "labels": tuple(effect.label for effect in drawn.effects),
        "severities": tuple(float("nan") if effect.severity is None else effect.severity for effect in drawn.effects),
        "split": drawn.split,
        "machine_id": drawn.machine.machine_id,
        "machine": drawn.machine.family,
        "path_id": drawn.machine.path_id,
        "measurement": drawn.measurement,
        "seed": drawn.noise_seed,
    }


def columns_of(made: Made, channel: Channel, bases_hz: Mapping[str, float], speed_ratio: float) -> dict[str, object]:
    """Columns that all rows of a window share. `speed_ratio`: mean speed in the window over that of all simulated."""
    drawn, operating = made.drawing, made.recording.operating
    bearing = bearing_of(drawn, channel)
    return {
        **planned_columns(drawn),
        "channel": channel.name,
        "sensor_location": channel.location,
        "axis": channel.axis,
        "quantity": channel.quantity,
        "unit": channel.unit,
        "sampling_rate_hz": made.recording.sampling_rate_hz,
        "speed_hz": operating.speed_hz * speed_ratio if operating is not None else None,
        "load_nm": operating.torque_nm if operating is not None else None,
        "bearing_id": bearing,
        **frequencies(drawn, bearing, bases_hz),
        "warnings": made.response.warnings,
    }
