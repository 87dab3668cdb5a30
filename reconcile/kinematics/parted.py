"""Recordings parted in what is fitted and what is foretold: whole ones, or the halves of a lone one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from reconcile.kinematics.families import Ties
from reconcile.kinematics.observe import Observation, observe
from signals.recording import Operating, Recording
from sim.core.errors import SpecError

LEAST_TURNS = 24.0
"""Of each part."""
UNSEARCHED = (1,)
"""Bands of a part in which nothing is looked for: what is foretold of it is asked of the bands that fit the other."""


@dataclass(frozen=True, kw_only=True)
class Parted:
    """What is fitted, what is held out, and what that is in words."""

    fit: Observation
    held: tuple[Observation, ...]
    told: str


def parted(tests: Sequence[Observation], ties: Ties, seed: int) -> Parted | None:
    """The first test is fitted, all others that are long enough are held out; where there are none, its later half is.

    None where the parts hold too few turns.
    """
    first, *others = tests
    held = tuple(t for t in others if turns_of(t) >= LEAST_TURNS)
    if not held:
        return _halves(first, ties, seed)
    if turns_of(first) < LEAST_TURNS:
        return None
    speeds = " and ".join(f"{hz}" for hz in dict.fromkeys(f"{t.speed.speed_hz:.4g}" for t in held))
    many = "another recording" if len(held) == 1 else f"{len(held)} other recordings"
    return Parted(fit=first, held=held, told=f"{many}, at {speeds} Hz")


def turns_of(one: Observation) -> float:
    """Turns of the reference shaft that a recording holds."""
    return one.channels[0].turns


def _halves(whole: Observation, ties: Ties, seed: int) -> Parted | None:
    """Both halves of a record, each with a speed and an angle of its own: what is fitted must not know the other half.

    Only where the first half alone has too few lines to tell its speed that of the record is taken. That of the fitted
    half is where the search in the later one begins.
    """
    speed = whole.speed
    try:
        early = observe(_half(whole, speed.stated_hz, later=False), ties, whole.label, stated_hz=None, seed=seed)
        if early.speed.method == "stated" and speed.method != "stated":
            known = _half(whole, speed.speed_hz, later=False)
            early = observe(known, ties, whole.label, stated_hz=None, seed=seed)
        later = _half(whole, early.speed.speed_hz, later=True)
        late = observe(later, ties, whole.label, stated_hz=None, seed=seed, parts=UNSEARCHED)
    except SpecError:
        return None
    if min(turns_of(early), turns_of(late)) < LEAST_TURNS:
        return None
    return Parted(fit=early, held=(late,), told="a later time of the same record")


def _half(whole: Observation, stated_hz: float | None, *, later: bool) -> Recording:
    """One half of the record, with the pulses of that half, and a stated speed."""
    one = whole.recording
    middle = one.start_s + one.duration_s / 2
    half = one.select(start_s=middle) if later else one.select(end_s=middle)
    if stated_hz is not None:
        half = replace(half, operating=_turning(one, whole.speed.shaft, stated_hz))
    if half.tacho is None:
        return half
    times = half.tacho.pulse_times_s
    own = times[times >= middle] if later else times[times < middle]
    return replace(half, tacho=replace(half.tacho, pulse_times_s=own))


def _turning(one: Recording, shaft: str, speed_hz: float) -> Operating:
    known = one.operating
    return Operating(shaft=shaft, speed_hz=speed_hz) if known is None else replace(known, speed_hz=speed_hz)
