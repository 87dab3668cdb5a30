"""Gear stages as the classifier sees them: teeth of both gears, and how fast the first turns."""

from __future__ import annotations

from dataclasses import dataclass

from reconcile.kinematics.families import ties
from reconcile.kinematics.spec import KinematicSpec


@dataclass(frozen=True, kw_only=True)
class Stage:
    """Two gears in mesh: names, teeth, and turns of the first in a turn of the shaft whose speed is told."""

    name: str
    gears: tuple[str, str]
    teeth: tuple[int, int]
    ratio: float


def stages(spec: KinematicSpec, shaft: str | None) -> list[Stage]:
    """Meshes of a specification, seen from the shaft whose speed is told; the first gear is the faster one's or, at one
    speed, the one named first."""
    names = [s.name for s in spec.shafts]
    tied = ties(spec, shaft if shaft in names else None)
    gears = {g.name: g for g in spec.gears}
    found = []
    for name, _, shafts, pair in tied.meshes:
        one, other = pair if tied.shafts[shafts[0]] >= tied.shafts[shafts[1]] else pair[::-1]
        found.append(
            Stage(
                name=name,
                gears=(one, other),
                teeth=(gears[one].teeth, gears[other].teeth),
                ratio=tied.shafts[gears[one].shaft],
            )
        )
    return found
