"""What a recording's pulses are worth: followed all along, a place to start from, or not its shaft's at all."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import median_filter

from learn.speed import SEARCH
from reconcile.speed.run_up import COVERED
from signals.angle.pulses import SCATTERED, check_inside, covered, scattered
from signals.recording import Recording
from signals.series import FloatArray

FEWEST = 3
"""Pulses that tell a speed."""
LOST, TWICE = 1.5, 0.6
"""Steps between pulses over the middle of those around from which one was lost, below which one came twice."""
AROUND = 9
"""Steps whose middle is taken."""
WHOLE = 0.02
"""By which a ratio of speeds may miss a whole number and still be one of pulses."""


@dataclass(frozen=True, kw_only=True)
class Pulses:
    """Mean speed by the pulses (None: they tell none), whether it holds for the whole recording (`firm`), and what is
    to be said: `kinds` for programs, `remarks` for people. `used`: they count in some way."""

    speed_hz: float | None = None
    firm: bool = False
    used: bool = False
    kinds: tuple[str, ...] = ()
    remarks: tuple[str, ...] = ()

    def faults(self) -> list[dict[str, object]]:
        """One object a kind, as of channels: `channel` is `tacho`."""
        return [{"channel": "tacho", "kind": kind, "left_out": not self.used} for kind in self.kinds]


def pulses_of(recording: Recording, *, trust: bool = False) -> Pulses:
    """The pulses held against the recording's span and its stated speed; `trust`: that one is exact.

    SpecError where all of them lie outside the recording.
    """
    tacho, operating = recording.tacho, recording.operating
    if tacho is None:
        return Pulses()
    times = np.asarray(tacho.pulse_times_s, dtype=np.float64)
    check_inside(times, recording.start_s, recording.duration_s)
    if operating is not None and tacho.shaft != operating.shaft:
        said = f"tacho: its pulses are of {tacho.shaft}, the stated speed of {operating.shaft}: they are not used"
        return Pulses(kinds=("other_shaft",), remarks=(said,))
    if times.size < FEWEST:
        said = f"tacho: {times.size} pulses tell no speed: they are not used"
        return Pulses(kinds=("few_pulses",), remarks=(said,))
    irregular = uneven(times)
    hz = _mean_hz(times, irregular) / tacho.pulses_per_revolution
    stated = operating.speed_hz if operating is not None and operating.speed_hz > 0 else None
    share = covered(times, recording.start_s, recording.duration_s)
    apart = stated is not None and abs(hz / stated - 1) > SEARCH
    firm = share >= COVERED and not irregular
    used = firm or not (apart or trust)
    kinds, remarks = [], []
    if irregular:
        kinds.append("irregular")
        then = f"the search starts from the {hz:.4g} Hz of the usual ones" if used else "they are not used"
        remarks.append(f"tacho: {irregular} of its steps are too long or short (pulses lost or doubled): {then}")
    if share < COVERED:
        kinds.append("partial")
        then = f"the search starts from their {hz:.4g} Hz" if used else "they are not used"
        remarks.append(f"tacho: its pulses cover {share:.0%} of the recording: {then}")
    if stated is not None and apart:
        kinds.append("contradicted")
        taken = f"{hz:.4g} Hz is" if used else f"the stated {stated:.4g} Hz is"
        even = (
            scattered(times, tacho.pulses_per_revolution, round(tacho.pulses_per_revolution * hz / stated)) <= SCATTERED
        )
        per_turn = _per_turn(hz / stated, tacho.pulses_per_revolution) if even else "; is this a tacho signal?"
        remarks.append(f"tacho: its pulses make {hz:.4g} Hz, but {stated:.4g} Hz are stated: {taken} taken{per_turn}")
    return Pulses(speed_hz=hz, firm=firm, used=used, kinds=tuple(kinds), remarks=tuple(remarks))


def _per_turn(ratio: float, stated: int) -> str:
    """The number of pulses a turn, or of turns a pulse, that would explain it, as a question."""
    wanted = stated * ratio
    pulses, turns = round(wanted), round(1 / wanted)
    if pulses >= 1 and abs(wanted / pulses - 1) <= WHOLE:
        many = f"{pulses} pulses" if pulses > 1 else "1 pulse"
        return f"; is pulses_per_revolution {pulses} ({many} a turn)?" if pulses != stated else ""
    if turns > 1 and abs(wanted * turns - 1) <= WHOLE:
        return f"; does it pulse once in {turns} turns, or lose pulses? It must pulse at least once a turn"
    return ""


def uneven(times_s: FloatArray) -> int:
    """Steps between pulses that are much longer or shorter than those around them: of lost and doubled pulses."""
    steps = np.diff(times_s)
    usual = median_filter(steps, size=min(AROUND, steps.size), mode="nearest")
    return int(np.sum((steps > LOST * usual) | (steps < TWICE * usual)))


def _mean_hz(times_s: FloatArray, irregular: int) -> float:
    """Pulses a second: the mean, or where some are lost or doubled that of the middle step."""
    if irregular:
        return float(1.0 / np.median(np.diff(times_s)))
    return float((times_s.size - 1) / (times_s[-1] - times_s[0]))
