"""Operating points in terms of the driven shaft: what a recording says of another shaft is converted by the meshes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from scipy.interpolate import PchipInterpolator

from reconcile.pulses import STATED, contradiction
from signals.recording import Operating, Recording, Tacho
from sim.assembly.kinematics import kinematics
from sim.core.errors import Problem, SpecError
from sim.core.spec import MachineSpec

LEAST_PULSES = 3
"""Of which a speed can be read."""


def on_drive(machine: MachineSpec, recordings: Sequence[Recording]) -> tuple[Recording, ...]:
    """The recordings with speed, torque and pulses of the machine's own driven shaft.

    SpecError where a shaft is none of the machine's, or pulses contradict the stated speed.
    """
    if machine.operating is None:
        return tuple(recordings)
    drive, speeds = machine.operating.shaft, {k: abs(hz) for k, hz in kinematics(machine).shaft_hz.items()}
    stated = [_stated(r, drive, speeds) for r in recordings]
    checked = ((_of_pulses(now, drive, speeds), said) for now, said in zip(stated, map(_said, recordings), strict=True))
    problems = [p for r, said in checked if (p := contradiction(r, _field(r), said=said)) is not None]
    if problems:
        raise SpecError(problems)
    return tuple(_counted(r, drive, speeds) for r in stated)


def _stated(recording: Recording, drive: str, speeds: Mapping[str, float]) -> Recording:
    """Speed and torque of the driven shaft."""
    operating, tacho = recording.operating, recording.tacho
    for field, shaft in (
        ("operating.shaft", drive if operating is None else operating.shaft),
        ("tacho.shaft", drive if tacho is None else tacho.shaft),
    ):
        if shaft not in speeds:
            where = f"{recording.label}: {field}" if recording.label else field
            raise SpecError(Problem(field=where, message="is no shaft", given=shaft, allowed=", ".join(speeds)))
    if operating is None or operating.shaft == drive:
        return recording
    ratio = speeds[drive] / speeds[operating.shaft]
    torque = None if operating.torque_nm is None else operating.torque_nm / ratio
    return replace(
        recording, operating=replace(operating, shaft=drive, speed_hz=operating.speed_hz * ratio, torque_nm=torque)
    )


def _of_pulses(recording: Recording, drive: str, speeds: Mapping[str, float]) -> Recording:
    """The recording with the speed that its pulses should show: that of their own shaft."""
    operating, tacho = recording.operating, recording.tacho
    if operating is None or tacho is None or tacho.shaft == drive:
        return recording
    own = Operating(shaft=tacho.shaft, speed_hz=operating.speed_hz * speeds[tacho.shaft] / speeds[drive])
    return replace(recording, operating=own)


def _said(recording: Recording) -> str:
    """Who says the speed of the pulses' shaft: the recording, if it states that shaft's, else what goes with it."""
    operating, tacho = recording.operating, recording.tacho
    if operating is None or tacho is None or operating.shaft == tacho.shaft:
        return STATED
    return f"of {tacho.shaft} go with the {operating.speed_hz:.4g} Hz stated of {operating.shaft}"


def _counted(recording: Recording, drive: str, speeds: Mapping[str, float]) -> Recording:
    """The recording with pulses of the driven shaft, about as many as those of another."""
    tacho = recording.tacho
    if tacho is None or tacho.shaft == drive:
        return recording
    times = np.asarray(tacho.pulse_times_s, dtype=np.float64)
    if times.size < LEAST_PULSES or not np.all(np.diff(times) > 0.0):
        return recording  # told where the pulses are read
    turns = np.arange(times.size) / tacho.pulses_per_revolution * speeds[drive] / speeds[tacho.shaft]
    each = max(1, round((times.size - 1) / turns[-1]))
    whole = np.arange(np.floor(turns[-1] * each + 1e-9) + 1) / each
    again = Tacho(shaft=drive, pulse_times_s=PchipInterpolator(turns, times)(whole), pulses_per_revolution=each)
    return replace(recording, tacho=again)


def _field(recording: Recording) -> str:
    return f"{recording.label}: tacho.pulses_per_revolution" if recording.label else "tacho.pulses_per_revolution"
