"""Teeth that the file counts wrong where the turn itself is known, by pulses or by the shaft's own lines.

The speed is then no question, and the lines of the teeth stand at another whole multiple of it than the file says:
where the file's are none, and at one other number all multiples are the loudest about.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reconcile.kinematics.lines import CLEAR_DB, order_lines
from reconcile.kinematics.observe import Observation
from reconcile.kinematics.spec import KinematicGear, KinematicSpec
from signals.series import FloatArray

MULTIPLES = (1, 2, 3)
RANGE = (0.6, 1.6)
"""Over the file's number: what a miscount, or the gear of another machine of the kind, may give."""
ABOUT = 0.4
"""Of the heard number of teeth: lines of the turn within this of one of their multiples are none louder than it."""
ABSENT_DB, LEAST_DB = 10.0, 6.0
"""By which the file's own multiples are below those of the number heard, on the mean, and each: a sideband that one of
them falls on comes as near as that."""
LIKE_NEIGHBOURS_DB, NEIGHBOURS = 3.0, 3
"""Over the loudest of its neighbours up to so many turns away, but that of the number heard, up to which a line is one
of their chain of sidebands: the gearbox of `openei_gear` is modulated three times a turn, and its 90th multiple, one of
those about the third of its 32 teeth, stood 6 to 9 dB over the next ones."""
MISMATCH = 0.012
"""Relative difference from the stated speed up to which lines of the shaft have told it beyond doubt."""


def heard_teeth(gear: KinematicGear, seen: Observation) -> int | None:
    """The number of teeth that the lines of one recording have in place of the file's; None where they do not tell.

    `gear` turns with the shaft that the recording's speed is of.
    """
    known = seen.speed.method == "tacho" or (
        seen.speed.method == "harmonics" and abs(seen.speed.mismatch or 0.0) <= MISMATCH
    )
    if not known:
        return None
    top = int(MULTIPLES[-1] * RANGE[1] * gear.teeth) + gear.teeth
    excess = _excess(seen, top)
    if excess is None:
        return None
    others = range(int(np.ceil(RANGE[0] * gear.teeth)), int(RANGE[1] * gear.teeth) + 1)
    fitting = [z for z in others if z != gear.teeth and _all_loudest(excess, z) and _none_at(excess, gear.teeth, z)]
    return fitting[0] if len(fitting) == 1 else None


def _excess(seen: Observation, top: int) -> FloatArray | None:
    """Mean over the channels, dB over the floor, at 0, 1, 2 .. `top` turns; NaN beyond the spectrum."""
    rows = []
    for name in seen.recording.names:
        lines = order_lines(seen, name)
        if lines is None:
            return None
        level, floor = lines.at(np.arange(top + 1, dtype=np.float64))
        rows.append(level - floor)
    return np.asarray(np.mean(rows, axis=0), dtype=np.float64)


def _all_loudest(excess: FloatArray, teeth: int) -> bool:
    """Whether each multiple that the spectrum reaches is clear and the loudest about, two of them at least."""
    places = [k * teeth for k in MULTIPLES if k * teeth < excess.size and np.isfinite(excess[k * teeth])]
    reach = int(ABOUT * teeth)
    return len(places) > 1 and all(
        excess[p] >= CLEAR_DB and excess[p] >= np.nanmax(excess[max(p - reach, 1) : p + reach + 1]) for p in places
    )


def _none_at(excess: FloatArray, teeth: int, heard: int) -> bool:
    """Whether the file's multiples are no lines of their own."""
    below = []
    for k in MULTIPLES:
        own, other = (excess[k * z] if k * z < excess.size else np.nan for z in (teeth, heard))
        if not np.isfinite(own) or not np.isfinite(other):
            continue
        about = range(max(k * teeth - NEIGHBOURS, 1), min(k * teeth + NEIGHBOURS + 1, excess.size))
        beside = np.nanmax([excess[n] for n in about if n not in (k * teeth, k * heard)])
        if own > other - LEAST_DB or (own >= CLEAR_DB and own > beside + LIKE_NEIGHBOURS_DB):
            return False
        below.append(other - own)
    return not below or float(np.mean(below)) >= ABSENT_DB


def most(gear: KinematicGear, several: Sequence[Observation]) -> tuple[int, Observation] | None:
    """The number that more than half of the recordings have alike, and the first of those."""
    found = [(z, o) for o in several if (z := heard_teeth(gear, o)) is not None]
    for heard, first in found:
        if 2 * sum(z == heard for z, _ in found) > len(several):
            return heard, first
    return None


def taken(known: KinematicSpec, reference: str, teeth: int) -> bool:
    """Whether another gear of the shaft has as many: its lines are its own."""
    return any(g.shaft == reference and g.teeth == teeth for g in known.gears)
