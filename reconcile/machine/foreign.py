"""Impacts at an order that no part of the machine file has: a bearing's numbers are wrong, or a part is not in it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from reconcile.kinematics.evidence import family_evidence
from reconcile.kinematics.families import Family, Ties, ties
from reconcile.kinematics.foreign import LEAST_Z, Foreign, foreign_comb
from reconcile.kinematics.judge import candidates
from reconcile.kinematics.observe import Observation
from reconcile.kinematics.spec import of_machine
from reconcile.machine.direct import HEARD, impulsive, observed_as, reachable
from reconcile.machine.setting import Setting
from reconcile.observe.observation import PointData
from reconcile.report.action import NO_PART
from reconcile.verdict import NextExperiment, Report
from sim.core.errors import SpecError
from sim.core.response import Channel

QUIET = ("nothing_missing", "measurement_fault")
KINDS = {"outer": "outer race", "inner": "inner race", "ball": "balls", "cage": "cage"}
SAME = 0.01
"""Of its order, within which a comb is the same at another speed: twice the slip it may have changed by."""
OLD_Z = 0.5 * LEAST_Z
"""Deviations from which a baseline has the comb too, at the same frequency in Hz: another machine's."""
NEAR = 0.3
"""Of the order, within which a part's line is worth naming beside it."""
ADVICE = NextExperiment(sentence="Check the numbers of the bearings in the machine file: balls, diameters, angle.")


def with_foreign(report: Report, setting: Setting, channels: Sequence[Channel]) -> Report:
    """The report, which tells impacts at an order of no part, if more than half of the tests have them, all at one
    order, and no baseline has; where something strikes at a part's own lines, or nothing is missing, no one looks."""
    direct = setting.direct
    pairs = [d for d in setting.data if d.spectra[1] is not None]
    heard = direct.struck or max(direct.evidence.values(), default=0.0) >= HEARD
    if report.verdict in QUIET or not pairs or heard:
        return report
    machine = setting.machine
    try:
        tie = impulsive(ties(of_machine(machine), machine.operating.shaft if machine.operating else None))
    except SpecError:  # shafts whose speeds nothing ties together
        return report
    if not any(f.kind in KINDS for f in tie.families) or not reachable(pairs, tie):
        return report
    found = [one for d in pairs if (one := _foreign(d, channels, tie, setting.seed)) is not None]
    if not found:
        return report
    middle = sorted(found, key=lambda one: one.order)[len(found) // 2]
    agree = sum(abs(one.order / middle.order - 1.0) < SAME for one in found)
    return _told(report, middle, tie) if 2 * agree > len(pairs) else report


def _foreign(one: PointData, channels: Sequence[Channel], tie: Ties, seed: int) -> Foreign | None:
    """The comb of a point's test, if no part of the file has risen there and the baseline has no such tone in Hz."""
    now, then = one.spectra
    if then is None:
        return None
    test, rested = observed_as(now, "test", channels, tie), observed_as(then, "baseline", channels, tie)
    if any(c.present and c.risen for c in candidates([test], [rested], tie, seed)):
        return None
    found = foreign_comb(test, [rested], tie, seed)
    if found is None or _at_hz(rested, found.order * now.speed_hz / then.speed_hz, tie, seed) >= OLD_Z:
        return None
    return found


def _at_hz(rested: Observation, order: float, tie: Ties, seed: int) -> float:
    family = Family(kind="outer", site="", order=order, spacing=0.0, sidebands=0, slip=0.002)
    return family_evidence(rested.channels, tie, family, 0.0, np.random.default_rng((seed, 78))).z


def _told(report: Report, found: Foreign, tie: Ties) -> Report:
    rolling = [f for f in tie.families if f.kind in KINDS]
    near = min(rolling, key=lambda f: abs(f.order / found.order - 1.0))
    close = abs(near.order / found.order - 1.0) < NEAR
    nearest = f" (nearest: {KINDS[near.kind]} of {near.site}, {near.order:.4g})" if close else ""
    text = (
        f"impacts come {found.order:.4g} times a turn of {tie.reference}, {found.growth_db:.0f} dB deeper than in the "
        f"baseline, where {NO_PART}{nearest}: the file may hold the numbers of another bearing, or lack a part"
    )
    advice = (
        ADVICE.sentence if report.next_experiment is None else f"{ADVICE.sentence} {report.next_experiment.sentence}"
    )
    return replace(
        report,
        sentence=f"{report.sentence} But {text}.",
        undecidable=(*report.undecidable, text),
        next_experiment=NextExperiment(sentence=advice),
    )
