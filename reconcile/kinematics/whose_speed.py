"""Whose speed a description states: of the shaft that it names, or of another one of the machine.

A motor's speed written down for the driven shaft makes everything of a gearbox turn three times too fast, and a line of
the teeth at a third of the true speed's may even confirm it. So a stated speed far from the machine file's is held
against the same number of another shaft, by the lines of all shafts and teeth together.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.ndimage import maximum_filter1d

from reconcile.kinematics.families import Ties, ties
from reconcile.kinematics.spec import KinematicSpec
from reconcile.speed.estimate import ENOUGH, HARMONICS, LARGEST_LOG, estimate_speed, line_logs
from reconcile.stated import Given, pulses_hz
from signals.recording import Recording
from signals.series import FloatArray
from sim.core.errors import Problem, SpecError

FAR = 0.3
"""Relative difference of a stated speed from the machine file's from which it is asked whose it is: drives seldom run
so far from their nominal speed unawares, and gears that change the speed by less are told by their lines elsewhere."""
NUMBER = 0.1
"""Relative difference up to which the number is that of another shaft in the machine file."""
LABEL = 0.05
"""Relative error of a label within which the lines are looked for."""
TEETH = (1, 2, 3)
"""Harmonics of the teeth that are looked for, beside eight of each shaft."""
CLEAR = LARGEST_LOG
"""Log power over noise, the sum over lines of a channel, by which another shaft's lines must exceed the named one's
where the number is not that of the machine file: a made gearbox of 21 and 64 teeth has 39 to 40 for the right shaft and
20 to 21 for the other one, in four records with and without a pit, whichever of both is the right one."""
SURE = 0.99
"""Confidence of the lines of another shaft where the number is not that of the machine file."""


@dataclass(frozen=True, kw_only=True)
class _Turns:
    """What a description states, and the machine file's speeds of all shafts, Hz."""

    shaft: str
    speed_hz: float
    usual: Mapping[str, float]

    def far(self, shaft: str) -> float:
        """How far the number is from the file's speed of a shaft, as a logarithm."""
        return abs(float(np.log(self.speed_hz / self.usual[shaft])))


def usual_speeds(spec: KinematicSpec) -> dict[str, float]:
    """The machine file's speed of each shaft, Hz, through the teeth where it is not stated; empty where none is."""
    stated = {s.name: s.speed_hz for s in spec.shafts if s.speed_hz}
    if not stated:
        return {}
    first = next(iter(stated))
    try:
        ratios = ties(spec, first).shafts
    except SpecError:
        return stated
    return {name: stated.get(name, stated[first] * ratio) for name, ratio in ratios.items()}


def check_whose_speeds(spec: KinematicSpec, several: Sequence[Given]) -> None:
    """SpecError for speeds that are those of another shaft than the description says."""
    usual = usual_speeds(spec)
    problems = []
    for one in several:
        operating = one.recording.operating
        if operating is None or operating.speed_hz <= 0 or operating.shaft not in usual:
            continue
        stated = _Turns(shaft=operating.shaft, speed_hz=operating.speed_hz, usual=usual)
        meant = _meant(spec, stated, one.recording)
        if meant is not None:
            problems.append(_problem(one, stated, meant, spec))
    if problems:
        raise SpecError(problems)


def _meant(spec: KinematicSpec, stated: _Turns, recording: Recording) -> str | None:
    """The shaft whose speed the number is by pulses, lines and file; None where it may be the one that is named."""
    if abs(stated.speed_hz / stated.usual[stated.shaft] - 1.0) <= FAR:
        return None
    others = [s for s in stated.usual if s != stated.shaft and stated.far(s) < stated.far(stated.shaft)]
    for shaft in sorted(others, key=stated.far):
        here, there = ties(spec, stated.shaft), ties(spec, shaft)
        pulsed = _by_pulses(recording, stated, here, there)
        if pulsed is not None:
            if pulsed:
                return shaft
            continue
        if _by_lines(recording, stated, here, there):
            return shaft
    return None


