"""Reports where half or twice the stated speed explains the lines of the shaft as well.

All orders hang on the speed: a defect that is named at the wrong one may be another, or have another rate. So the
recordings are judged at the rival speed too, and the lines of the bearings decide, if they can. Where no line of the
shaft confirms the stated speed, it is doubted if the bearings' lines are clearly firmer at half or twice of it, or if
they stand where they do at that speed only (`reconcile.kinematics.octaves`).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from reconcile.kinematics.families import Ties
from reconcile.kinematics.observe import Observation
from reconcile.kinematics.octaves import octave_of, odd_lines
from reconcile.kinematics.unread import Judged, at_either, placed, speed_unread
from reconcile.verdict import NextExperiment, Report
from signals.recording import Operating, Recording

TACHO = "Record with a tacho, or read the speed once with a strobe."
RATE_TOO = " Look up the sampling rate first where the file does not hold it."
CLEAR_Z = 3.0
"""Robust deviations by which the bearing's lines must be firmer at one speed to decide for it: scores of one defect
scatter by about one from record to record."""
SAME = 0.02
"""Relative difference up to which the lines of another shaft are those between the multiples."""
FAR = 0.06
"""Relative difference of a stated speed from the machine file's beyond which the search for lines does not reach it."""
WORDS = {2.0: "twice the stated speed", 0.5: "half the stated speed"}
USUAL = "the speed of the machine file"
RATES = {2.0: "half", 0.5: "twice"}
"""What the sampling rate would be over the stated one, if that is what is wrong: a file that does not hold its rate is
read as if it had been sampled as the description says, and everything moves with it."""


def factor_of(seen: Observation, ties: Ties) -> float | None:
    """2 or 0.5 where that times the speed explains the lines as well; None where another shaft makes those lines."""
    if seen.speed.rival_hz is None:
        return None
    factor = 2.0 if seen.speed.rival_hz > seen.speed.speed_hz else 0.5
    others = [r for name, r in ties.shafts.items() if name != ties.reference]
    told = any(round(0.5 / r) >= 1 and abs(0.5 / r - round(0.5 / r)) < SAME for r in others)
    return None if factor == 0.5 and told else factor


def restated(recording: Recording, seen: Observation, factor: float) -> Recording:
    """The recording with `factor` times the found speed as the stated one."""
    operating = recording.operating or Operating(shaft=seen.speed.shaft, speed_hz=seen.speed.speed_hz)
    return replace(recording, operating=replace(operating, speed_hz=factor * seen.speed.speed_hz))


def doubt_of(tests: Sequence[Observation], ties: Ties) -> tuple[Observation, float] | None:
    """A recording and its factor, where the same factor is open in most of the tests."""
    open_ones = [(t, f) for t in tests if (f := factor_of(t, ties)) is not None]
    if not open_ones:
        return None
    first = open_ones[0]
    return first if 2 * sum(f == first[1] for _, f in open_ones) > len(tests) else None


def unconfirmed(tests: Sequence[Observation]) -> bool:
    """Whether neither pulses nor lines of the shaft say how fast it turned, in most of the tests."""
    return 2 * sum(t.speed.method == "stated" for t in tests) > len(tests)


def against_rivals(
    stated: Judged,
    seen: Sequence[Observation],
    tie: Ties,
    at: Callable[[float, bool], Judged | None],
    nominal_hz: float | None = None,
    others: Sequence[float] | None = None,
) -> Report:
    """The answer, held against that at half or twice the speed where the shaft's lines don't decide, or where a
    bearing's own lines stand half way between those of a defect; where no line confirms a speed that is far from the
    machine file's, against that at the latter. `at(factor, firmly)`: the answer at that speed; `others`: factors at
    which other parts are firm, where nothing says how fast it turned (None where something does)."""
    doubt = doubt_of(seen, tie)
    if doubt is None and not others and stated.report.verdict in ("nothing_missing", "not_decidable"):
        return _at_usual(stated, seen, at, nominal_hz)
    octave = None if stated.firmest is None else octave_of(stated.firmest, stated.every, seen)
    octave = None if octave == 2.0 and odd_lines(seen) else octave
    if octave is not None:
        return _by_octave(stated, seen, at, octave, nominal_hz)
    if doubt is not None:
        return doubted(stated, at(doubt[1], False), *doubt)
    if not unconfirmed(seen):
        return stated.report
    first = next(t for t in seen if t.speed.method == "stated")
    near = [(one, f * first.speed.speed_hz) for f in others or () if (one := at(f, False)) is not None]
    firmest = max(_far(stated, first, at, nominal_hz), key=lambda r: r[0], default=None)
    top = max([stated.z, *(one.z for one, _ in near)])
    if firmest is not None and firmest[0] > top:
        return doubted(stated, firmest[2], first, firmest[1])
    return stated.report if others is None else speed_unread(stated, near, first)


