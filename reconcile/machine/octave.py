"""Did the machine turn at half or twice the stated speed? The teeth tell: all that the model predicts hangs on it.

At twice the stated speed every mesh line of the model but the even ones is missing; at half of it there are lines half
way between them. Meshes of other stages may make such lines: what a shaft's own teeth explain is left out. So may a
gear that has changed (play, wear of pairs that meet every other time): a baseline that shows the teeth where they were
stated has settled the speed.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from reconcile.gate.findings import Gate
from reconcile.gate.spoiled import doubts
from reconcile.machine.stages import gate_stage
from reconcile.observe.observation import PointData
from reconcile.observe.steady import Steady
from reconcile.observe.watch import bases_at
from reconcile.speed import line_logs
from reconcile.speed.octave import octave_rival
from reconcile.verdict import NextExperiment, Report, Where
from sim.core.response import Channel
from sim.core.spec import MachineSpec

MESH_HARMONICS = tuple(float(k) for k in range(1, 9))
TRUSTED = 0.42
"""Share of the sampling rate up to which lines are heard."""
ALIKE = 0.02
"""Relative difference within which two mesh frequencies, or halves and doubles of them, are one."""


def rival_speed(machine: MachineSpec, data: Sequence[PointData], channels: Sequence[Channel]) -> float | None:
    """0.5 or 2 where that times the stated speed explains the lines of the teeth as well in most of the tests without
    a tacho, and in their baselines; None where the stated speed holds, or teeth cannot tell."""
    found = [factor for d in data if (factor := _of_point(machine, d, channels)) is not None]
    if not found or 2 * found.count(found[0]) <= len(data):
        return None
    return found[0]


def _of_point(machine: MachineSpec, point: PointData, channels: Sequence[Channel]) -> float | None:
    heard = [s for s in point.spectra if s is not None]
    if any(s.estimate.method == "tacho" for s in heard):
        return None
    factor = _factor(machine, heard[0], channels)
    return factor if factor is None or all(_factor(machine, s, channels) == factor for s in heard[1:]) else None


def _factor(machine: MachineSpec, one: Steady, channels: Sequence[Channel]) -> float | None:
    meshes = [hz for name, hz in bases_at(machine, one.speed_hz).items() if name.startswith("f_m")]
    alone = [m for m in meshes if not any(o != m and _octaves(o, m) for o in meshes)]
    combs = line_logs(one.recording(channels))
    rivals = []
    for mesh_hz in alone:
        heard = [k for k in MESH_HARMONICS if k * mesh_hz < TRUSTED * one.rate_hz]
        rival = octave_rival(combs, mesh_hz, heard, ()) if heard else None
        rivals.append(None if rival is None else rival / mesh_hz)
    return rivals[0] if rivals and all(r == rivals[0] for r in rivals) else None


def _octaves(one_hz: float, other_hz: float) -> bool:
    return any(abs(one_hz * factor / other_hz - 1.0) < ALIKE for factor in (0.5, 1.0, 1.5, 2.0, 3.0))


def doubted_speed(factor: float, data: Sequence[PointData], gate: Gate, provenance: Mapping[str, object]) -> Report:
    """The report where the speed is not known: what the sensor gate found, and nothing else."""
    stated = data[0].point.speed_hz
    word = "twice" if factor == 2.0 else "half"
    lines = (
        "only every other harmonic of the teeth is there"
        if factor == 2.0
        else "lines stand half way between the harmonics of the teeth"
    )
    return Report(
        verdict="not_decidable",
        sentence=f"The speed is not decided: stated are {stated:g} Hz, but {lines}, as at {word} of it "
        f"({factor * stated:g} Hz). All that the model predicts hangs on the speed.",
        level="machine",
        where=Where(limits=doubts(gate)),
        undecidable=(f"whether the shaft turns at {stated:g} Hz as stated or at {factor * stated:g} Hz",),
        next_experiment=NextExperiment(sentence="Record with a tacho, or check the speed that was stated."),
        stages=(
            gate_stage(gate),
            {"name": "observe", "speeds": [f"{d.point.speed_hz:g} Hz stated" for d in data]},
        ),
        provenance=provenance,
    )
