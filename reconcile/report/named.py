"""Effects and shares as the page shows them: by the name that the sentence gives, and zero as zero."""

from __future__ import annotations

from reconcile.report import words
from reconcile.verdict import Cause

CALLED = {"missing tooth": "broken tooth", "fit clearance series": "fit clearance, elastic housing"}
"""Names of effects that the sentence has otherwise than their keys."""
NO_SCORE = 0.005
"""Of a score less is none."""


def _called(text: str) -> str:
    for key, name in CALLED.items():
        text = text.replace(key, name)
    return text


def readable(label: str) -> str:
    """`fit_clearance@bearing1` as `fit clearance at bearing1`."""
    term, _, site = label.partition("@")
    return f"{_called(term.replace('_', ' '))} at {site}" if site else label


def cause(found: Cause) -> str:
    """Effect and site."""
    effect = _called(words.effect(found))
    return f"{effect} at {found.site}" if found.site else effect


def changed_or_added(found: Cause) -> str:
    """What is with the model where it does better: the effect, or the change of a number that the machine has."""
    return words.changed_or_added(found).replace(words.cause(found), cause(found))


def percent(share: float | None) -> str:
    """A share as whole per cent, of which none is negative and zero; a dash where there is none."""
    said = words.percent(share)
    return "0 %" if said == "-0 %" else said


def score(value: float) -> str:
    """To three figures; what is next to nothing as 0."""
    return f"{value:.3g}" if abs(value) >= NO_SCORE else "0"
