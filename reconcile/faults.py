"""Faults of the measurement beside an answer about the machine: all in a list, those that are sure in the sentence."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from reconcile.gate.findings import FAULTS, Finding, Gate, Kind
from reconcile.gate.spoiled import HEARD
from reconcile.report.mending import channels
from reconcile.verdict import Report, SensorFault

MOST_NAMED = 3
"""Faults that a sentence names; the list has all."""


def measurement_faults(gate: Gate) -> tuple[SensorFault, ...]:
    """Every fault that the gate found, one a kind and channel, those that spoil most first."""
    groups: dict[tuple[str, str], list[Finding]] = {}
    for one in (f for f in gate.findings if f.fault):
        groups.setdefault((one.kind, one.channel), []).append(one)
    worst = [max(same, key=lambda f: f.severity) for same in groups.values()]
    order = sorted(range(len(worst)), key=lambda i: (FAULTS.index(worst[i].kind), -worst[i].severity))
    heard = gate.tests[0].names if gate.tests else ()
    every = list(groups.values())
    return tuple(
        SensorFault(
            kind=worst[i].kind,
            channel=worst[i].channel,
            detail=worst[i].detail + (f"; {worst[i].where}" if worst[i].where else ""),
            recordings=tuple(dict.fromkeys(f.recording for f in every[i])),
            left_out=bool(worst[i].channel) and gate.usable and worst[i].channel not in (*heard, "tacho"),
            doubtful=worst[i].kind in HEARD,
        )
        for i in order
    )


def with_faults(report: Report, found: Sequence[SensorFault], explained: Sequence[Kind] = ()) -> Report:
    """The report with the faults `found`, without kinds that the answer itself explains.

    A verdict of `measurement_fault` keeps its `fault`, which then leads the list; other sure ones follow in the
    sentence, so that no channel of them is overlooked. Beside any other verdict the first that is sure is `fault` and
    the sure ones stand in the sentence; what the machine itself may do is undecidable beside any.
    """
    kept = tuple(f for f in found if f.kind not in explained)
    if report.verdict == "measurement_fault":
        return _of_the_measurement(report, kept)
    if not kept:
        return report
    sure, open_ones = [f for f in kept if not f.doubtful], _open(kept)
    sentence = f"{report.sentence} {_told('Beside it the measurement is at fault', sure)}" if sure else report.sentence
    return replace(
        report,
        sentence=sentence,
        fault=sure[0] if sure else None,
        measurement_faults=kept,
        undecidable=(*report.undecidable, *open_ones),
    )


def _of_the_measurement(report: Report, kept: tuple[SensorFault, ...]) -> Report:
    """The fault as it stands in the list, which it leads where it is not in it."""
    first = report.fault
    listed = next((f for f in kept if first and (f.kind, f.channel) == (first.kind, first.channel)), None)
    if first is None:
        return replace(report, measurement_faults=kept)
    sentence = f"{report.sentence}{_too(first, kept)}"
    if listed is None:
        return replace(report, sentence=sentence, measurement_faults=(first, *kept))
    told = replace(
        first,
        doubtful=first.doubtful or listed.doubtful,
        left_out=first.left_out or listed.left_out,
        recordings=first.recordings or listed.recordings,
    )
    open_ones = (*report.undecidable, *_open(kept))
    return replace(report, sentence=sentence, fault=told, measurement_faults=kept, undecidable=open_ones)


def _open(faults: Sequence[SensorFault]) -> tuple[str, ...]:
    """Of each that the machine itself may do."""
    doubtful = [f for f in faults if f.doubtful]
    return tuple(f"whether {_words(f)} is the sensor's or the machine's own, which may do the same" for f in doubtful)


def _words(fault: SensorFault) -> str:
    """`clipped on de`."""
    return fault.kind.replace("_", " ") + (f" on {fault.channel}" if fault.channel else "")


def _too(first: SensorFault, kept: Sequence[SensorFault]) -> str:
    """Sure faults that the answer's own does not tell: of other channels, whatever their kind, or of all of them."""
    others = [
        f
        for f in kept
        if not f.doubtful and (f.kind, f.channel) != (first.kind, first.channel) and f.channel not in channels(first)
    ]
    return f" {_told('At fault too', others)}" if others else ""


def _told(lead: str, sure: Sequence[SensorFault]) -> str:
    told = list(dict.fromkeys(_words(f) + (" (left out)" if f.left_out else "") for f in sure))
    named = told[:MOST_NAMED]
    if len(told) > MOST_NAMED:
        named.append(f"{len(told) - MOST_NAMED} more")
    return f"{lead}: {', '.join(named)}."
