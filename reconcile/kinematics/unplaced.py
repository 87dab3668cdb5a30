"""Strong lines that no part makes at a stated speed which no line confirms: then silence says nothing.

All that is looked for hangs on the speed. Where the label is right and the shaft silent, lines that strong would have
to be another machine's; mostly the label is wrong, and too few lines stand to tell by how much.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from reconcile.gate.mains import NONE_HZ, power_at
from reconcile.gate.tones import BESIDE_DB, PRESENT_DB, Heard
from reconcile.kinematics.answer import PARTS
from reconcile.kinematics.candidate import DEFECTS, Candidate
from reconcile.kinematics.elsewhere import ADVICE
from reconcile.kinematics.families import Ties
from reconcile.kinematics.observe import Observation
from reconcile.shares import percent
from reconcile.speed.estimate import SEARCH
from reconcile.speed.excess import line_excess
from reconcile.verdict import Report
from signals.series import FloatArray

STRONG = 0.1
"""Of a channel's power that the lines of no part hold."""
LOWEST, HIGHEST = 0.3, 2.7
"""Times the stated speed between which lines are looked for: a tenth to either side of higher multiples is nearly
everything."""
MULTIPLES = (1, 2, 3)
SAME = 0.005
"""Relative difference up to which a line near a part's is a multiple of one that is no part's."""
MOST = 3
"""Lines that are told."""
RISEN_Z = 5.0
"""Robust deviations over orders of no part from which a bearing's lines that rose are more than chance. A deep race's
pit under twice its speed has 12, its second harmonic being the drawing's first."""


def with_unplaced(report: Report, tie: Ties, tests: Sequence[Observation]) -> Report:
    """The report; none of a sound machine where nothing confirms the speed of the tests and strong lines stand in each
    that no part makes within a tenth of it, while no line stands where the shaft's first two would."""
    if report.verdict != "nothing_missing" or any(t.speed.method != "stated" for t in tests):
        return report
    told = [_unplaced(t, tie) for t in tests]
    if not told or not all(told):
        return report
    first = tests[0].speed
    note = f"whether {first.shaft} turns at {first.speed_hz:.4g} Hz as stated: no line confirms it"
    where = "; ".join(f"{t.label}: {text}" for t, text in zip(tests, told, strict=True))
    return replace(
        report,
        verdict="not_decidable",
        sentence=f"The speed is not decided: no line confirms the stated {first.speed_hz:.4g} Hz, and at it no part "
        f"makes the strong lines that stand ({where}). At that speed: {report.sentence}",
        undecidable=(note, *report.undecidable),
        next_experiment=ADVICE,
    )


def with_risen(report: Report, every: Sequence[Candidate], tests: Sequence[Observation]) -> Report:
    """The report; none of a sound machine where nothing confirms the speed of the tests and lines of a bearing rose
    all the same, though not as firmly as a defect's at its own speed do."""
    if report.verdict != "nothing_missing" or any(t.speed.method != "stated" for t in tests):
        return report
    risen = [c for c in every if c.family.kind in DEFECTS and c.risen and c.z >= RISEN_Z]
    if not risen:
        return report
    best, first = max(risen, key=lambda c: c.z), tests[0].speed
    note = f"whether {first.shaft} turns at {first.speed_hz:.4g} Hz as stated: no line confirms it"
    return replace(
        report,
        verdict="not_decidable",
        sentence=f"The speed is not decided: no line confirms the stated {first.speed_hz:.4g} Hz, and at it lines of "
        f"{PARTS[best.family.kind]} of {best.family.site} rose ({best.z:.1f} robust deviations), less firmly than a "
        "defect's do at the right speed.",
        undecidable=(note, *report.undecidable),
        next_experiment=ADVICE,
    )


def _unplaced(test: Observation, tie: Ties) -> str:
    """Lines of no part and the share of the power that they hold, in the channel where it is largest; empty where that
    is little, or where the shaft itself may have a line in any channel."""
    stated = test.speed.speed_hz
    turns = [k * r for r in tie.shafts.values() for k in MULTIPLES]
    parts = np.array([*turns, *(f.order for f in tie.families if f.kind != "turn")]) * stated
    best, said = STRONG, ""
    for name in test.recording.names:
        series = test.recording.series(name)
        heard = Heard(*line_excess(series), stated, NONE_HZ)
        strange = [hz for hz in _within(heard, PRESENT_DB) if _nearest(hz, parts) > SEARCH]
        if any(_own(hz, strange, heard) for hz in _within(heard, BESIDE_DB)):
            return ""
        share = power_at(test.recording, name, strange) / max(float(np.var(series.samples)), 1e-300) if strange else 0.0
        if share > best:
            places = ", ".join(f"{hz:.4g}" for hz in sorted(strange[:MOST]))
            best, said = share, f"at {places} Hz, {percent(share)} of the power of {name}"
    return said


def _within(heard: Heard, least_db: float) -> list[float]:
    """Narrow lines not too far from the speed, the strongest first, Hz."""
    found = heard.peaks(least_db, narrow=True)
    return [hz for hz in found if LOWEST * heard.speed_hz <= hz <= HIGHEST * heard.speed_hz]


def _nearest(hz: float, parts_hz: FloatArray) -> float:
    """Relative distance from the nearest line of a part."""
    return float(np.min(np.abs(hz / parts_hz - 1.0)))


def _own(hz: float, strange: Sequence[float], heard: Heard) -> bool:
    """Whether a line may be the shaft's first or second, and is no multiple of one that is no part's. Lines are known
    to half a bin."""
    if not any(abs(hz / (k * heard.speed_hz) - 1.0) <= SEARCH for k in (1, 2)):
        return False
    multiples = [(round(hz / one), one) for one in strange]
    return all(abs(hz - k * one) > max(SAME * hz, (k + 1) * heard.step_hz / 2) for k, one in multiples)
