"""Is what no known effect explains on the one channel that the sensor gate suspects?

A sensor that was mounted anew has another transfer. Its levels are put back as far as they changed alike at all
speeds, its phases against the other sensors cannot be. What looks like a loose sensor may be the machine, so the
channel stays; but where the answer would be physics that nobody knows, the other channels are asked alone.
"""

from __future__ import annotations

from dataclasses import replace

from reconcile.gate.findings import Gate, Kind, worst
from reconcile.gate.spoiled import fault_sentence, without_spoiled
from reconcile.verdict import Report

LOOSE: Kind = "loose_sensor"
ALONE = " The other channels alone show nothing missing."


def without_suspected(report: Report, gate: Gate) -> Gate | None:
    """The recordings without a channel that may be loose, where nothing known explains what they show; else None.

    Also where the gate was not sure because the others changed a little in that band too: what these say alone decides.
    """
    spoiled = any(f.fault and f.kind != LOOSE for f in gate.findings)
    findings = tuple(replace(f, fault=True) if f.kind == LOOSE else f for f in gate.findings)
    if report.verdict != "unknown_physics" or spoiled:
        return None
    marked = replace(gate, findings=findings, fault=worst(findings))
    fewer = without_spoiled(marked, frozenset((LOOSE,)))
    return None if fewer is marked else fewer


def of_the_sensor(report: Report, others: Report, gate: Gate) -> Report:
    """The fault, where the `others` alone have nothing missing; else the report as it was. The gate lists no fault that
    it is not sure of, so that the machine may look like it is said here."""
    if gate.fault is None or others.verdict not in ("nothing_missing", "measurement_fault"):
        return report
    fault = replace(gate.fault, doubtful=True)
    return replace(others, verdict="measurement_fault", sentence=fault_sentence(fault) + ALONE, fault=fault)
