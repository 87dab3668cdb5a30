"""Whether a law may be named, and what to call it."""

from __future__ import annotations

from dataclasses import dataclass

from reconcile.driven.forced import ALPHA, Analysis, Validation
from reconcile.driven.form import form
from reconcile.driven.model import LINEAR
from reconcile.driven.nominate import Trial, leads
from reconcile.driven.settle import LOST
from reconcile.shares import two_digits
from reconcile.verdict import Word

OVER_PLACEBO = 0.75
"""Share of the gain over the linear model that must be left of it over the placebo.

Of a small gain g the placebo may then take a quarter, as ever. Of a large one it may take more: a law that leaves 0.06
of the error where a placebo leaves 0.5 gains 0.87 over it. Both are asked on the part that the report shows, for the
law must be found there; the way back tells whether it holds for another motion (`retuned`).
"""

OVER_PLACEBO_OF_NOISE = 0.5
"""The same where what the law leaves is noise: no law gains more there. Of 8.6 % of an acceleration quadratic damping
left 0.5 %, its noise, and its placebo (cubic damping) 1.5 %: it gains 0.94, and 0.67 over that."""

UNRELATED = 0.9
"""Share of the output that even the fitted linear model leaves, from which the output does not follow the input: that
nothing more explains it then says nothing of the machine."""
ROUGH, BLIND = 0.05, 0.05
"""Share of the output that a linear model leaves, and of that error's power what chance explains, from which on
"nothing missing" would be too much said: of 450 samples of a red error eight laws explain 11 % by chance. A law that
leaves as much, and not as noise, is not named: hysteresis and a spring like a sine were called square springs where 12
and 18 % were left, the right laws leave 0.5 to 2.8 %."""
FARTHER = 3.0
"""How many times more than where they were fitted laws leave of the part held out, from which they do not hold there
alike: a cubic spring beside which a square one was missing left 4.7 and 31 % (0.7 and 8 to 26 %), right laws at
most 2.4 times as much, but for stiff springs whose free run takes another branch (0.4 and 5, 0.5 and 28 %)."""
NOT_ALL = "what the laws leave is not noise"
BRANCHES = (
    "the free run is at the mercy of the numbers: led by the output it follows, free it leaves for another branch of "
    "the motion, and whether what it leaves is noise cannot be told"
)
TOO_FEW = "the recordings are too short to tell whether what a linear model leaves is noise"
NO_RELATION = "no linear model explains the output by the input, and nothing that is tried adds to it"


@dataclass(frozen=True, kw_only=True)
class Judgement:
    """The verdict, the rules for a name that failed, and the laws that could not be told from the best."""

    verdict: Word
    reasons: tuple[str, ...]
    rivals: tuple[Trial, ...]
    form: str = ""
    """`restoring` or `damping` where the laws are only a curve through such a force (`reconcile.driven.form`), and
    nothing speaks against the set as a whole."""


def _rivals(found: Analysis) -> tuple[Trial, ...]:
    """Other single laws within the lead of the best one."""
    if found.nominated is None or not found.nominated.chosen.laws:
        return ()
    chosen, singles = found.nominated.chosen, found.nominated.singles
    best = chosen if len(chosen.laws) == 1 else singles[0]
    others = [t for t in singles if t.laws[0].key != best.laws[0].key]
    return tuple(other for other in others if not leads(other.squares, best.squares))


def _of_law(found: Analysis, i: int) -> tuple[str, str]:
    """Why a law may as well not be there, and why it is none of a passive part; empty where neither."""
    value, low, high = found.final.interval(LINEAR + i)
    law = found.final.model.laws[i]
    if low <= 0.0 <= high:
        return f"the interval of {law.shown()} includes zero ({low:.3g} to {high:.3g} around {value:.3g})", ""
    if law.rate and value < 0.0:
        return "", f"{law.words} ({law.shown()}) of this sign feeds energy in, which no passive part does"
    return "", ""


