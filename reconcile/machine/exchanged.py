"""Has the baseline a defect that the tests have not? Then the recordings are exchanged, or a part was replaced."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from reconcile.kinematics.candidate import DEFECTS
from reconcile.kinematics.families import Family, ties
from reconcile.kinematics.judge import candidates
from reconcile.kinematics.spec import of_machine
from reconcile.machine.alone import depth_over_sound
from reconcile.machine.direct import impulsive, observed_as, reachable
from reconcile.machine.setting import Found, Setting
from reconcile.observe.observation import PointData
from reconcile.verdict import Report
from sim.core.errors import SpecError
from sim.core.response import Channel
from sim.core.spec import MachineSpec

SURE = 6.0
"""Deviations of control lines from which a remark is worth it; it changes no verdict."""
LOUDER_DB = 6.0
"""By which a test may be louder than its baseline where that has a defect and the test has none. Beside a strong pit,
or an unbalance, the regular lines of sound balls that roll by are no longer as deep: right recordings of pits 40 dB
louder were told to be exchanged."""
HOLDS_OTHERWISE = ("fit_clearance", "fit_clearance_series", "radial_clearance")
BRINGS, ENOUGH, LEAST_LOSS = 0.5, 0.25, 1.0
"""Share of the loss of depth that draws of a named effect must bring, and of its draws that do; deviations of sound
machines that this must be at least."""
QUIET = ("nothing_missing", "measurement_fault")


def _held_otherwise(report: Report) -> set[str]:
    """Places at which an effect is named that changes how a bearing is held or loaded: such a ring no longer passes on
    what each ball that rolls by does to a sound bearing, and those lines are gone without an exchange."""
    return {c.site for c in report.causes if c.named and c.term in HOLDS_OTHERWISE}


def _turned_otherwise(report: Report, machine: MachineSpec) -> bool:
    """Whether what is named turns with the shaft of a machine without teeth: it moves the load round all bearings."""
    bearings = {b.name for b in machine.bearings}
    return not machine.gears and any(c.named and c.site not in bearings for c in report.causes)


def _louder_db(one: PointData, channel: int) -> float:
    now, then = one.spectra
    levels = [float(np.std(x.samples[channel])) if x is not None else 0.0 for x in (now, then)]
    return 20.0 * float(np.log10(levels[0] / levels[1])) if min(levels) > 0.0 else 0.0


def brought(report: Report, setting: Setting, found: Found, family: Family) -> bool:
    """Whether a named effect takes these lines away by itself, as it is simulated: a loose pedestal that lets the load
    go round did so at a bearing of the other shaft (m006 of the proof)."""
    library = found.known.library
    named = [name for c in report.causes if c.named and (name := f"{c.term}@{c.site}") in library.groups]
    if not named:
        return False
    depth = depth_over_sound(setting.changes, setting.data, setting.plan)
    least = BRINGS * float(depth(family, -setting.changes.observed[None])[0])
    if not LEAST_LOSS < least < np.inf:
        return False  # it is not these bands that have lost it, or they are not watched
    fell = (depth(family, -library.changes[list(library.groups[name])]) for name in named)
    return any(np.mean(one >= least) >= ENOUGH for one in fell)


def with_exchanged(report: Report, setting: Setting, found: Found, channels: Sequence[Channel]) -> Report:
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
    if deep is None or deep.family.site in _held_otherwise(report) or _turned_otherwise(report, machine):
        return report
    channel = [c.name for c in channels].index(deep.best.channel)
    if any(_louder_db(d, channel) > LOUDER_DB for d in pairs) or brought(report, setting, found, deep.family):
        return report
    text = f"the baseline has lines of {deep.family.key} that the tests have not; exchanged, or a part replaced"
    where = replace(report.where, limits=(*report.where.limits, text))
    return replace(report, sentence=f"{report.sentence} But {text}.", where=where)