def _by_octave(
    stated: Judged,
    seen: Sequence[Observation],
    at: Callable[[float, bool], Judged | None],
    octave: float,
    nominal_hz: float | None,
) -> Report:
    """The answer at half or twice the speed, of which the bearing's lines speak, or at the machine file's: where
    that is far off, no line tells and its bearings are about as firm there. An inner race's line at
    half the speed may be an outer race's at the file's."""
    first = next(t for t in seen if t.speed.method != "tacho")
    there = at(octave, True)
    factor = None if nominal_hz is None or not unconfirmed(seen) else nominal_hz / first.speed.speed_hz
    usual = at(factor, False) if factor is not None and abs(factor - 1.0) > FAR else None
    if factor is not None and usual is not None and usual.z > max(0.0 if there is None else there.z - CLEAR_Z, 0.0):
        return doubted(stated, usual, first, factor)
    return doubted(stated, there, first, octave, by_bearing=True)


def _at_usual(
    stated: Judged, seen: Sequence[Observation], at: Callable[[float, bool], Judged | None], nominal_hz: float | None
) -> Report:
    """The answer where nothing is found at the stated speed: what stands at the machine file's, if that is far off and
    no line tells."""
    first = next((t for t in seen if t.speed.method == "stated"), None)
    if first is None or nominal_hz is None or not unconfirmed(seen):
        return stated.report
    factor = nominal_hz / first.speed.speed_hz
    rival = at(factor, False) if abs(factor - 1.0) > FAR else None
    return stated.report if rival is None or rival.z == 0.0 else doubted(stated, rival, first, factor)


def _far(
    stated: Judged, first: Observation, at: Callable[[float, bool], Judged | None], nominal_hz: float | None
) -> list[tuple[float, float, Judged]]:
    """(score, factor, answer) at half and twice the speed, unless nothing is said at the stated one, and at the machine
    file's, where that is far off."""
    quiet = stated.report.verdict in ("nothing_missing", "not_decidable")
    usual = None if nominal_hz is None else nominal_hz / first.speed.speed_hz
    factors = [] if quiet else [(2.0, CLEAR_Z), (0.5, CLEAR_Z)]
    if usual is not None and abs(usual - 1.0) > FAR:
        factors.append((usual, -CLEAR_Z))  # two statements against each other: as firm is enough
    found = [(one, factor, more) for factor, more in factors if (one := at(factor, False)) is not None]
    return [(one.z - more, factor, one) for one, factor, more in found if one.z > 0.0 or not quiet]


def doubted(
    stated: Judged, rival: Judged | None, first: Observation, factor: float, *, by_bearing: bool = False
) -> Report:
    """The report with the doubt: decided by the bearing's lines, or left open with the causes at both speeds.

    `by_bearing`: those lines speak for the rival already, whichever scores more.
    """
    shaft, speed = first.speed.shaft, first.speed.speed_hz
    other = factor * speed
    if not by_bearing and stated.z > 0 and (rival is None or stated.z > rival.z + CLEAR_Z):
        return stated.report
    by_lines = first.speed.method != "stated" and not by_bearing
    fits = "its lines fit both" if by_lines else "no line of it tells"
    if by_bearing and first.speed.method != "stated":
        fits = f"the bearing's lines stand as they do at {other:.4g} Hz"
    note = f"whether {shaft} turns at {speed:.4g} Hz as stated or at {other:.4g} Hz: {fits}"
    rate = f"the sampling rate is {RATES[factor]} the one stated" if factor in RATES else ""
    undecidable = (f"{note}, or {rate}" if rate else note, *stated.report.undecidable)
    if rival is None and by_bearing:
        rival = replace(stated, every=())  # its lines tell, though the recordings can't carry the parts at that speed
    if rival is None or max(stated.z, rival.z) == 0.0:
        return replace(stated.report, undecidable=undecidable)
    nearer = rival.z > 0.0 if by_bearing else rival.z > stated.z
    shown, at = (rival.report, other) if nearer else (stated.report, speed)
    better = "better" if rival.z > stated.z + CLEAR_Z else "no worse"
    whose, how = (f"the lines of {shaft}", "no worse") if by_lines else ("bearing lines", better)
    causes = at_either((stated, speed), (rival, other))
    return replace(
        shown,
        verdict="ambiguous",
        sentence=f"The speed is not decided: {whose} fit {other:.4g} Hz, {WORDS.get(factor, USUAL)}, {how} than "
        f"{speed:.4g} Hz as stated{f'; or {rate}' if rate else ''}. At {at:.4g} Hz: {shown.sentence}",
        where=placed(shown.where, causes),
        causes=causes,
        undecidable=undecidable,
        next_experiment=NextExperiment(sentence=f"{TACHO}{RATE_TOO if rate else ''}"),
    )
