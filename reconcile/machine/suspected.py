"""Is what no known effect explains on the one channel that the sensor gate suspects?

A sensor that was mounted anew has another transfer. Its levels are put back as far as they changed alike at all
speeds, its phases against the other sensors cannot be. What looks like a loose sensor may be the machine, so the
channel stays; but where the answer would be physics that nobody knows, the other channels are asked alone. Where the
answer would be that nothing is missing, that changed transfer is what is.
"""

from __future__ import annotations

from dataclasses import replace

from reconcile.gate.findings import Finding, Gate, Kind, worst
from reconcile.gate.loose import LEAST_SPEEDS
from reconcile.gate.spoiled import fault_sentence, without_spoiled
from reconcile.verdict import Report

LOOSE: Kind = "loose_sensor"
ALONE = " The other channels alone show nothing missing."
BESIDES = " Nothing else is missing."
LARGE_DB = 10.0
"""Change of transfer that counts by itself at fewer than `LEAST_SPEEDS` operating points: of the proof's plans one of
the sound machines there seemed to have one, of 7.5 dB; loose sensors have 11 to 17."""


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


def of_a_sound_machine(report: Report, gate: Gate) -> Report:
    """The sensor that looks loose, where else nothing is missing. At one operating point candidates hardly see it: of
    ten such sensors of the proof's plans eight were answered so."""
    least = LARGE_DB if len(gate.tests) < LEAST_SPEEDS else 0.0
    fault = worst(tuple(f for f in gate.findings if f.kind == LOOSE and _size_db(f) >= least))
    if report.verdict != "nothing_missing" or fault is None:
        return report
    return replace(
        report,
        verdict="measurement_fault",
        sentence=fault_sentence(fault) + BESIDES,
        fault=replace(fault, doubtful=True),
    )


def _size_db(found: Finding) -> float:
    """By how much the transfer changed at most."""
    return max((abs(db) for _, db in found.transfer_db), default=0.0)
