"""Two motions, of a base and of the mass on it, held against each other before the one is taken from the other.

A difference of two large motions shows a small error of either as a motion of its own: a gain of 3 % was told as a
second resonance. What the mass passes on tells gain, sign, delay and order of the two channels, whatever the machine's
numbers are; which of both channels is wrong it does not tell.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from reconcile.driven.base import from_base, is_base
from reconcile.driven.channels import Driven
from reconcile.driven.faulty import Held
from reconcile.driven.measured import LEVEL_SHARE, OTHER_GAIN, Look, Scaled, by_factor, look
from reconcile.driven.passed import Passed, Transfer, passed, transfer
from reconcile.driven.step import in_step, late_fault
from reconcile.shares import signed_percent, two_digits
from reconcile.verdict import SensorFault

WORTH, ADEQUATE = 20.0, 1.2
"""Fall of the squares of all lines, over what they may be off, and of their mean, from which a gain or a delay is in
the transfer at all. Of 90 sound pairs and pairs with laws (20 to 40 dB) the gain took 10 at most, where the band
reaches over the resonance; a gain of 3 % takes 16 to 70."""
MOST_LEFT = 2.5
"""What the transfer may then leave: made pairs with and without laws left 0.2 to 2.2, pairs that are wrong in another
way 3 and more."""
SURE = 0.4
"""What is left, over what is left without the fault, from which the transfer alone proves it; else the free run must
leave so much less (`PROVED`): windows blur a transfer that is driven about its resonance alone (0.6 to 0.8 there)."""
PROVED = 0.8
SWAPPED = 0.5
"""The same for channels exchanged: below a third where they were, above 0.9 where not."""
CALIBRATED = 0.06
"""Gain between two sensors, in logarithms, that is their calibration: each is good to some per cent."""
LEAST_SAID = 0.005
"""And below which it is not worth a word."""
LEAST_DELAY = 0.5
"""Of a sample: shorter ones are those of two converters or filters."""
RIVAL, RIVAL_WORTH = 1.15, 15.0
"""How much more a damper to the ground or a lossy spring must leave than a delay, over it and in squares: of yielding
springs, which turn the phase alike, it was 1.10 at most, of a sample's delay 1.18 to 4 where nothing is beside it."""
ROUNDS = 2


@dataclass(frozen=True, kw_only=True)
class Paired:
    """A recording as the engine takes it, with what was wrong between both motions, and what is only said."""

    data: Driven
    faults: tuple[SensorFault, ...] = ()
    limits: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Against:
    """Both channels against each other: the recording in order and in step, still with its gain."""

    data: Driven
    gain: float
    delay_s: float
    swapped: bool
    alike: bool = False
    """Whether a damper to the ground or a lossy spring would look like the delay; it is then left as it is."""


def paired(data: Driven, own: float, recording: str, rested: Sequence[Driven] = ()) -> Paired:
    """The recording seen from its base, put right; as it is where it is no pair. `own`: a natural angular frequency to
    begin with; `rested`: the baselines, whose levels tell which channel has another gain."""
    if not is_base(data):
        return Paired(data=data)
    found = against(data, own)
    if found is None:
        return Paired(data=from_base(data))
    drives = _whose(found, own, rested)
    right = found.data
    if found.gain != 1.0 and drives:
        right = replace(right, drive=right.drive * found.gain)
    elif found.gain != 1.0:
        right = replace(right, answer=right.answer / found.gain)
    return Paired(
        data=from_base(right), faults=_faults(found, data, recording, drives), limits=_limits(found, data, drives)
    )


def with_pairs(held: Held, pairs: Sequence[Paired]) -> Held:
    """With what was wrong between both motions of each test; limits are told once."""
    limits = next((p.limits for p in pairs if p.limits), ())
    faults = [fault for p in pairs for fault in p.faults]
    return replace(held, faults=[*faults, *held.faults], remarks=(*limits, *held.remarks))


def against(data: Driven, own: float) -> Against | None:
    """Order, delay and gain of both channels; None where nothing is wrong with them, or cannot be told."""
    there = transfer(data)
    if there is None:
        return None
    fits = _fits(there, own)
    chosen, swapped = _simplest(fits, there), False
    turned = replace(data, drive=data.answer, answer=data.drive, bad_drive=data.bad_answer, bad_answer=data.bad_drive)
    back = transfer(turned)
    if back is not None and (other := _exchanged(fits[-1], there, back, own)) is not None:
        swapped, data, there, fits, chosen = True, turned, back, _fits(back, own), other
    if not swapped and (chosen is fits[0] or chosen.left > MOST_LEFT):
        return None
    late = chosen.delay_s
    alike = late > 0.0 and _as_good(chosen, there, own)
    if alike:
        late, chosen = 0.0, _simplest(fits[:2], there)
    straight = in_step(data, late) if late else data
    for _ in range(ROUNDS if late else 0):  # a long delay leaks out of the segments
        again = transfer(straight)
        if again is None:
            return None
        chosen = passed(again, own, gain=chosen.gain != 1.0, delay=True)
        late += chosen.delay_s
        straight = in_step(data, late)
    found = Against(data=straight, gain=chosen.gain, delay_s=late, swapped=swapped, alike=alike)
    sure = swapped or chosen.left <= SURE * fits[0].left
    if sure or (chosen is not fits[0] and _proved(found, data)):
        return found
    return Against(data=data, gain=1.0, delay_s=0.0, swapped=False, alike=True) if alike else None


def _fits(seen: Transfer, own: float) -> tuple[Passed, ...]:
    """From the simplest on: as described, with a gain, with a delay, with both."""
    return (
        passed(seen, own),
        passed(seen, own, gain=True),
        passed(seen, own, delay=True),
        passed(seen, own, gain=True, delay=True),
    )