def _by_pulses(recording: Recording, stated: _Turns, here: Ties, there: Ties) -> bool | None:
    """Whether pulses say that the number is of the shaft of `there`; None without pulses, or where they fit neither."""
    tacho = recording.tacho
    hz = None if tacho is None else pulses_hz(recording, tacho.shaft)
    if tacho is None or hz is None:
        return None
    fits = [abs(hz / (stated.speed_hz * one.shafts[tacho.shaft]) - 1.0) <= NUMBER for one in (here, there)]
    return None if fits[0] == fits[1] else fits[1]


def _by_lines(recording: Recording, stated: _Turns, here: Ties, there: Ties) -> bool:
    """Whether lines say so, or, where the number is the file's for that shaft, do not say otherwise."""
    try:
        combs = line_logs(recording)
        own, other = (_explained(combs, _orders(one), stated.speed_hz) for one in (here, there))
        if abs(stated.speed_hz / stated.usual[there.reference] - 1.0) <= NUMBER:
            return not (own > other and _confidence(recording, here, stated.speed_hz) >= ENOUGH)
        return other > own + CLEAR and _confidence(recording, there, stated.speed_hz) >= SURE
    except SpecError:  # too short for lines
        return False


def _orders(tie: Ties) -> tuple[float, ...]:
    shafts = [k * ratio for ratio in tie.shafts.values() for k in HARMONICS]
    return (*shafts, *(k * z for z in tie.mesh_orders for k in TEETH))


def _explained(combs: Sequence[tuple[FloatArray, float]], orders: Sequence[float], speed_hz: float) -> float:
    """Log power over noise of all these lines, the mean of the channels, at the best speed about `speed_hz`."""
    resolution = combs[0][1]
    step = resolution / (2 * max(orders))
    speeds = np.arange(speed_hz * (1 - LABEL), speed_hz * (1 + LABEL), step)
    total = np.zeros(speeds.size)
    for log, width in combs:
        wide = maximum_filter1d(log, 3)
        for order in orders:
            place = np.rint(order * speeds / width).astype(np.int64)
            inside = place < log.size
            total[inside] += wide[place[inside]]
    return float(np.max(total)) / len(combs)


def _confidence(recording: Recording, tie: Ties, speed_hz: float) -> float:
    teeth = tuple(z * k for z in tie.mesh_orders for k in TEETH)
    usable = tuple(z for z in teeth if z * speed_hz * 1.1 < recording.sampling_rate_hz / 2)
    return estimate_speed(recording, shaft=tie.reference, stated_hz=speed_hz, orders=usable).confidence


def _problem(one: Given, stated: _Turns, meant: str, spec: KinematicSpec) -> Problem:
    ratio = ties(spec, stated.shaft).shafts[meant]
    return Problem(
        field=one.field("operating.shaft"),
        message=f"the speed, {stated.speed_hz:.4g} Hz, is stated for {stated.shaft}; {meant} would then turn at "
        f"{stated.speed_hz * ratio:.4g} Hz, the machine file says {stated.usual[meant]:.4g} Hz: was {meant} meant?",
        given=stated.shaft,
        allowed=f"{meant}, or about {stated.usual[stated.shaft]:.4g} Hz for {stated.shaft}",
    )


def of_one_shaft(several: Sequence[Recording], tie: Ties) -> list[Recording]:
    """The recordings with their speeds stated of the reference shaft, through the teeth: each may state another's."""
    return [_of_reference(one, tie) for one in several]


def _of_reference(one: Recording, tie: Ties) -> Recording:
    operating = one.operating
    if operating is None or operating.shaft == tie.reference or operating.shaft not in tie.shafts:
        return one
    speed_hz = operating.speed_hz / tie.shafts[operating.shaft]
    return replace(one, operating=replace(operating, shaft=tie.reference, speed_hz=speed_hz))
