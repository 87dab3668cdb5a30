"""Stages and pictures of a report, and the reports of recordings that carry none."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from reconcile.faults import measurement_faults, with_faults
from reconcile.gate import Gate
from reconcile.gate.spoiled import GONE, doubts, fault_sentence, remarks
from reconcile.kinematics.candidate import Candidate
from reconcile.kinematics.labels import label_faults
from reconcile.kinematics.observe import Observation
from reconcile.kinematics.picture import envelope_picture
from reconcile.kinematics.slowest import short_limits, without_short
from reconcile.report.action import EXCHANGED
from reconcile.report.score import DEVIATIONS
from reconcile.verdict import NOT_JUDGED, NextExperiment, Report
from sim.core.errors import SpecError

AS_LOUD = "loose_sensor"
"""What is told of a sensor by how loud its bands are against the baseline's: of one that has a defect it tells nothing.
"""
SCORE_UNITS = {"nats": DEVIATIONS}
"""Scores here are robust deviations unless a report says what else they are."""


def finished(
    report: Report,
    gate: Gate,
    tests: Sequence[Observation],
    every: Sequence[Candidate],
    baselines: Sequence[Observation] = (),
) -> Report:
    """The report with its stages and pictures."""
    seen = gate
    if EXCHANGED in report.sentence and report.verdict != "measurement_fault":
        gate = replace(gate, findings=tuple(f for f in gate.findings if f.kind != AS_LOUD))
    stages: list[Mapping[str, object]] = [
        {"name": "gate", "findings": [f"{f.recording} {f.channel}: {f.kind}, {f.detail}" for f in seen.findings]},
        {
            "name": "speed",
            "found": {
                o.label: {
                    "speed_hz": o.speed.speed_hz,
                    "low_hz": o.speed.low_hz,
                    "high_hz": o.speed.high_hz,
                    "method": o.speed.method,
                    "confidence": o.speed.confidence,
                    "rival_hz": o.speed.rival_hz,
                }
                for o in (*tests, *baselines)
            },
        },
        {"name": "families", "table": [_row(c) for c in every]},
    ]
    if report.verdict != "measurement_fault":
        said = (*remarks(without_short(gate)), *doubts(gate), *short_limits(gate, report))
        report = replace(report, where=replace(report.where, limits=(*report.where.limits, *said)))
    pictures = report.pictures or envelope_picture(every, report.causes, tests, baselines)
    causes = tuple(replace(c, score_unit=SCORE_UNITS.get(c.score_unit, c.score_unit)) for c in report.causes)
    report = replace(report, causes=causes, stages=tuple(stages), pictures=pictures)
    return with_faults(report, (*measurement_faults(gate), *label_faults(report, (*tests, *baselines))))


def _row(c: Candidate) -> dict[str, object]:
    return {
        "family": c.family.key,
        "order": c.best.order,
        "z": c.z,
        "chance": c.chance,
        "channel": c.best.channel,
        "heard": c.best.channel_z,
        "band_hz": list(c.best.band_hz),
        "depth": c.contrasts[c.strongest].depth,
        "growth_db": c.growth_db,
        "present": c.present,
        "risen": c.risen,
    }


def fault_report(gate: Gate, rest: Report | None = None) -> Report:
    """The measurement is at fault; `rest`: what the recordings say apart from that, where they can be judged."""
    assert gate.fault is not None
    said = fault_sentence(gate.fault)
    if rest is None:
        return Report(
            verdict="measurement_fault", sentence=said, level="kinematics", fault=gate.fault, undecidable=NOT_JUDGED
        )
    if rest.verdict == "nothing_missing":
        deaf = _left_out(gate)
        what = f"what {' and '.join(deaf)} would hear is not judged" if deaf else ""
        said = f"{said} Apart from it these kinematics show nothing missing{f', but {what}' if deaf else ''}."
        open_ones = (what,) if deaf else ()
        return Report(
            verdict="measurement_fault", sentence=said, level="kinematics", fault=gate.fault, undecidable=open_ones
        )
    said = f"{said} Apart from it: {rest.sentence}"
    return replace(rest, verdict="measurement_fault", sentence=said, fault=gate.fault)


def _left_out(gate: Gate) -> list[str]:
    """Channels that were away, so that the rest alone was heard."""
    gone = (f.channel for f in gate.findings if f.fault and f.kind in GONE)
    return sorted({name for name in gone if name and name not in gate.tests[0].names})


def refused_report(error: SpecError, longer: NextExperiment | None) -> Report:
    """The recordings can't carry the kinematics; `longer`: how long those must be that are too short."""
    return Report(
        verdict="not_decidable",
        sentence=f"The recordings can't carry these kinematics: {error}.",
        level="kinematics",
        undecidable=tuple(str(p) for p in error.problems),
        next_experiment=longer,
    )
