"""Verdicts, levels and figures in a reader's words."""

from __future__ import annotations

from reconcile.report.markup import figure_text
from reconcile.verdict import Cause, HeldOut, Level, Severity, Word

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


def percent(share: float | None) -> str:
    """A share as per cent; a dash where there is none."""
    return "–" if share is None else f"{100 * share:.0f} %"


def severity(found: Severity) -> str:
    """`gap 12 µm (90 %: 10 µm to 14 µm)`."""
    value, low, high = (figure_text(v, found.unit) for v in (found.value, found.low, found.high))
    return f"{found.name} {value} (90 %: {low} to {high})"


def cause(found: Cause) -> str:
    """Term and site."""
    return f"{found.term.replace('_', ' ')} at {found.site}" if found.site else found.term.replace("_", " ")


def gain(found: HeldOut) -> str:
    """`31 % (90 %: 25 to 36)`."""
    return f"{percent(found.gain)} (90 %: {100 * found.gain_low:.0f} to {100 * found.gain_high:.0f})"
