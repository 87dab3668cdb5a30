"""A line once a turn that grew far is told where the change as a whole is usual.

At level `machine` all that changed is held against what sound machines show together, and one line among hundreds of
features weighs little: an unbalance that raises one line of a shaft and nothing else can be lost. What the drawing
alone tells of shafts (`kinematics.shafts`) is asked where nothing else was found: of fourteen sound machines of the
proof's plan `mixed` none has such a line.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from reconcile.gate import inspect_measurement
from reconcile.kinematics.families import ties
from reconcile.kinematics.observe import Observation, observe
from reconcile.kinematics.shaft_lines import shaft_report
from reconcile.kinematics.shafts import ShaftChange, shaft_changes
from reconcile.kinematics.spec import of_machine
from reconcile.report.action import EXCHANGED
from reconcile.verdict import Report
from signals.recording import Recording
from sim.core.errors import SpecError
from sim.core.spec import MachineSpec

USUAL = "though all changes together are no more than sound machines of this kind show"


def with_grown_turns(
    report: Report, machine: MachineSpec, tests: Sequence[Recording], baselines: Sequence[Recording], seed: int
) -> Report:
    """The report; where nothing is missing and a multiple of a shaft grew far on most channels and at most speeds, not
    decidable, with the line."""
    asked = report.verdict == "nothing_missing" and report.level == "machine" and report.fault is None
    if not asked or not baselines or machine.operating is None or EXCHANGED in report.sentence:
        return report
    if not _grown(machine, tests, baselines, seed)[0]:
        return report
    gate = inspect_measurement(baselines, tests, seed=seed)  # hum may stand where a shaft has a line
    grown, seen = _grown(machine, gate.tests, gate.baselines, seed)
    if not grown or gate.fault is not None:
        return report
    told = shaft_report(grown, seen)
    said, _, kinds = told.sentence.partition("): ")
    return replace(
        report,
        verdict="not_decidable",
        sentence=f"{said}), {USUAL}: {kinds.replace('at this level', 'here')}",
        where=replace(report.where, sites=told.where.sites, lines=told.where.lines),
        causes=told.causes,
        undecidable=(*report.undecidable, *told.undecidable),
        next_experiment=told.next_experiment,
    )


def _grown(
    machine: MachineSpec, tests: Sequence[Recording], baselines: Sequence[Recording], seed: int
) -> tuple[list[ShaftChange], list[Observation]]:
    """Lines of shafts that grew, and the tests as observed; none where they cannot be observed so."""
    assert machine.operating is not None
    try:
        tie = ties(of_machine(machine), machine.operating.shaft)
        seen, past = (
            [observe(one, tie, f"{kind} {i}", stated_hz=None, seed=seed) for i, one in enumerate(several, 1)]
            for kind, several in (("test", tests), ("baseline", baselines))
        )
    except SpecError:
        return [], []
    return [c for c in shaft_changes(seen, past, tie) if c.grown], seen
