"""Whether a law may be named, and what to call it."""

from __future__ import annotations

from dataclasses import dataclass

from reconcile.driven.forced import ALPHA, Analysis
from reconcile.driven.machine import OWN_LAW, term_key
from reconcile.driven.model import LINEAR
from reconcile.driven.nominate import Trial, leads
from reconcile.verdict import Word

PLACEBO_SHARE = 0.25
"""A placebo may reach this share of the gain at most."""


@dataclass(frozen=True, kw_only=True)
class Judgement:
    """The verdict, the rules for a name that failed, and the laws that could not be told from the best."""

    verdict: Word
    reasons: tuple[str, ...]
    rivals: tuple[Trial, ...]


def _rivals(found: Analysis) -> tuple[Trial, ...]:
    """Other single laws within the lead of the best one."""
    if found.nominated is None or not found.nominated.chosen.laws:
        return ()
    best = found.nominated.singles[0]
    return tuple(other for other in found.nominated.singles[1:] if not leads(other.squares, best.squares))


def _reasons(found: Analysis) -> tuple[str, ...]:
    failed = []
    for i in range(len(found.final.model.laws)):
        value, low, high = found.final.interval(LINEAR + i)
        if low <= 0.0 <= high:
            law = found.final.model.laws[i]
            failed.append(f"the interval of {law.shown()} includes zero ({low:.3g} to {high:.3g} around {value:.3g})")
    for v in found.validations:
        where = f"fitted on {v.fitted_on}, held out {v.held}"
        if v.gain[1] <= max(v.retuned, 0.0):
            failed.append(f"{where}: gain not above that of a linear retuning")
        if v.placebo > PLACEBO_SHARE * v.gain[0]:
            failed.append(f"{where}: a placebo gains {100 * v.placebo:.0f} %")
    return tuple(failed)


def judge(found: Analysis) -> Judgement:
    """Apply the rules in order: something missing, a law that survived, alone, better than its rivals."""
    if found.missing.p_value >= ALPHA:
        return Judgement(verdict="nothing_missing", reasons=(), rivals=())
    laws = found.final.model.laws
    if not laws:
        return Judgement(verdict="unknown_physics", reasons=("no law earned its place in a free run",), rivals=())
    reasons, rivals = _reasons(found), _rivals(found)
    if reasons:
        return Judgement(verdict="unknown_physics", reasons=reasons, rivals=rivals)
    if rivals:
        return Judgement(verdict="ambiguous", reasons=(), rivals=rivals)
    known = any(term_key(law) != OWN_LAW for law in laws)
    return Judgement(verdict="explained" if known else "unknown_physics", reasons=(), rivals=())
