"""The answer where no part of a bearing and no tooth stands: impacts of a turn, of no order, shaft lines, nothing."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from reconcile.kinematics.candidate import DEFECTS, Candidate
from reconcile.kinematics.faint import impulsive_report, shallow_report
from reconcile.kinematics.families import Ties
from reconcile.kinematics.foreign import BESIDE_DB, foreign_comb
from reconcile.kinematics.foreign_bands import foreign_in_a_band
from reconcile.kinematics.grown import old_defects
from reconcile.kinematics.in_step import new_blows
from reconcile.kinematics.judge import HEARD_Z, TURN_DEPTH
from reconcile.kinematics.mains import Supply, electric, electric_foreign, electric_report
from reconcile.kinematics.observe import Observation
from reconcile.kinematics.picture import comb_picture
from reconcile.kinematics.series import ShaftSeries
from reconcile.kinematics.shaft_lines import shaft_report
from reconcile.kinematics.shafts import ShaftChange, grown_impacts
from reconcile.kinematics.slow import slow_turn
from reconcile.kinematics.spec import KinematicSpec
from reconcile.kinematics.turning import (
    driven_report,
    series_report,
    slow_report,
    turn_report,
    with_driven,
    with_turn,
)
from reconcile.kinematics.vague import foreign_report, nothing_report
from reconcile.verdict import Report

STANDS_OUT_DB = 10.0
"""By which one multiple of a shaft must have grown more than the middle of many to be the answer alone."""


def without_a_part(
    known: KinematicSpec,
    tie: Ties,
    tests: list[Observation],
    baselines: list[Observation],
    every: Sequence[Candidate],
    supply: Supply,
    grown: Sequence[ShaftChange],
    seed: int,
    series: Sequence[ShaftSeries],
) -> Report:
    """Impacts of a turn, of a foreign order, of no order; shaft lines; nothing."""
    risen = [c for c in every if c.family.kind in DEFECTS and c.present and c.risen]
    if risen and baselines:
        return with_turn(shallow_report(risen, every, tests, baselines), risen, every, tie, based=True)
    heard = [*(c.family.key for c in every if c.z > HEARD_Z), *(m[0] for m in tie.meshes)]
    turns = (c for c in every if c.family.kind == "turn" and c.present and c.risen and c.depth >= TURN_DEPTH)
    turn = next(turns, None)
    if turn is not None and baselines:
        carried = [b.name for b in known.bearings if b.shaft == turn.family.site]
        stranger = foreign_comb(tests[0], baselines, tie, seed, heard=heard, least_db=BESIDE_DB)
        line = next((c for c in grown if c.multiple == 1.0 and c.shaft == turn.family.site), None)
        return turn_report(turn, tie, tests, baselines, carried, foreign=stranger, line=line)
    of_none = _of_no_part(tie, tests, baselines, every, supply, heard, seed)
    if of_none is not None:
        return of_none
    struck = new_blows(tests, baselines, tie)
    driven = None if struck is None else driven_report(*struck, tests)
    hidden = None if driven or series else _hidden(tie, tests, baselines, every, heard, seed)
    impacts = driven or hidden or _of_impacts(known, tie, tests, baselines, every, seed)
    if impacts is not None:
        return impacts
    stands_out = bool(series and grown) and grown[0].growth_db > series[0].middle_db + STANDS_OUT_DB
    if series or grown:
        return shaft_report(grown, tests) if stands_out or not series else series_report(series, grown, tests)
    report = nothing_report(every, old_defects(every), tests, baselines)
    return report if struck is None else with_driven(report, struck[0])


def _of_no_part(
    tie: Ties,
    tests: list[Observation],
    baselines: list[Observation],
    every: Sequence[Candidate],
    supply: Supply,
    heard: Sequence[str],
    seed: int,
) -> Report | None:
    """Periodic impacts that the supply makes, or at an order of no part."""
    made = electric(supply, bool(baselines))
    foreign = None if made is not None else foreign_comb(tests[0], baselines, tie, seed, heard=heard)
    made = made if foreign is None else electric_foreign(foreign, tests[0])
    pictures = {} if foreign is None else comb_picture(foreign, every, tests[0], baselines)
    if made is not None:
        return replace(electric_report(made, tests, baselines), pictures=pictures)
    return None if foreign is None else replace(foreign_report(foreign, tests, baselines), pictures=pictures)


def _hidden(
    tie: Ties,
    tests: list[Observation],
    baselines: list[Observation],
    every: Sequence[Candidate],
    heard: Sequence[str],
    seed: int,
) -> Report | None:
    """Periodic impacts at an order of no part, where the same order sounds without defect in a firmer band."""
    found = foreign_in_a_band(tests[0], baselines, tie, seed, heard=heard)
    if found is None or electric_foreign(found, tests[0]) is not None:
        return None
    pictures = comb_picture(found, every, tests[0], baselines)
    return replace(foreign_report(found, tests, baselines), pictures=pictures)


def _of_impacts(
    known: KinematicSpec,
    tie: Ties,
    tests: list[Observation],
    baselines: list[Observation],
    every: Sequence[Candidate],
    seed: int,
) -> Report | None:
    """Impacts without lines: at one angle of a shaft that turned seldom, or of a ball."""
    impacts = grown_impacts(tests, baselines)
    if impacts is None:
        return None
    slow = slow_turn(tests, impacts, tie, seed)
    if slow is not None:
        return slow_report(slow, impacts, tie, [b.name for b in known.bearings if b.shaft == slow.shaft])
    return impulsive_report(impacts, every, [b.name for b in known.bearings]) if known.bearings else None
