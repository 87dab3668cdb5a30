"""A sensor that changed at one operating point alone is left out of the comparison, and told."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from reconcile.judge.lone import LOUD_P, Cell, features_of, lone_cell
from reconcile.machine.decide import ALSO_P
from reconcile.machine.search import fit_views
from reconcile.machine.setting import Found, Lone, Setting
from reconcile.machine.sidebands import apart
from reconcile.verdict import NextExperiment, Report, operating_point

Look = tuple[Setting, Found]
"""A setting and what its candidates say."""


def without_lone(of_kind: Look, closer: Look) -> tuple[Look, Look]:
    """Both looks, on machines of the kind and on those that agree with the baseline, without the only sensor and
    operating point that changed by what the latter show.

    As they are where there is none, a known effect's pattern or impacts are what changed there, what is left is
    unusual too, and on machines without teeth, whose bearings repeat themselves badly, or at one speed.
    """
    setting, seen = closer
    speeds = apart([d.point.speed_hz for d in setting.data])
    known = min(seen.screen.p_best, of_kind[1].screen.p_best, setting.direct.p)
    if not setting.machine.gears or len(speeds) < 2 or known <= LOUD_P:
        return of_kind, closer
    cell = lone_cell(seen.fitted, setting.changes, len(setting.data), len(setting.channels))
    if cell is None:
        return of_kind, closer
    kind = _again(of_kind, cell, seen.screen.p_any)
    softer = replace(setting, overdispersion=kind[1].fitted.overdispersion)
    left = _again((softer, seen), cell, seen.screen.p_any)
    if min(left[1].screen.p_best, left[1].screen.p_lines) <= ALSO_P:
        return of_kind, closer
    return kind, left


def _again(look: Look, cell: Cell, p: float) -> Look:
    """As if the cell had not been recorded; `p` of its change, which is kept to be told."""
    setting, found = look
    changes = setting.changes
    here = features_of(changes, cell, len(setting.data), len(setting.channels))
    observed, halves = (np.where(here, np.nan, x) for x in (changes.observed, changes.halves))
    point = setting.data[cell.point].point
    at = operating_point(point.speed_hz, point.torque_ratio)
    lone = Lone(channel=setting.channels[cell.channel], point=at, p=p)
    left = replace(setting, changes=replace(changes, observed=observed, halves=halves), lone=lone)
    return left, fit_views(left, found.known)


def with_lone(report: Report, lone: Lone | None) -> Report:
    """The report with what was left out so among its limits; of a machine that is sound otherwise in the sentence too,
    with what would tell more."""
    if lone is None:
        return report
    told = (
        f"left out: {lone.channel} at {lone.point}, which changed alone (p = {lone.p:.1g}): no other sensor shows "
        "anything there, nor does this one at another operating point. Sound machines do so where a motion across the "
        "load sets in by itself; no pattern of a known effect is near"
    )
    report = replace(report, where=replace(report.where, limits=(*report.where.limits, told)))
    if report.verdict != "nothing_missing":
        return report
    words = (
        f"{report.sentence.rstrip('.')}, but for {lone.channel} at {lone.point}, which changed alone and is left out."
    )
    advice = f"Record a further baseline at {lone.point}: it tells whether {lone.channel} was so before."
    return replace(report, sentence=words, next_experiment=NextExperiment(sentence=advice))
