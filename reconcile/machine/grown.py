"""An effect that the machine file has already and that is named, or of the set told, has grown: it says from what."""

from __future__ import annotations

from dataclasses import replace

from reconcile.atlas.candidates import already, size_now, size_parameter
from reconcile.machine.words import title
from reconcile.report.markup import figure_text
from reconcile.verdict import Cause, Report
from sim.core.spec import MachineSpec
from sim.terms import REGISTRY


def with_grown(report: Report, machine: MachineSpec) -> Report:
    """The report, which says of what is named and is in the machine file already how large it is there."""
    told = []
    for cause in report.causes:
        own, term = already(machine, cause.term, cause.site), REGISTRY.get(cause.term)
        label = f"{cause.term}@{cause.site}"
        told_of = cause.named or title(label).lower() in report.sentence.lower()
        if told_of and own is not None and term is not None:
            size = size_parameter(term)
            there = figure_text(size_now(own, size), size.unit, digits=2)
            told.append(f" {title(label)} is in the machine file already, with {there}{_now(cause)}.")
    return replace(report, sentence=report.sentence + "".join(told)) if told else report


def _now(cause: Cause) -> str:
    """The size now, where no sentence says it already."""
    found = cause.severity
    if cause.named or found is None:
        return ""
    low, value, high = (figure_text(x, found.unit, digits=2) for x in (found.low, found.value, found.high))
    return f", and would have grown to {value} ({low} to {high})"
