"""Is what no known effect explains on the one channel that the sensor gate suspects?

A sensor that was mounted anew has another transfer. Its levels are put back as far as they changed alike at all
speeds, its phases against the other sensors cannot be. What looks like a loose sensor may be the machine, so the
channel stays; but where the answer would be physics that nobody knows, the other channels are asked alone.
"""

from __future__ import annotations

from dataclasses import replace

from reconcile.gate.findings import Gate
from reconcile.gate.spoiled import fault_sentence, without_spoiled
from reconcile.verdict import Report

ALONE = " The other channels alone show nothing missing."


def without_suspected(report: Report, gate: Gate) -> Gate | None:
    """The recordings without a channel that may be loose, where nothing known explains what they show; else None."""
    if report.verdict != "unknown_physics" or gate.fault is None or gate.fault.kind != "loose_sensor":
        return None
    fewer = without_spoiled(gate, frozenset(("loose_sensor",)))
    return None if fewer is gate else fewer


def of_the_sensor(report: Report, others: Report, gate: Gate) -> Report:
    """The fault, where the `others` alone have nothing missing; else the report as it was."""
    if gate.fault is None or others.verdict not in ("nothing_missing", "measurement_fault"):
        return report
    return replace(others, verdict="measurement_fault", sentence=fault_sentence(gate.fault) + ALONE, fault=gate.fault)