def _reasons(found: Analysis) -> tuple[str, ...]:
    failed = [why for i in range(len(found.final.model.laws)) for why in _of_law(found, i) if why]
    for v in found.validations:
        where = f"fitted on {v.fitted_on}, held out {v.held}"
        if v.gain[1] <= max(v.retuned, 0.0):
            failed.append(f"{where}: gain not above that of a linear retuning")
        if v.diverged:
            failed.append(f"{where}: the free run with the law diverges")
    noise = found.left is not None and found.left.p_value >= ALPHA and found.left.null_95 < BLIND
    failed += _no_better_than_placebo(found.validations[0], noise) if found.validations else ()
    rough = bool(found.validations) and found.validations[0].after > ROUGH
    seen = found.left is not None and found.left.p_value < ALPHA
    beyond = rough and not led(found) and found.beyond_noise > ROUGH
    if ((rough or found.dropped or led(found)) and seen) or beyond:
        failed.append(NOT_ALL)
    elif not found.unsure and lost(found):
        failed.append(leaves_more(found))
    return tuple(failed)


def leaves_more(found: Analysis) -> str:
    """What the laws leave where they were fitted and on the part held out, where that is clearly more; else nothing."""
    if not found.validations or not found.final.model.laws:
        return ""
    v = found.validations[0]
    if v.led or v.diverged or v.after < max(FARTHER * found.laws_leave, ROUGH):
        return ""
    return f"the laws leave {two_digits(v.after)} on {v.held}, {two_digits(found.laws_leave)} where they were fitted"


def lost(found: Analysis) -> bool:
    """Whether the laws leave more on the part held out, and as much as a run on another branch of the motion."""
    return bool(leaves_more(found)) and found.validations[0].after >= LOST


def led(found: Analysis) -> bool:
    """Whether a free run says nothing, and one was led instead."""
    return any(v.led for v in found.validations)


def _no_better_than_placebo(v: Validation, noise: bool = False) -> tuple[str, ...]:
    """The rule that a placebo must leave clearly more, if it fails; `noise`: what the law leaves is no more."""
    over, low, high = v.over_placebo
    if low > 0.0 and over >= (OVER_PLACEBO_OF_NOISE if noise else OVER_PLACEBO) * v.gain[0]:
        return ()
    said = f"gains {100 * over:.0f} % (90 %: {100 * low:.0f} to {100 * high:.0f} %) over a placebo"
    return (f"fitted on {v.fitted_on}, held out {v.held}: the law {said}",)


def _of_single_laws(found: Analysis, reasons: tuple[str, ...]) -> bool:
    """Whether the reasons speak against single laws of a set that holds as a whole, as a curve: one that the part held
    out did not ask for, or that may be zero. Which of three laws stays then hangs on the last digits of a processor,
    what the set leaves does not (tanh: 0.5 to 1.1 % with two laws or three)."""
    if led(found) or lost(found) or not found.validations or found.validations[0].after > ROUGH:
        return not reasons
    count = len(found.final.model.laws)
    zero = [_of_law(found, i)[0] for i in range(count)] if count > 1 else []
    return all(reason in (NOT_ALL, *zero) for reason in reasons)


def _nothing(found: Analysis) -> Judgement:
    """Where the test finds no cause: nothing is missing, unless too much is left to say so."""
    if found.fitted_nrmse > UNRELATED:
        return Judgement(verdict="not_decidable", reasons=(NO_RELATION,), rivals=())
    if found.fitted_nrmse > ROUGH and found.missing.null_95 > BLIND:
        return Judgement(verdict="not_decidable", reasons=(TOO_FEW,), rivals=())
    return Judgement(verdict="nothing_missing", reasons=(), rivals=())


def judge(found: Analysis) -> Judgement:
    """Apply the rules in order: something missing, a law that survived, alone, better than its rivals."""
    if found.missing.p_value >= ALPHA:
        return _nothing(found)
    laws = found.final.model.laws
    if not laws:
        return Judgement(verdict="unknown_physics", reasons=("no law earned its place in a free run",), rivals=())
    reasons, rivals = _reasons(found), _rivals(found)
    if reasons == (NOT_ALL,) and led(found):
        return Judgement(verdict="not_decidable", reasons=(BRANCHES, *reasons), rivals=rivals)
    kind, curved = form(found)
    if reasons or curved:
        only = kind if _of_single_laws(found, reasons) else ""
        return Judgement(verdict="unknown_physics", reasons=(*reasons, *curved), rivals=rivals, form=only)
    if rivals:
        return Judgement(verdict="ambiguous", reasons=(), rivals=rivals)
    return Judgement(verdict="explained", reasons=(), rivals=())
