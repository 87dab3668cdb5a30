"""Teeth that the file counts wrong: their lines stand where another whole number of teeth has them at the stated speed.

The teeth's lines say where the mesh is, not how fast a shaft turns: 23 teeth at 25 Hz are 25 teeth at 23 Hz. Where the
speed that they give is far from the stated one, the shaft's own first line decides.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from reconcile.kinematics.known_turn import most, taken
from reconcile.kinematics.observe import Observation
from reconcile.kinematics.spec import KinematicSpec
from reconcile.speed.elsewhere import Elsewhere
from reconcile.speed.excess import line_excess
from reconcile.verdict import NextExperiment, Report

FAR = 0.012
"""Relative difference of a speed from the stated one from which teeth are doubted: drives slip by less."""
NEAR = 0.005
"""Relative difference from the stated speed up to which a whole number of teeth explains the lines."""
LABELLED = 0.01
"""The same where the lines are far from the label, which may itself be half a per cent off."""
CLEAR_LOG = 3.0
"""Log power over the floor of the first lines of shaft and mesh at the one speed, and by which they are above those at
the other."""
BINS = 2


@dataclass(frozen=True, kw_only=True)
class OtherTeeth:
    """A gear on the shaft that the speed is stated of, with the teeth of the file and those that its lines have.

    `sure`: a line of the turn itself says so, else all labels may be wrong by one factor instead."""

    gear: str
    mesh: str
    teeth: int
    heard: int
    mesh_hz: float
    label: str
    sure: bool = True


def other_teeth(known: KinematicSpec, reference: str, several: Sequence[Observation]) -> OtherTeeth | None:
    """The gear whose teeth most of the recordings contradict alike; None where they do not."""
    gears = {g.name: g for g in known.gears}
    for mesh in known.meshes:
        for gear in (gears[name] for name in mesh.gears if gears[name].shaft == reference):
            found = [one for o in several if (one := _heard(gear.name, mesh.name, gear.teeth, o)) is not None]
            counted = Counter(one.heard for one in found).most_common(1)
            if counted and 2 * counted[0][1] > len(several):
                return next(one for one in found if one.heard == counted[0][0])
            told = most(gear, several)
            if told is not None and not taken(known, reference, told[0]):
                heard, seen = told
                return OtherTeeth(
                    gear=gear.name,
                    mesh=mesh.name,
                    teeth=gear.teeth,
                    heard=heard,
                    mesh_hz=heard * seen.speed.speed_hz,
                    label=seen.label,
                )
    return None


def teeth_by_far(
    known: KinematicSpec, reference: str, several: Sequence[Observation], far: Mapping[str, Elsewhere]
) -> OtherTeeth | None:
    """The gear whose teeth would stand, at the stated speeds, at one other whole number in most of all recordings.

    There the lines are those of the file's teeth at a speed `far` from the stated one (by label). No one miswrites most
    labels of tests and baselines by one factor: the file is wrong, or all are the speed of another shaft."""
    gears = {g.name: g for g in known.gears}
    for mesh in known.meshes:
        for gear in (gears[name] for name in mesh.gears if gears[name].shaft == reference):
            found = [one for o in several if (one := _far_off(gear.name, mesh.name, gear.teeth, o, far)) is not None]
            counted = Counter(one.heard for one in found).most_common(1)
            if counted and 2 * counted[0][1] > len(several) and not taken(known, reference, counted[0][0]):
                return next(one for one in found if one.heard == counted[0][0])
    return None


def _far_off(gear: str, mesh: str, teeth: int, seen: Observation, far: Mapping[str, Elsewhere]) -> OtherTeeth | None:
    there, stated = far.get(seen.label), seen.speed.stated_hz
    if there is None or not there.by_teeth or stated is None:
        return None
    mesh_hz = teeth * there.speed_hz
    heard = round(mesh_hz / stated)
    if heard < 1 or heard == teeth or abs(mesh_hz / (heard * stated) - 1.0) > LABELLED:
        return None
    return OtherTeeth(gear=gear, mesh=mesh, teeth=teeth, heard=heard, mesh_hz=mesh_hz, label=seen.label, sure=False)


def _heard(gear: str, mesh: str, teeth: int, seen: Observation) -> OtherTeeth | None:
    speed = seen.speed
    if speed.method != "harmonics" or speed.stated_hz is None or abs(speed.mismatch or 0.0) <= FAR:
        return None
    mesh_hz = teeth * speed.speed_hz
    heard = round(mesh_hz / speed.stated_hz)
    turned = mesh_hz / max(heard, 1)
    if heard == teeth or heard < 1 or abs(turned / speed.stated_hz - 1.0) > NEAR:
        return None
    here, there = (_first_line(seen, hz) for hz in (speed.speed_hz, turned))
    own, stated = (_first_line(seen, hz) for hz in (mesh_hz, teeth * speed.stated_hz))
    if min(there, own) < CLEAR_LOG or there < here + CLEAR_LOG or own < stated + CLEAR_LOG:
        return None
    return OtherTeeth(gear=gear, mesh=mesh, teeth=teeth, heard=heard, mesh_hz=mesh_hz, label=seen.label)


def _first_line(seen: Observation, hz: float) -> float:
    """Log power over the floor of the line at `hz`, the mean over the channels; 0 beyond the spectrum."""
    found = []
    for name in seen.recording.names:
        ratio, resolution = line_excess(seen.recording.series(name))
        place = round(hz / resolution)
        near = ratio[max(place - BINS, 0) : place + BINS + 1]
        found.append(float(np.log(max(float(np.max(near, initial=1.0)), 1.0))))
    return float(np.mean(found))


def with_teeth(known: KinematicSpec, found: OtherTeeth) -> KinematicSpec:
    """The specification with the teeth that were heard."""
    gears = [g.model_copy(update={"teeth": found.heard}) if g.name == found.gear else g for g in known.gears]
    return known.model_copy(update={"gears": gears})


def told_with(report: Report, found: OtherTeeth) -> Report:
    """The report of the corrected specification, which says so first; no name where the speeds may be wrong instead."""
    stands = f"{found.teeth} of {found.gear}, but {found.mesh} stands at {found.mesh_hz:.5g} Hz in {found.label}"
    corrected = f"Correct the teeth of {found.gear} in the file, and check those of the gear it meshes with."
    open_ratio = f"the ratio of {found.mesh}: only the teeth of {found.gear} were heard"
    if found.sure:
        said = f"In its teeth the machine file does not fit: {stands}, {found.heard} times the line of the turn itself."
        return _first(report, f"{said} With {found.heard} teeth", (open_ratio,), corrected)
    factor = f"{found.heard / found.teeth:.3g}"
    said = (
        f"In its teeth the machine file does not fit, or most stated speeds, of tests and baselines, are wrong by one "
        f"factor ({factor}): {stands}, {found.heard} times the stated speed."
    )
    report = replace(
        report,
        verdict="ambiguous" if report.verdict == "explained" else report.verdict,
        causes=tuple(replace(c, named=False) for c in report.causes),
    )
    which = f"whether {found.gear} has {found.heard} teeth or the stated speeds are {factor} times as high"
    advice = f"{corrected} If they are right, state the speed of {found.gear}'s own shaft, or give a tacho."
    return _first(report, f"{said} With {found.heard} teeth", (which, open_ratio), advice)


def _first(report: Report, said: str, undecidable: tuple[str, ...], advice: str) -> Report:
    return replace(
        report,
        sentence=f"{said}: {report.sentence}",
        undecidable=(*undecidable, *report.undecidable),
        next_experiment=NextExperiment(sentence=advice),
    )
