"""Impacts at an order that no part of the machine file has: a bearing's numbers are wrong, or a part is not in it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from reconcile.kinematics.families import Family, Ties, ties
from reconcile.kinematics.foreign import foreign_comb
from reconcile.kinematics.spec import of_machine
from reconcile.machine.direct import HEARD, impulsive, observed_as, reachable
from reconcile.machine.setting import Setting
from reconcile.verdict import NextExperiment, Report
from sim.core.errors import SpecError
from sim.core.response import Channel

QUIET = ("nothing_missing", "measurement_fault")
KINDS = {"outer": "outer race", "inner": "inner race", "ball": "balls", "cage": "cage"}
ADVICE = NextExperiment(sentence="Check the numbers of the bearings in the machine file: balls, diameters, angle.")


def with_foreign(report: Report, setting: Setting, channels: Sequence[Channel]) -> Report:
    """The report, which tells impacts at an order of no part, if a test has them and its baseline has not; where
    something strikes at a part's own lines, or nothing is missing, no one looks."""
    pairs = [d for d in setting.data if d.spectra[1] is not None]
    direct = setting.direct
    heard = direct.struck or max(direct.evidence.values(), default=0.0) >= HEARD
    if report.verdict in QUIET or not pairs or heard:
        return report
    machine = setting.machine
    try:
        tie = impulsive(ties(of_machine(machine), machine.operating.shaft if machine.operating else None))
    except SpecError:  # shafts whose speeds nothing ties together
        return report
    rolling = [f for f in tie.families if f.kind in KINDS]
    if not rolling or not reachable(pairs, tie):
        return report
    for k, one in enumerate(pairs, 1):
        now, then = one.spectra
        rested = [observed_as(then, f"baseline {k}", channels, tie)] if then is not None else []
        found = foreign_comb(observed_as(now, f"test {k}", channels, tie), rested, tie, setting.seed, sums=False)
        if found is not None:
            return _told(report, found.order, found.growth_db, tie, rolling)
    return report


def _told(report: Report, order: float, growth_db: float, tie: Ties, rolling: Sequence[Family]) -> Report:
    near = min(rolling, key=lambda f: abs(f.order / order - 1.0))
    text = (
        f"impacts come {order:.4g} times a turn of {tie.reference}, {growth_db:.0f} dB deeper than in the baseline, "
        f"where no part of the machine file has a line (nearest: {KINDS[near.kind]} of {near.site}, {near.order:.4g}): "
        "its numbers may be those of another bearing, or a part may be missing"
    )
    advice = report.next_experiment or ADVICE
    if report.next_experiment is not None:
        advice = replace(advice, sentence=f"{ADVICE.sentence} {advice.sentence}")
    return replace(
        report,
        sentence=f"{report.sentence} But {text}.",
        undecidable=(*report.undecidable, text),
        next_experiment=advice,
    )
