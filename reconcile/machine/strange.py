"""What modulates the teeth and is of no known part: the answer where nothing sure speaks for another one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Protocol

from reconcile.gate.findings import Kind
from reconcile.machine.own_order import own_order
from reconcile.machine.own_time import own_time
from reconcile.observe.observation import PointData
from reconcile.verdict import LineChange, NextExperiment, PlaceWeight, Report
from sim.core.spec import MachineSpec

TELLS_LITTLE = 10.0
"""Evidence of the best effect below which a set of effects, or one that is not decided, says less than this does."""
ELECTRIC: tuple[Kind, ...] = ("mains_hum", "fixed_tones")


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
        """The end of a sentence."""

    @property
    def would_tell(self) -> NextExperiment:
        """What would decide."""

    def sites(self, machine: MachineSpec) -> tuple[PlaceWeight, ...]:
        """Where to look first."""

    @property
    def electric(self) -> bool:
        """Whether a drive may do it, so that hum in the recording is the machine's own."""


def strange(machine: MachineSpec, data: Sequence[PointData], channels: Sequence[str]) -> Strange | None:
    """What keeps its own time, or else turns at an order of no part; None where nothing does."""
    return own_time(machine, data, channels) or own_order(machine, data, channels)


def explained_by(report: Report) -> tuple[Kind, ...]:
    """Kinds of faults that are the machine's own where what keeps its own time is the answer."""
    told = any(stage.get("name") == "own time" for stage in report.stages)
    return ELECTRIC if told and report.verdict == "unknown_physics" else ()


def with_strange(report: Report, seen: Strange | None, machine: MachineSpec) -> Report:
    """The report, which says so: as the answer where nothing sure speaks for another one, else beside it."""
    if seen is None:
        return report
    electric = seen.electric and report.fault is not None and report.fault.kind in ELECTRIC
    lines = (*seen.lines, *report.where.lines)
    report = replace(report, stages=(*report.stages, seen.stage))
    if not (_open(report) or electric):
        limits = (*report.where.limits, f"beside this, {seen.text}: {seen.beside}")
        return replace(report, where=replace(report.where, lines=lines, limits=limits))
    sentence = f"Something is missing that no known effect explains: {seen.text}. {seen.follows}"
    where = replace(report.where, lines=lines, sites=seen.sites(machine))
    causes = tuple(replace(cause, named=False) for cause in report.causes)
    return replace(
        report, verdict="unknown_physics", sentence=sentence, where=where, causes=causes, fault=None, undecidable=(),
        next_experiment=seen.would_tell, held_out=None, machine=None, force=None, faintest=(),
    )  # fmt: skip


def _open(report: Report) -> bool:
    """Whether nothing sure is said: no effect that stands out, and no law that brings the change about."""
    if report.verdict == "unknown_physics":
        return report.force is None or report.force.law is None
    weak = max((c.score for c in report.causes), default=0.0) < TELLS_LITTLE
    return report.verdict == "nothing_missing" or (report.verdict in ("ambiguous", "not_decidable") and weak)
