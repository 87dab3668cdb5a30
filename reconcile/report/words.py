"""Verdicts, levels and figures in a reader's words."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from reconcile.report.markup import figure_text
from reconcile.verdict import Cause, HeldOut, Level, Placebo, Report, Severity, Word

VERDICT: dict[Word, tuple[str, str]] = {
    "nothing_missing": ("Nothing missing", "ok"),
    "explained": ("Explained", "warn"),
    "ambiguous": ("One of several", "warn"),
    "unknown_physics": ("Unknown physics", "bad"),
    "measurement_fault": ("Fault in the measurement", "bad"),
    "not_decidable": ("Not decidable", "warn"),
}
"""Words and tone of the badge."""

LEVEL: dict[Level, str] = {
    "machine": "compared with a simulation of the whole machine",
    "kinematics": "compared by the frequencies of the drawing; no model of the machine",
    "driven": "compared with a model driven by the measured input",
}


FORMS = (
    "“or” names another form of the same effect: a law for the same part that excludes it there, so that at most one "
    "of them is true; their evidence counts together, under the strongest."
)
MOST_DIGITS = 6

PART_LEFT = "a part of the change is left"
"""How the reason begins that an effect is named with, although it does not bring all of the change."""
LEFT_OVER = (
    "A part of the change is left that the named effect does not bring: either something else has changed as well, or "
    "the effect is not quite as its law here has it. Take the name as a lead and the size as rough, look for a second "
    "cause before repairing, and record at one more speed or load to tell."
)


def leaves_a_part(found: Sequence[Cause]) -> bool:
    """Whether an effect is named although a part of the change is left."""
    return any(c.named and any(r.startswith(PART_LEFT) for r in c.reasons) for c in found)


def readable(label: str) -> str:
    """`fit_clearance@bearing1` as `fit clearance at bearing1`."""
    term, _, site = label.partition("@")
    return f"{term.replace('_', ' ')} at {site}" if site else label


def forms(found: Cause) -> str:
    """`or: bearing stiffness (41.8), squeeze film (33.7)`; nothing where there is one form only."""
    others = ", ".join(f"{term.replace('_', ' ')} ({score:.3g})" for term, score in found.forms.items())
    return f"or: {others}" if others else ""


def percent(share: float | None) -> str:
    """A share as per cent; a dash where there is none."""
    return "–" if share is None or not math.isfinite(share) else f"{100 * share:.0f} %"


def distance(value: float, unit: str) -> str:
    """How far a model is off: with its unit, or of none as per cent, as the sentence has it."""
    return f"{figure_text(100 * value, digits=2)} %" if unit in ("", "1") else figure_text(value, unit)


def sizes(found: Severity) -> tuple[str, str, str]:
    """Value and ends of the interval, to two figures as in the sentence, or as many as part the ends."""
    for digits in range(2, MOST_DIGITS + 1):
        value, low, high = (figure_text(v, found.unit, digits=digits) for v in (found.value, found.low, found.high))
        if low != high or found.low == found.high:
            break
    return value, low, high


def severity(found: Severity) -> str:
    """`gap 12 µm (90 %: 10 µm to 14 µm)`, or `width at most 2 mm` where a bound is all that is known."""
    value, low, high = sizes(found)
    if found.low == 0.0:
        return f"{found.name} at most {high} (90 %)"
    return f"{found.name} {value} (90 %: {low} to {high})"


def cause(found: Cause) -> str:
    """Term and site."""
    return f"{found.term.replace('_', ' ')} at {found.site}" if found.site else found.term.replace("_", " ")


def gain(found: HeldOut) -> str:
    """`31 % (90 %: 25 % to 36 %)`."""
    return f"{percent(found.gain)} (90 %: {percent(found.gain_low)} to {percent(found.gain_high)})"


def compared(report: Report) -> str:
    """Of which machine, which files against which: `bearing-rig: now.json, against sound.json as the baseline,`."""
    sent = report.provenance.get("sent_as")
    names = dict(sent) if isinstance(sent, Mapping) else {}
    tests = [str(v) for k, v in names.items() if str(k).startswith("test")]
    rested = [str(v) for k, v in names.items() if str(k).startswith("baseline")]
    machine = report.provenance.get("machine")
    what = ", ".join(tests) or ("Recordings" if len(tests) > 1 else "Recording")
    against = f", against {', '.join(rested)} as the baseline," if rested else ""
    return f"{machine}: {what}{against}" if machine else f"{what}{against}"


def strongest_placebo(found: HeldOut) -> Placebo | None:
    """Of those forecast the one that gains most."""
    return max(found.placebos, key=lambda one: one.gain, default=None)


def reached(found: HeldOut) -> float | None:
    """The gain expected of a perfect model; None where drift and noise leave it none to speak of."""
    return found.ceiling if found.ceiling is not None and found.ceiling > 0.0 else None
