"""Whether the channels of the tests are the baseline's own, where only hearing tells which of two bearings it is.

Bearings of one geometry on one shaft make one line, and the sensor that hears it louder says which it is: with the two
channels exchanged, the other one. What a defect leaves alone says whose channel is whose: bands and quiet moments that
it does not raise, and the step of the converter.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import product
from typing import Literal

import numpy as np

from reconcile.gate.levels import Pair, pairs
from reconcile.gate.robust import fit_of
from reconcile.gate.steps import exchanged_steps
from reconcile.kinematics.observe import Observation
from reconcile.kinematics.sites import decided
from reconcile.report.action import BY_LOUDNESS
from reconcile.verdict import PlaceWeight
from sim.core.response import Channel

APART = 0.1
"""Mean log likelihood of a band by which channels must fit one way better than the other. Right channels of 45 pairs of
sensors at motors and rigs with pits fit their own by -0.07 (both sensors alike) to 0.57, of 40 other pairs by 0.14 to
4.9; exchanged ones by as much less."""

Word = Literal["own", "exchanged", "open"]


def carried(
    weights: Sequence[PlaceWeight], tests: Sequence[Observation], baselines: Sequence[Observation]
) -> Word | None:
    """Of a place that hearing decides among several: `own` where the channels at it and elsewhere are surely those of
    the baseline, `exchanged` where they fit better exchanged, `open` where neither; None where nothing hangs on it."""
    if len(weights) < 2 or not decided(weights):
        return None
    channels = tests[0].recording.channels
    others = [w.site for w in weights[1:]]
    two = [
        (a, b)
        for a, b in product(channels, channels)
        if a.location == weights[0].site and b.location in others and _alike(a, b)
    ]
    if not two:
        return None
    matched = pairs(
        [t.recording for t in tests],
        [b.recording for b in baselines],
        [t.speed.speed_hz for t in tests],
        [b.speed.speed_hz for b in baselines],
    )
    told = [_told([p for p in matched if a.name in p.names and b.name in p.names], a.name, b.name) for a, b in two]
    if "exchanged" in told:
        return "exchanged"
    return "own" if all(word == "own" for word in told) else "open"


def shared(weights: Sequence[PlaceWeight]) -> tuple[PlaceWeight, ...]:
    """The first two places with one weight: exchanged channels make one the other."""
    both = (weights[0].weight + weights[1].weight) / 2
    return (replace(weights[0], weight=both), replace(weights[1], weight=both), *weights[2:])


def told_open(weights: Sequence[PlaceWeight]) -> str:
    """What is not decided where nothing tells the channels apart."""
    first, second = weights[0].site, weights[1].site
    return (
        f"whether it is {second} and not {first}, should their sensors be exchanged: only which of them hears it "
        "louder tells the place, and nothing that the defect leaves alone tells which sensor is which"
    )


def told_heard(several: Sequence[Sequence[PlaceWeight]], words: Sequence[Word | None]) -> tuple[str, ...]:
    """The limit of places that hang on hearing: a baseline whose sensors are named as wrongly does not tell."""
    return tuple(
        f"{weights[0].site} and {weights[1].site} make the same lines, or some within slip: {BY_LOUDNESS}"
        for weights, word in zip(several, words, strict=True)
        if word in ("own", "open")
    )


def told_exchanged(weights: Sequence[PlaceWeight]) -> str:
    """The same where they fit better exchanged."""
    first, second = weights[0].site, weights[1].site
    return (
        f"whether the channels at {first} and {second} are exchanged in the tests: what the defect leaves alone fits "
        f"the baseline better so, and then it is {second}, else {first}"
    )


def _alike(a: Channel, b: Channel) -> bool:
    return (a.quantity, a.unit) == (b.quantity, b.unit)


def _told(matched: Sequence[Pair], a: str, b: str) -> Word:
    """Of two channels, by all tests that have a baseline."""
    if not matched:
        return "open"
    better = float(np.mean([_better(p, p.names.index(a), p.names.index(b)) for p in matched]))
    steps = {_stepped(p, p.names.index(a), p.names.index(b)) for p in matched}
    if better < -APART and steps != {False}:
        return "exchanged"
    return "own" if better > APART or steps == {False} else "open"


def _better(p: Pair, i: int, j: int) -> float:
    """By which two channels fit their own baselines better than each other's."""
    return (fit_of(p, i, i) + fit_of(p, j, j) - fit_of(p, i, j) - fit_of(p, j, i)) / 2


def _stepped(p: Pair, i: int, j: int) -> bool | None:
    test, base = p.steps_test, p.steps_baseline
    return exchanged_steps((test[i], test[j]), (base[i], base[j]))
