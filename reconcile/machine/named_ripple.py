"""The answer where something acts many times a turn of a shaft and nothing sure speaks for another one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from reconcile.machine.many_turns import ManyTurns, many_turns
from reconcile.machine.ripple import Ripple, ripple
from reconcile.machine.setting import Setting
from reconcile.machine.strange import is_open
from reconcile.machine.words import size, title
from reconcile.report.words import percent
from reconcile.verdict import Cause, NextExperiment, PlaceWeight, Report

LEAST_GAIN = 0.2
"""Held-out gain from which a torque is the answer: less, and machines of the kind with one do not show what is seen."""
TOLD = NextExperiment(
    sentence="Compare the number with the poles, slots or jaws of the motor and its coupling and with the vanes or "
    "lobes of the load; the drive switched off, what a motor brings is gone at once."
)
NOT_SIZED = "how large a torque would be, as too few sidebands tell it"


def with_many_turns(report: Report, setting: Setting, channels: Sequence[str]) -> Report:
    """The report, which names a torque ripple where that explains what acts so; beside a sure answer a remark."""
    seen = many_turns(setting.machine, setting.data, channels)
    if seen is None:
        return report
    report = replace(report, stages=(*report.stages, seen.stage))
    lines = (*seen.lines, *report.where.lines)
    if not is_open(report):
        limits = (*report.where.limits, f"beside this, {seen.text}")
        return replace(report, where=replace(report.where, lines=lines, limits=limits))
    where = replace(report.where, lines=lines, sites=(PlaceWeight(site=seen.shaft, weight=1.0),))
    report = replace(
        report, where=where, fault=None, undecidable=(), next_experiment=TOLD, machine=None, force=None, faintest=(),
        held_out=None,
    )  # fmt: skip
    found = ripple(setting, seen)
    if found is None or found.held.gain < LEAST_GAIN:
        return _unexplained(report, seen, found)
    return _named(report, seen, found)


def _named(report: Report, seen: ManyTurns, found: Ripple) -> Report:
    label = f"{found.term.term}@{found.term.site}"
    gain = f"it takes {percent(found.held.gain)} off the distance of sideband levels at speeds it was not fitted to"
    values = {name: float(value) for name, value in found.term.parameters.items() if name == "order"}
    cause = Cause(
        term=found.term.term, site=found.term.site, score=found.score, severity=found.severity, named=True,
        values=values,
    )  # fmt: skip
    others = (c for c in report.causes if f"{c.term}@{c.site}" != label)
    causes = (cause, *(replace(c, named=False) for c in others))
    return replace(
        report, verdict="explained", causes=causes, machine=found.machine.model_dump(mode="json"),
        sentence=f"{title(label)}{size(found.severity)}, {seen.turns} times a turn: {seen.text}; {gain}.",
        held_out=replace(found.held, effects=(label,)),
    )  # fmt: skip


def _unexplained(report: Report, seen: ManyTurns, found: Ripple | None) -> Report:
    """Where no such torque can be simulated, or those that were do not show what is seen."""
    undecided = (NOT_SIZED,) if found is None else ()
    return replace(
        report, verdict="unknown_physics", undecidable=undecided,
        causes=tuple(replace(c, named=False) for c in report.causes),
        sentence=f"Something is missing that no known effect explains: {seen.text}.",
    )  # fmt: skip
