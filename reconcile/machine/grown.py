"""An effect that the machine file has already and that is named has grown: the report says from what."""

from __future__ import annotations

from dataclasses import replace

from reconcile.atlas.candidates import already, size_now, size_parameter
from reconcile.machine.words import title
from reconcile.report.markup import figure_text
from reconcile.verdict import Report
from sim.core.spec import MachineSpec
from sim.terms import REGISTRY


def with_grown(report: Report, machine: MachineSpec) -> Report:
    """The report, which says of what is named and is in the machine file already how large it is there."""
    told = []
    for cause in report.causes:
        own, term = already(machine, cause.term, cause.site), REGISTRY.get(cause.term)
        if cause.named and own is not None and term is not None:
            size = size_parameter(term)
            there = figure_text(size_now(own, size), size.unit, digits=2)
            told.append(f" {title(f'{cause.term}@{cause.site}')} is in the machine file already, with {there}.")
    return replace(report, sentence=report.sentence + "".join(told)) if told else report
