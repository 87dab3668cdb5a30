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
"""Evidence of the best effect below which a set of effects says less than this does."""
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
    weak = report.verdict == "ambiguous" and max((c.score for c in report.causes), default=0.0) < TELLS_LITTLE
    lines = (*seen.lines, *report.where.lines)
    report = replace(report, stages=(*report.stages, seen.stage))
    if not (report.verdict in ("nothing_missing", "not_decidable", "unknown_physics") or electric or weak):
        limits = (*report.where.limits, f"beside this, {seen.text}: {seen.beside}")
        return replace(report, where=replace(report.where, lines=lines, limits=limits))
    sentence = f"Something is missing that no known effect explains: {seen.text}. {seen.follows}"
    where = replace(report.where, lines=lines, sites=_sites(machine))
    causes = tuple(replace(cause, named=False) for cause in report.causes)
    return replace(
        report, verdict="unknown_physics", sentence=sentence, where=where, causes=causes, fault=None, undecidable=(),
        next_experiment=seen.would_tell, held_out=None, machine=None, force=None, faintest=(),
    )  # fmt: skip


def _sites(machine: MachineSpec) -> tuple[PlaceWeight, ...]:
    """The driven shaft, by which a drive acts, before the gears, at which something may pull."""
    shaft = machine.operating.shaft if machine.operating is not None else machine.shafts[0].name
    share = 0.5 / max(1, len(machine.gears))
    return (
        PlaceWeight(site=shaft, weight=0.5),
        *(PlaceWeight(site=gear.name, weight=share) for gear in machine.gears),
    )
