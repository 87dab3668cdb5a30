"""Operating points in terms of the driven shaft: what a recording says of another shaft is converted by the meshes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from reconcile.pulses import contradiction
from signals.recording import Recording
from sim.assembly.kinematics import kinematics
from sim.core.errors import Problem, SpecError
from sim.core.spec import MachineSpec


def on_drive(machine: MachineSpec, recordings: Sequence[Recording]) -> tuple[Recording, ...]:
    """The recordings with speed and torque of the machine's own driven shaft; a tacho of another shaft is left out.

    SpecError where pulses contradict the stated speed.
    """
    found = tuple(_one(machine, r) for r in recordings)
    problems = [p for r in found if (p := contradiction(r, _field(r))) is not None]
    if problems:
        raise SpecError(problems)
    return found


def _one(machine: MachineSpec, recording: Recording) -> Recording:
    operating, drive = recording.operating, machine.operating
    if operating is None or drive is None or operating.shaft == drive.shaft:
        return recording
    speeds = kinematics(machine).shaft_hz
    if operating.shaft not in speeds:
        allowed = ", ".join(speeds)
        field = f"{recording.label}: operating.shaft" if recording.label else "operating.shaft"
        raise SpecError(Problem(field=field, message="is no shaft", given=operating.shaft, allowed=allowed))
    ratio = abs(speeds[drive.shaft] / speeds[operating.shaft])
    torque = None if operating.torque_nm is None else operating.torque_nm / ratio
    stated = replace(operating, shaft=drive.shaft, speed_hz=operating.speed_hz * ratio, torque_nm=torque)
    tacho = recording.tacho if recording.tacho is not None and recording.tacho.shaft == drive.shaft else None
    return replace(recording, operating=stated, tacho=tacho)


def _field(recording: Recording) -> str:
    return f"{recording.label}: tacho.pulses_per_revolution" if recording.label else "tacho.pulses_per_revolution"