def _simplest(fits: Sequence[Passed], seen: Transfer) -> Passed:
    """The first that leaves as little as the last."""
    last = fits[-1]

    def adequate(one: Passed) -> bool:
        return one.left <= ADEQUATE * last.left or (one.left - last.left) * seen.omega.size < WORTH

    return next(one for one in fits if adequate(one))


def _exchanged(described: Passed, there: Transfer, back: Transfer, own: float) -> Passed | None:
    """How the first channel answers to the second, where it clearly does so."""
    found = _simplest(_fits(back, own), back)
    clear = (described.left - found.left) * there.omega.size >= WORTH and found.left <= SWAPPED * described.left
    return found if clear and found.left <= MOST_LEFT else None


def _as_good(late: Passed, seen: Transfer, own: float) -> bool:
    """Whether a damper or spring to the ground, or a spring with losses of its own, explains the phase as well."""
    other = passed(seen, own, gain=late.gain != 1.0, ground=True)
    worse = (other.left - late.left) * seen.omega.size > RIVAL_WORTH
    return not (worse and other.left > RIVAL * late.left)


def _proved(found: Against, data: Driven) -> bool:
    """Whether the free run of the relative motion leaves clearly less of what was measured."""

    def left(one: Driven, gain: float) -> float:
        seen: Look = look(from_base(one))
        return abs(gain) * seen.left * float(seen.data.answer.std())

    right = replace(found.data, answer=found.data.answer / found.gain)
    return left(right, found.gain) <= PROVED * left(data, 1.0)


def _whose(found: Against, own: float, rested: Sequence[Driven]) -> bool | None:
    """Whether the base's channel has another gain than in the first baseline; None: either."""
    for past in rested[:1]:
        before = against(past, own)
        if before is not None and before.swapped:
            return None
        change = abs(math.log(abs(found.gain / (1.0 if before is None else before.gain))))
        if change < math.log(OTHER_GAIN):
            return None
        here, there = found.data, past if before is None else before.data
        levels = ((here.drive, there.drive), (here.answer, there.answer))
        moved = [abs(math.log(float(a.std()) / float(b.std()))) for a, b in levels]
        if min(moved) > LEVEL_SHARE * change or max(moved) < (1.0 - LEVEL_SHARE) * change:
            return None
        return moved[1] < moved[0]
    return None


def _scaled(found: Against, data: Driven, drives: bool | None) -> Scaled | None:
    """What one channel's numbers are wrong by; None where that is calibration."""
    gain = abs(found.gain)
    scaled = by_factor(data, gain, drives) if gain != 1.0 else None
    return scaled if scaled is not None and (scaled.unit or abs(math.log(gain)) > CALIBRATED) else None


def _faults(found: Against, data: Driven, recording: str, drives: bool | None) -> tuple[SensorFault, ...]:
    """For the report."""
    base, mass = data.drive_channel.name, data.answer_channel.name
    said = []
    if found.swapped:
        detail = f"{recording}: {base} follows {mass} as a mass follows its base, not {mass} {base}"
        said.append(SensorFault(kind="swapped_channels", channel=base, detail=detail, recordings=(recording,)))
        base, mass = mass, base
    scaled = _scaled(found, data, drives)
    if scaled is not None:
        fault = scaled.fault(data, recording, "what the mass passes on of slow motions")
        aside = "" if drives is not None else f"; either of both may be wrong{_as_a_spring(found, scaled)}"
        said.append(replace(fault, detail=fault.detail + aside))
    if found.gain < 0.0:
        detail = f"{recording}: slow motions of {base} come out turned round in {mass}: either has the opposite sign"
        said.append(SensorFault(kind="polarity", channel="", detail=detail, recordings=(recording,)))
    if abs(found.delay_s) >= LEAST_DELAY * data.step_s:
        said.append(late_fault(data, found.delay_s, recording))
    return tuple(said)


def _as_a_spring(found: Against, scaled: Scaled) -> str:
    """What else makes the mass follow less than its base moves."""
    if scaled.unit or not 0.0 < found.gain < 1.0:
        return ""
    return f", or a spring with {two_digits(1.0 - found.gain)} of the stiffness holds the mass to the ground"


def _limits(found: Against, data: Driven, drives: bool | None) -> tuple[str, ...]:
    """What was put right without a fault, and what stays open."""
    base, mass, said = data.drive_channel.name, data.answer_channel.name, []
    scaled, ms = _scaled(found, data, drives), 1e3 * abs(found.delay_s)
    if scaled is None and abs(math.log(abs(found.gain))) > LEAST_SAID:
        said.append(
            f"By what the mass passes on of slow motions {mass} over {base} is {signed_percent(abs(found.gain) - 1.0)} "
            "off, which may be the calibration of both: it is taken off, and sizes are as good as the better of both."
        )
    elif scaled is not None and drives is None:
        said.append(
            f"{mass} was put right: if {base} is the one that is wrong, all sizes of the motion are "
            f"{abs(found.gain):.4g} times as large."
        )
    if found.gain < 0.0:
        said.append(f"{mass} was turned round: if {base} is the one to turn, laws of one side act on the other side.")
    if 0.0 < abs(found.delay_s) < LEAST_DELAY * data.step_s:
        way = "late" if found.delay_s > 0.0 else "early"
        said.append(f"{mass} comes {ms:.2g} ms too {way} for {base}, less than half a sample: it is put right.")
    if found.alike:
        said.append(
            f"{mass} comes late for {base}, or a damper acts between the mass and the ground, or the spring has losses "
            "of its own: all turn the phase alike, and it is left as it is."
        )
    return tuple(said)
