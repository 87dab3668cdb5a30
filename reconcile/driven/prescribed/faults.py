"""Faults of the measurement under a prescribed motion: units and polarity against other recordings, wandering zeros.

The motion says nothing of a mass, so that recordings are held against each other by the force that a spring and damper
take for the motion, and by the levels of both.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from reconcile.driven.channels import Driven
from reconcile.driven.measured import FITS, LEVEL_SHARE, OTHER_GAIN, Scaled, by_factor, turned_fault
from reconcile.driven.prescribed.analysis import Findings
from reconcile.driven.prescribed.fitting import fit_resistance
from reconcile.driven.prescribed.motion import motion_of
from reconcile.driven.prescribed.polarity import Signs, feeding_fault, signs
from reconcile.driven.prescribed.resistance import NONE
from reconcile.driven.prescribed.runs import START
from reconcile.driven.split import Part
from reconcile.verdict import SensorFault

LEAST_RATIO = 4.0
"""Ratio of units that is told where a spring and damper fit both recordings; friction or stops change the force for a
motion by less than twice in all made and measured recordings."""
LAWFUL, LAWFUL_OFF = 100.0, 3.0
"""Least ratio that is told where they do not, and by how much it may then be missed."""
MOST_SPAN_M, MOST_FORCE_N = 2.0, 1e8
"""Way of a motion and size of a force beyond which a unit is doubted: no test bench for machine parts has them."""
LEAST_SPAN_M, LEAST_FORCE_N = 1e-9, 1e-6
"""And below which."""


@dataclass(frozen=True, kw_only=True)
class Resists:
    """A recording with the spring and damper that it fits: force over motion, share it leaves, what tells signs."""

    data: Driven
    gain: float
    left: float
    signs: Signs


@dataclass(frozen=True, kw_only=True)
class HeldMotions:
    """Recordings with what could be put right, faults, and remarks; `undecided`: something could not be."""

    data: list[Driven]
    faults: list[SensorFault]
    remarks: tuple[str, ...]
    undecided: bool


def resists(data: Driven) -> Resists:
    """By least squares on the force."""
    motion = motion_of(data, float(np.median(data.drive)))
    skip = int(START * data.answer.size)
    found = fit_resistance(NONE, motion, data.answer, skip)
    spread = float(data.answer[skip:].std()) or 1.0
    told = float((data.answer - found.error)[skip:].std()) / (float(data.drive[skip:].std()) or 1.0)
    return Resists(
        data=data, gain=told, left=float(found.error[skip:].std()) / spread, signs=signs(motion, data.answer, found)
    )


def held_motions(
    tests: Sequence[Driven], baselines: Sequence[Driven], shown: Sequence[SensorFault] = ()
) -> HeldMotions:
    """Against the first baseline, else the first test; `shown`: what else is wrong with the tests."""
    faults, undecided, factors = list[SensorFault](), False, set[float]()
    rested, data = [resists(d) for d in baselines[:1]], list[Driven]()
    first = resists(tests[0])
    reference, against = (rested[0], "baseline 1") if rested else (first, "test 1")
    known = reference.signs.undone() if reference.signs.power < 0 else reference.signs
    for i, test in enumerate(tests):
        one, name, before = first if i == 0 else resists(test), f"test {i + 1}", len(faults)
        found = _scaled(one, reference)
        straight = one.data if found is None else found.undone(one.data)
        if found is not None:
            faults.append(found.fault(one.data, name, against))
            factors.add(found.factor)
            undecided |= found.drives is None or len(factors) > 1
        undecided |= not rested and len(faults) > before
        turned = one.signs.turned(known if rested or i > 0 else None)
        if turned:
            fed = one.signs.power < 0
            faults.append(feeding_fault(one.data, name) if fed else turned_fault(one.data, name, against))
            straight = replace(straight, answer=-straight.answer)
            undecided |= not rested and not fed
        data.append(straight)
    return HeldMotions(data=data, faults=[*faults, *shown], remarks=doubted_sizes(data), undecided=undecided)


def _scaled(one: Resists, reference: Resists) -> Scaled | None:
    """A ratio of units between the forces that two recordings take for a motion."""
    gain = one.gain / reference.gain if reference.gain else 0.0
    if gain == 0.0 or abs(math.log(gain)) < math.log(OTHER_GAIN):
        return None
    moved = math.log(float(one.data.drive.std()) / float(reference.data.drive.std()))
    pushed = math.log(float(one.data.answer.std()) / float(reference.data.answer.std()))
    away = min(abs(moved), abs(pushed)) > LEVEL_SHARE * abs(math.log(gain))
    drives = None if away else abs(pushed) < abs(moved)
    if max(one.left, reference.left) < FITS:
        found = by_factor(one.data, gain, drives)
        if found.unit and _ratio(found) > LEAST_RATIO:
            return found
    found = by_factor(one.data, gain, drives, math.log(LAWFUL_OFF))
    return found if found.unit and _ratio(found) > LAWFUL else None


def _ratio(found: Scaled) -> float:
    return max(found.factor, 1.0 / found.factor)


def doubted_sizes(several: Sequence[Driven]) -> tuple[str, ...]:
    """Sizes that no part has: units that are wrong in all recordings."""
    said = []
    for data in several[:1]:
        span, size = float(np.ptp(data.drive)), float(np.max(np.abs(data.answer)))
        if data.drive_channel.unit == "m" and not LEAST_SPAN_M < span < MOST_SPAN_M:
            said.append(f"{data.drive_channel.name} goes over {span:.3g} m")
        if data.answer_channel.unit == "N" and not LEAST_FORCE_N < size < MOST_FORCE_N:
            said.append(f"{data.answer_channel.name} reaches {size:.3g} N")
    return tuple(f"{text}: if that is not so, its unit is wrong, and all sizes with it." for text in said)


def drifting(found: Findings, parts: Sequence[Part]) -> list[SensorFault]:
    """Zeros of the force that wander, which were taken off."""
    faults = []
    for k, part in enumerate(parts):
        run = next((r for r in (found.fitted, found.held) if r.name == part.name), None)
        if run is None or run.drift == 0.0:
            continue
        test = f"test {k + 1}" if part.name.startswith("recording") else "test 1"
        detail = f"{test}: its zero wanders by {run.drift:.2g} of the force's standard deviation"
        channel = part.data.answer_channel.name
        faults.append(SensorFault(kind="drift", channel=channel, detail=detail, recordings=(test,)))
    return faults
