"""Teeth that the file counts wrong: their lines stand where another whole number of teeth has them at the stated speed.

The teeth's lines say where the mesh is, not how fast a shaft turns: 23 teeth at 25 Hz are 25 teeth at 23 Hz. Where the
speed that they give is far from the stated one, the shaft's own first line decides.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from reconcile.kinematics.known_turn import most, taken
from reconcile.kinematics.observe import Observation
from reconcile.kinematics.spec import KinematicSpec
from reconcile.speed.excess import line_excess
from reconcile.verdict import NextExperiment, Report

FAR = 0.012
"""Relative difference of a speed from the stated one from which teeth are doubted: drives slip by less."""
NEAR = 0.005
"""Relative difference from the stated speed up to which a whole number of teeth explains the lines."""
CLEAR_LOG = 3.0
"""Log power over the floor of the first lines of shaft and mesh at the one speed, and by which they are above those at
the other."""
BINS = 2


@dataclass(frozen=True, kw_only=True)
class OtherTeeth:
    """A gear on the shaft that the speed is stated of, with the teeth of the file and those that its lines have."""

    gear: str
    mesh: str
    teeth: int
    heard: int
    mesh_hz: float
    label: str


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
    """The report of the corrected specification, which says so first."""
    said = (
        f"In its teeth the machine file does not fit: {found.teeth} of {found.gear}, but {found.mesh} stands at "
        f"{found.mesh_hz:.5g} Hz in {found.label}, {found.heard} times the line of the turn itself."
    )
    advice = f"Correct the teeth of {found.gear} in the file, and check those of the gear it meshes with."
    return replace(
        report,
        sentence=f"{said} With {found.heard} teeth: {report.sentence}",
        undecidable=(f"the ratio of {found.mesh}: only the teeth of {found.gear} were heard", *report.undecidable),
        next_experiment=NextExperiment(sentence=advice),
    )
