"""Verdicts, levels and figures in a reader's words."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence

from reconcile.report.markup import figure_text, power_of
from reconcile.verdict import Cause, HeldOut, Level, Placebo, Report, Severity, Word

VERDICT: dict[Word, tuple[str, str]] = {
    "nothing_missing": ("Nothing missing", "ok"),
    "explained": ("Explained: cause named", "warn"),
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
MOST_DIGITS, MOST_PLACES = 6, 2
OWN_LAW = "custom_force"
CALLED_BY_LAW = (OWN_LAW, "cubic_support")
"""Effects that are called by the words of their law of force, where one was found."""
SCIENTIFIC = 3
"""Figures of a number with a power of ten: two would say less than is known of a stiffness that has no prefix."""
WIDTH_BELOW = "width_below_m"
"""Value of a cause that bounds the width of a defect whose edges are not told apart."""
LAWS = {
    "quadratic": "even stiffness",
    "cubic": "cubic support, odd stiffness",
    "quintic": "odd stiffness, fifth power",
    "odd_square": "odd stiffness, square",
    "odd_power": "odd stiffness",
    "root": "square root",
    "contact_above": "one-sided spring",
    "contact_below": "one-sided spring",
    "hertz_above": "one-sided Hertz contact",
    "hertz_below": "one-sided Hertz contact",
    "stops": "stops on both sides",
    "dry_friction": "dry friction",
    "drag": "quadratic damping",
    "cubic_drag": "cubic damping",
    "van_der_pol": "damping that grows with the swing",
}
"""Words of the laws by the names of their coefficients (`reconcile.force_law.library`)."""

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
    return "–" if share is None or not math.isfinite(share) else f"{round(100 * share):.0f} %"


def weight(share: float) -> str:
    """A share of the weight; what is nearly all of it is not told as all."""
    return "more than 99 %" if 0.995 <= share < 1.0 - 1e-9 else percent(share)


def distance(value: float, unit: str) -> str:
    """How far a model is off: with its unit, or of none as per cent, as the sentence has it."""
    return f"{figure_text(100 * value, digits=2)} %" if unit in ("", "1") else figure_text(value, unit)


def sizes(found: Severity) -> tuple[str, str, str]:
    """Value and ends of the interval in one unit, to two figures as in the sentence (three with a power of ten), or as
    many as part the ends."""
    power = power_of(max((v for v in (found.high, found.value) if math.isfinite(v)), key=abs, default=0.0), found.unit)
    for digits in range(2, MOST_DIGITS + 1):
        value, low, high = (figure_text(v, found.unit, digits, power) for v in (found.value, found.low, found.high))
        enough = digits >= SCIENTIFIC or not any("e+" in x or "e-" in x for x in (value, low, high))
        if enough and (low != high or found.low == found.high):
            break
    return value, low, high


def severity(found: Cause) -> str:
    """`gap 12 µm (90 %: 10 µm to 14 µm)`, or `width at most 2 mm` where a bound is all that is known; nothing where no
    size is. A size that is called as the effect is has no name of its own."""
    if found.severity is None:
        below = found.values.get(WIDTH_BELOW)
        return "" if below is None else f"width less than {figure_text(float(below), 'm', digits=2)}"
    value, low, high = sizes(found.severity)
    said = f"at most {high} (90 %)" if found.severity.low == 0.0 else f"{value} (90 %: {low} to {high})"
    return f"{size_name(found)} {said}".strip()


def effect(found: Cause) -> str:
    """The effect in words: `fit clearance`, or of a law of force its own words, `stops on both sides`."""
    size = "" if found.severity is None else found.severity.name
    return LAWS[size] if found.term in CALLED_BY_LAW and size in LAWS else found.term.replace("_", " ")


def size_name(found: Cause) -> str:
    """What the size is: `gap`; nothing where that says no more than the effect's name."""
    size = "" if found.severity is None else found.severity.name
    return "" if size in LAWS or size == found.term else size.replace("_", " ")


def cause(found: Cause) -> str:
    """Effect and site."""
    return f"{effect(found)} at {found.site}" if found.site else effect(found)


def changed_or_added(found: Cause) -> str:
    """What is with the model where it does better: the effect, or the change of a number that the machine has."""
    is_number = found.severity is not None and found.severity.name == found.term
    return f"the change of {cause(found)}" if is_number else cause(found)


def cause_key(found: Cause) -> str:
    """`outer_spall@bearing1`; of a law of force that is no effect of its own the law, `stops@mass`."""
    size = "" if found.severity is None else found.severity.name
    return f"{size if found.term == OWN_LAW and size in LAWS else found.term}@{found.site}"


def known(share: float | None) -> bool:
    """Whether a share is there to be told."""
    return share is not None and math.isfinite(share)


def gains(found: HeldOut) -> tuple[str, str, str]:
    """Gain and ends of its interval in per cent: whole ones, or to as many places as part the ends."""
    values = (found.gain, found.gain_low, found.gain_high)
    if not all(math.isfinite(v) for v in values):
        return percent(values[0]), percent(values[1]), percent(values[2])
    for places in range(MOST_PLACES + 1):
        value, low, high = (f"{round(100 * v, places) + 0.0:.{places}f} %" for v in values)
        if low != high or found.gain_low == found.gain_high:
            break
    return value, low, high


def gain(found: HeldOut) -> str:
    """`31 % (90 %: 25 % to 36 %)`."""
    value, low, high = gains(found)
    return f"{value} (90 %: {low} to {high})"


def tidied(detail: str) -> str:
    """What was seen of a fault, with shares to three figures and one stretch as one."""
    shares = re.sub(r"\b(\d+\.\d{3})%", lambda m: f"{figure_text(float(m[1]))} %", detail)
    return re.sub(r"\b1 stretches, the first at", "one stretch,", shares)


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
