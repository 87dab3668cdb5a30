"""What modulates the teeth and is of no known part: the answer where nothing sure speaks for another one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Protocol

from reconcile.gate.findings import Finding, Kind
from reconcile.machine.direct import HEARD
from reconcile.machine.own_knocks import own_knocks
from reconcile.machine.own_line import own_line
from reconcile.machine.own_order import OwnOrder, own_order
from reconcile.machine.own_time import OwnTime, own_time
from reconcile.machine.proved import BEYOND_DOUBT
from reconcile.machine.second import strikes
from reconcile.machine.self_excited import self_excited
from reconcile.observe.observation import PointData
from reconcile.report.revised import comes_no_nearer
from reconcile.verdict import Cause, LineChange, NextExperiment, PlaceWeight, Report
from sim.core.response import Channel
from sim.core.spec import MachineSpec

TELLS_LITTLE = 10.0
"""Evidence of the best effect below which a set of effects, or one that is not decided, says less than this does."""
HARDLY, SHORT, CLEARLY_DB = 0.1, 0.05, 5.0
"""What is seen at an order or a frequency of no known part, with a rise of 5 dB, goes before names and sets of less log
evidence than `BEYOND_DOUBT` that strike nowhere: a name with a held-out gain below a tenth that its placebos reach, and
a set whose placebos gain 0.05 more; or a name whose revised machine, simulated, leaves the whole change of levels. A
pull of 100 Hz with 6 dB where nothing else rose by 0.4 (c046 of the proof) stood beside an angle at a coupling of
evidence 10.4 that forecast 0.053, its placebos 0.057; a torque of 100 Hz at one speed with 22 dB (c067) beside wavy
races of two bearings of 11, 0.27 and 0.33; a belt (tw039) with 8.5 dB beside a torque and a run-out of 14 that forecast
0.005 and left 1.75 of 1.75 dB. Known from these three."""
ELECTRIC: tuple[Kind, ...] = ("mains_hum", "fixed_tones")
OWN: Mapping[str, tuple[Kind, ...]] = {
    "own time": ELECTRIC, "self-excited": ELECTRIC, "own knocks": ("fixed_tones",)
}  # fmt: skip
"""By the name of the stage: knocks at a steady rate are lines at fixed frequencies too."""


class Strange(Protocol):
    """Something seen, in words: `text` with what it `follows`, or `beside` another answer."""

    @property
    def text(self) -> str:
        """What is seen."""

    @property
    def stage(self) -> Mapping[str, object]:
        """For the report."""

    @property
    def lines(self) -> tuple[LineChange, ...]:
        """That have risen."""

    @property
    def follows(self) -> str:
        """A sentence."""

    @property
    def beside(self) -> str:
        """The end of a sentence; empty for what is said only as the answer."""

    @property
    def would_tell(self) -> NextExperiment:
        """What would decide."""

    def sites(self, machine: MachineSpec) -> tuple[PlaceWeight, ...]:
        """Where to look first."""

    @property
    def electric(self) -> bool:
        """Whether a drive may do it, so that hum in the recording is the machine's own."""

    @property
    def undecided(self) -> tuple[str, ...]:
        """What else would look so."""

    @property
    def strikes(self) -> bool:
        """Whether it strikes, so that a part named as pitted must be heard at its own lines."""


def strange(
    machine: MachineSpec, data: Sequence[PointData], channels: Sequence[Channel], findings: Sequence[Finding]
) -> Strange | None:
    """What the machine does by itself, what keeps its own time, knocks or else turns at an order of no part, or a
    strong line that no part makes; None where there is nothing. `findings`: of the gate."""
    names = [c.name for c in channels]
    return (
        self_excited(machine, findings, channels)
        or own_time(machine, data, names)
        or own_knocks(data, channels)
        or own_order(machine, data, names)
        or own_line(machine, data, channels)
    )


def explained_by(report: Report) -> tuple[Kind, ...]:
    """Kinds of faults that are the machine's own where what keeps its own time is the answer."""
    if report.verdict != "unknown_physics":
        return ()
    return next((OWN[name] for stage in report.stages if (name := str(stage.get("name"))) in OWN), ())


def with_strange(report: Report, seen: Strange | None, machine: MachineSpec, heard: Mapping[str, float]) -> Report:
    """The report, which says so: as the answer where nothing sure speaks for another one, else beside it.

    `heard`: log evidence of impacts at the own lines of effects that strike.
    """
    if seen is None:
        return report
    electric = seen.electric and report.fault is not None and report.fault.kind in ELECTRIC
    answers = is_open(report) or electric or _hardly_named(report, seen, heard)
    answers = answers or (seen.strikes and _struck_unheard(report, heard))
    if not (answers or seen.beside):
        return report
    lines = (*seen.lines, *report.where.lines)
    report = replace(report, stages=(*report.stages, seen.stage))
    if not answers:
        limits = (*report.where.limits, f"beside this, {seen.text}: {seen.beside}")
        return replace(report, where=replace(report.where, lines=lines, limits=limits))
    sentence = f"Something is missing that no known effect explains: {seen.text}. {seen.follows}"
    where = replace(report.where, lines=lines, sites=seen.sites(machine))
    causes = tuple(replace(cause, named=False) for cause in report.causes)
    return replace(
        report, verdict="unknown_physics", sentence=sentence, where=where, causes=causes, fault=None,
        undecidable=seen.undecided,
        next_experiment=seen.would_tell, held_out=None, machine=None, force=None, faintest=(),
    )  # fmt: skip


def _hardly_named(report: Report, seen: Strange, heard: Mapping[str, float]) -> bool:
    """Whether what is named, or may be, strikes nowhere, is not beyond doubt and forecasts no more than its placebos
    do, or comes no nearer in level, beside what stands out clearly."""
    held = report.held_out
    if not isinstance(seen, OwnTime | OwnOrder) or seen.rise_db < CLEARLY_DB or held is None or held.placebo is None:
        return False
    told = _told(report)
    if any(c.score >= BEYOND_DOUBT or heard.get(f"{c.term}@{c.site}", 0.0) >= HEARD for c in told):
        return False
    if report.verdict == "explained":
        return held.gain < HARDLY and (held.placebo >= held.gain or comes_no_nearer(report))
    return report.verdict == "ambiguous" and held.gain > 0.0 and held.placebo >= held.gain + SHORT


def _told(report: Report) -> list[Cause]:
    """What is named, or nearly as likely in a set."""
    best = max((c.score for c in report.causes), default=0.0)
    return [c for c in report.causes if c.named or (report.verdict == "ambiguous" and c.score > best - TELLS_LITTLE)]


def _struck_unheard(report: Report, heard: Mapping[str, float]) -> bool:
    """Whether all that is named, or may be, are parts that would strike and are not heard at lines of their own."""
    told = _told(report)
    return bool(told) and all(strikes(c.term) and heard.get(f"{c.term}@{c.site}", 0.0) < HEARD for c in told)


def is_open(report: Report) -> bool:
    """Whether nothing sure is said: no effect that stands out, and no law that brings the change about."""
    if report.verdict == "unknown_physics":
        return report.force is None or report.force.law is None
    weak = max((c.score for c in report.causes), default=0.0) < TELLS_LITTLE
    return report.verdict == "nothing_missing" or (report.verdict in ("ambiguous", "not_decidable") and weak)
