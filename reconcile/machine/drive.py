"""Operating points in terms of the driven shaft: what a recording says of another shaft is converted by the meshes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from signals.recording import Recording
from sim.assembly.kinematics import kinematics
from sim.core.errors import Problem, SpecError
from sim.core.spec import MachineSpec

SAME_SPEED = 0.05
"""Relative difference up to which pulses and statement may be of one speed: labels are that wrong."""


def on_drive(machine: MachineSpec, recordings: Sequence[Recording]) -> tuple[Recording, ...]:
    """The recordings with speed and torque of the machine's own driven shaft; a tacho of another shaft is left out.

    SpecError where pulses contradict the stated speed.
    """
    found = tuple(_one(machine, r) for r in recordings)
    problems = [p for r in found if (p := _contradiction(r)) is not None]
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


def _contradiction(recording: Recording) -> Problem | None:
    operating, tacho = recording.operating, recording.tacho
    if operating is None or tacho is None or tacho.shaft != operating.shaft or tacho.pulse_times_s.size < 2:
        return None
    times = tacho.pulse_times_s
    hz = float((times.size - 1) / (times[-1] - times[0]) / tacho.pulses_per_revolution)
    if abs(hz / operating.speed_hz - 1.0) <= SAME_SPEED:
        return None
    return Problem(
        field=f"{recording.label}: tacho.pulses_per_revolution" if recording.label else "tacho.pulses_per_revolution",
        message=f"its pulses make {hz:.4g} Hz, but {operating.speed_hz:.4g} Hz are stated",
        given=tacho.pulses_per_revolution,
        allowed=f"pulses and speed_hz within {SAME_SPEED:.0%} of each other",
    )
