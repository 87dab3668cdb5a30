"""The answer where something acts many times a turn of a shaft and nothing sure speaks for another one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from reconcile.machine.many_turns import ManyTurns, many_turns
from reconcile.machine.ripple import Ripple, ripple, sidebands
from reconcile.machine.setting import Setting
from reconcile.machine.strange import is_open
from reconcile.machine.words import size, title
from reconcile.report.words import percent
from reconcile.verdict import Cause, NextExperiment, PlaceWeight, Report

LEAST_GAIN, AHEAD, MOST_OFF_DB = 0.3, 0.1, 6.0
"""Held-out gain from which a torque is the answer, how far over that of one number by which all sidebands rise, and the
most that its forecasts may be off: else machines with such a torque do not show what is seen. v018 of the proof: 0.80,
0.01 and 2.1 dB."""
STRANGERS = frozenset({"own time", "own order", "own line", "own knocks", "self-excited"})
"""Stages of what is seen besides (`machine/strange.py`): where one is the answer it stays."""
TOLD = NextExperiment(
    sentence="Compare the number with the poles, slots or jaws of the motor and its coupling, with the vanes or lobes "
    "of the load, and look for damage at as many places evenly over a turn; the drive switched off, what a motor "
    "brings is gone at once."
)


def with_many_turns(report: Report, setting: Setting, channels: Sequence[str]) -> Report:
    """The report, which names a torque ripple where that explains what acts so; beside a sure answer a remark."""
    seen = many_turns(setting.machine, setting.data, channels)
    told = None if seen is None else sidebands(setting.machine, setting.data, seen.order)
    if seen is None or told is None or not told.enough:  # over a quieter floor what was there before looks new
        return report
    answered = report.verdict == "unknown_physics" and any(s.get("name") in STRANGERS for s in report.stages)
    report = replace(report, stages=(*report.stages, seen.stage))
    lines = (*seen.lines, *report.where.lines)
    if answered or not is_open(report):
        limits = (*report.where.limits, f"beside this, {seen.text}")
        return replace(report, where=replace(report.where, lines=lines, limits=limits))
    where = replace(report.where, lines=lines, sites=(PlaceWeight(site=seen.shaft, weight=1.0),))
    report = replace(
        report, where=where, fault=None, undecidable=(), next_experiment=TOLD, machine=None, force=None, faintest=(),
        held_out=None,
    )  # fmt: skip
    found = ripple(setting, seen, told)
    return _unexplained(report, seen) if found is None or not shows(found) else _named(report, seen, found)


def shows(found: Ripple) -> bool:
    """Whether machines with such a torque show what is seen."""
    held = found.held
    return held.gain >= max(LEAST_GAIN, AHEAD + (held.black_box or 0.0)) and held.after <= MOST_OFF_DB


def _named(report: Report, seen: ManyTurns, found: Ripple) -> Report:
    label = f"{found.term.term}@{found.term.site}"
    off = percent(found.held.gain)
    gain = f"it takes {off} off the distance of sideband levels at operating points it was not fitted to"
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


def _unexplained(report: Report, seen: ManyTurns) -> Report:
    """Where no such torque can be simulated, or those that were do not show what is seen."""
    return replace(
        report, verdict="unknown_physics",
        causes=tuple(replace(c, named=False) for c in report.causes),
        sentence=f"Something is missing that no known effect explains: {seen.text}. A torque that comes so often does "
        "not show what is seen.",
    )  # fmt: skip
