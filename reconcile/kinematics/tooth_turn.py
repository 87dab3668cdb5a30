"""A faulty tooth by the mean turn of its gear, heard by all channels and in all bands together, against a baseline.

Sidebands say that a shaft's turn is uneven and need many of them above the floor; a burst at one place of the turn is
told while each of them is below it (`reconcile.observe.whole_turn`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from reconcile.kinematics.families import Ties
from reconcile.kinematics.lines import matched
from reconcile.kinematics.observe import Observation
from reconcile.kinematics.vague import TOOTH_TERMS
from reconcile.observe.tooth_place import ToothPlace, placed, window_of
from reconcile.observe.whole_turn import WholeTurn, of_as_many_turns, standing, whole_turn
from reconcile.verdict import Cause, NextExperiment, PlaceWeight, Report, Where


@dataclass(frozen=True, kw_only=True)
class ToothTurn:
    """A gear at one place of whose turn a burst comes back, in `tests` recordings with a baseline at their speed."""

    gear: str
    shaft: str
    place: ToothPlace
    tests: int


def tooth_turn(tests: Sequence[Observation], baselines: Sequence[Observation], ties: Ties) -> ToothTurn | None:
    """The gear whose place stands out most; None where none does, or nothing has a baseline."""
    pairs = [(test, base) for test in tests if (base := matched(test, baselines)) is not None]
    found = []
    for shaft, gear, teeth in _gears(ties) if pairs else ():
        ratio = ties.shafts[shaft]
        points = []
        for test, base in pairs:
            names = tuple(n for n in test.recording.names if n in base.recording.names)
            now, before = of_as_many_turns(*(partial(_turn, one, names, ratio, teeth) for one in (test, base)))
            points.append((standing(now, before) if before is not None else 0.0, now, 0.0))
        place = placed(shaft, points)
        if place.told and place.strongest is not None:
            found.append(ToothTurn(gear=gear, shaft=shaft, place=place, tests=len(pairs)))
    return max(found, key=lambda one: one.place.standing, default=None)


def _gears(ties: Ties) -> list[tuple[str, str, tuple[int, ...]]]:
    """Shaft and name of every gear in a mesh, its teeth and those of the others on its shaft."""
    sides = {
        gears[side]: (shafts[side], round(order / ties.shafts[shafts[side]]))
        for _, order, shafts, gears in ties.meshes
        for side in (0, 1)
    }
    return [
        (shaft, gear, (teeth, *(z for name, (other, z) in sides.items() if other == shaft and name != gear)))
        for gear, (shaft, teeth) in sides.items()
    ]


def _turn(one: Observation, names: Sequence[str], ratio: float, teeth: tuple[int, ...], most: int) -> WholeTurn | None:
    channel = one.channel(names[0]) if names else None
    if channel is None:
        return None
    samples = np.array([one.recording.series(name).samples for name in names], dtype=np.float64)
    turns = np.asarray(channel.angle_rad * (ratio / (2 * np.pi)), dtype=np.float64)
    return whole_turn(samples, turns, teeth=teeth, most_turns=most)


def tooth_report(found: ToothTurn) -> Report:
    """One tooth differs; how, a model of the mesh would have to tell."""
    turn = found.place.strongest
    assert turn is not None
    window = window_of(turn, shaft=found.shaft)
    return Report(
        verdict="ambiguous",
        sentence=f"A local tooth fault on {found.gear}: a burst comes back at one place of its turn "
        f"({turn.height:.1f} times the rest of the mean turn, {turn.turns} turns, over the baseline's), at "
        f"{window.centre_deg:.0f} degrees from the first sample of the recording that shows it best; whether the tooth "
        "is broken, cracked or pitted can't be told without a model.",
        level="kinematics",
        where=Where(sites=(PlaceWeight(site=found.gear, weight=1.0),), angle_window=window),
        causes=tuple(
            Cause(
                term=term,
                site=found.gear,
                score=found.place.evidence,
                reasons=("the mean turn says that one tooth differs, not how; a model of the mesh is needed to tell",),
            )
            for term in TOOTH_TERMS
        ),
        undecidable=(
            "broken, cracked or pitted: a model of the mesh is needed",
            "how large: a size can't be given without a model",
            f"whether it is a tooth of {found.gear}: a key, a rub or a loose part of {found.shaft} may do so too",
        ),
        next_experiment=NextExperiment(sentence="Add the gear data and loads to the machine to fit the tooth faults."),
    )
