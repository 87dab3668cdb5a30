"""Has the baseline a defect that the tests have not? Then the recordings are exchanged, or a part was replaced."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from reconcile.kinematics.families import ties
from reconcile.kinematics.judge import DEFECTS, candidates
from reconcile.kinematics.spec import of_machine
from reconcile.machine.direct import impulsive, observed_as, reachable
from reconcile.machine.setting import Setting
from reconcile.verdict import Report
from sim.core.errors import SpecError
from sim.core.response import Channel

SURE = 6.0
"""Deviations of control lines from which a remark is worth it; it changes no verdict."""
HOLDS_OTHERWISE = ("fit_clearance", "fit_clearance_series", "radial_clearance")
QUIET = ("nothing_missing", "measurement_fault")


def _held_otherwise(report: Report) -> set[str]:
    """Places at which an effect is named that changes how a bearing is held or loaded: such a ring no longer passes on
    what each ball that rolls by does to a sound bearing, and those lines are gone without an exchange."""
    return {c.site for c in report.causes if c.named and c.term in HOLDS_OTHERWISE}


def with_exchanged(report: Report, setting: Setting, channels: Sequence[Channel]) -> Report:
    """The report, which says so after its sentence; where nothing is missing no one looks."""
    pairs = [d for d in setting.data if d.spectra[1] is not None]
    machine = setting.machine
    if report.verdict in QUIET or not pairs or setting.direct.struck or setting.direct.evidence:
        return report
    try:
        tie = impulsive(ties(of_machine(machine), machine.operating.shaft if machine.operating else None))
    except SpecError:  # shafts whose speeds nothing ties together
        return report
    if not reachable(pairs, tie):
        return report
    now = [observed_as(d.spectra[0], f"test {k}", channels, tie) for k, d in enumerate(pairs, 1)]
    rested = [
        observed_as(d.spectra[1], f"baseline {k}", channels, tie)
        for k, d in enumerate(pairs, 1)
        if d.spectra[1] is not None
    ]
    seen = candidates(rested, now, tie, setting.seed)
    deep = next((c for c in seen if c.family.kind in DEFECTS and c.present and c.risen and c.z > SURE), None)
    if deep is None or deep.family.site in _held_otherwise(report):
        return report
    text = f"the baseline has lines of {deep.family.key} that the tests have not; exchanged, or a part replaced"
    where = replace(report.where, limits=(*report.where.limits, text))
    return replace(report, sentence=f"{report.sentence} But {text}.", where=where)
