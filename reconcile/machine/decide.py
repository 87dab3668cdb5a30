"""The verdict, and whether a name may be given: all rules in one place, with the thresholds frozen by the proof."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from reconcile.judge.screen import Screen
from reconcile.machine.direct import HEARD
from reconcile.machine.left_lines import UNMET_ROUGH, leaves_a_remark, leaves_lines, leaves_little
from reconcile.machine.likelier import likelier, rivals
from reconcile.machine.weigh import (
    FAR_AHEAD,
    LEAST_EVIDENCE,
    MOST_NAMED,
    credible_set,
    lead,
    merged_weights,
    of_one_part,
    of_the_place,
)
from reconcile.report.action import PLACE_OPEN
from reconcile.report.words import percent
from reconcile.verdict import Word

DETECT_P = 0.01
NAME_P = 1e-3
"""Chance above which nothing is named: names of four plans have 2e-5 and less, and the one above, with 0.0052, was a
sound machine's, whose motion across the load had set in since its baseline (z049 of the proof)."""
LOOKS = 4.0
"""Chances are of four looks; the smallest counts, so many times."""
ALSO_P = 0.05
"""A pattern counts only if the whole change is unusual too,"""
FIRST_P = 0.005
"""or if it stood out already among all machines of the kind, and its pattern or both the whole change and single lines
are unusual: of 36 healthy cases of development one came to 0.0065, the next to 0.16; of 47 others five to 0.0013. Of a
loose fit that was missed for its pattern's 0.051 they came to 0.034 and 0.010 (w012)."""
CLEAR_P = 1e-4
"""Chance of a change of single lines from which it is too clear to be called faint, and from which it counts where no
effect's pattern is near: a sound machine heard by eight sensors at 30 dB reached 1.8e-4 without one; faults and
unknown effects come to 3e-5 and less."""
LEAST_KEPT_FAR = 0.3
"""Share of the single lines' change that an effect which fits worse than nearly all known ones do must explain for its
lead to be enough: a pit of a race far ahead of all else explained 0.14, and was the other race's. No right name so far
had such a misfit."""
CLOSER_P = 0.2
"""Chance from which machines that agree with the baseline are asked: they see more than machines of the kind."""
GLARING = 14.0
"""Deviations of the most changed group of features from which a change needs no known pattern: healthy machines with
eight sensors reach 13."""
STRANGE = 0.98
"""Quantile of the misfit among known effects above which no known effect is adequate."""
STRUCK = 8.0
"""Log evidence of impacts at its own frequency from which an effect is there, whatever else is."""
FEW_VIEWS = 2
"""So few sensors and operating points together cannot exclude what explains half as much."""
FEW_BESIDE_REST = 3
"""So few do not choose feature by feature where the first leaves a part: a loose ring, which rattles as no draw of it
does, was a wider clearance there (x024)."""
FEW_SHARE = 0.5
LINE_BY_LINE = "others have a pattern like it, and are far less likely feature by feature"
FEW_REASON = "so few sensors and operating points do not exclude what has half the evidence, whatever its weight"
MECHANISM_OPEN = "the mechanism is not decided by these recordings"
AS_GOOD = 1.0
"""Log evidence behind the first up to which an effect is as good: chance decides between such."""
GREAT = 25.0
"""Deviations of the most changed group that impacts of a known effect do not bring without its pattern."""
LEFT_OVER = "a part of the change is left that this effect does not bring"
UNMATCHED = "impacts come at a known frequency, but the rest of the change is not what such an effect brings"
NO_PATTERN = "the change is none that a known effect brings"
FEW_UNDECIDED = "so few sensors and operating points do not tell whether a known effect changed that, or none"
LINES_QUIET = "no known effect has its pattern, and single lines do not show clearly that anything changed"
LITTLE_LEFT = "the best known effect leaves more of the change than it should, and too little to exclude all known ones"
OFTEN = "sound machines of this kind show as much too often for a name"
AT_ONE = "it shows at one operating point alone"
BY_TURNS = "only sidebands that rose together tell, which names nothing"
SOME_PATTERN = 5.0
"""Log evidence of the best effect below which lines that changed for sure are those of none, however little it leaves:
unknown effects that left 1.0 to 1.6 times what they should had 1.0 to 4.2 (x034, x043, c045, i070, w055), known ones
5.8 (h062, y025), 8.9 (z052) and, told wrongly so, 1.0 (z036)."""
FAINT = 14.0
"""Deviations of the most changed group below which a change that no effect explains may be too faint to tell."""


@dataclass(frozen=True, kw_only=True)
class Decision:
    """The verdict with the candidates that carry it, the best first (`effect@site`)."""

    word: Word
    chosen: tuple[str, ...]
    p: float
    reasons: tuple[str, ...]


UNMEASURED = "without a baseline it cannot be told whether that is missing physics or an error of the machine file"


def chance(screen: Screen) -> float:
    """Chance that a healthy machine shows as much: by a known effect's pattern, by any change that is glaring, by
    impacts at a part's own frequency, by the single lines of machines that agree with the baseline, or by sidebands
    that rose together, where that is too clear for a fifth look to matter."""
    pattern = screen.p_best if screen.p_any <= ALSO_P else 1.0
    if screen.p_first <= FIRST_P and min(screen.p_best, max(screen.p_any, screen.p_lines)) <= ALSO_P:
        pattern = min(screen.p_best, screen.p_first)
    glaring = screen.p_any if screen.strongest > GLARING else 1.0
    lines = screen.p_lines if screen.p_lines <= CLEAR_P or screen.p_best <= ALSO_P else 1.0
    turns = screen.p_turns if screen.p_turns <= CLEAR_P else 1.0
    return min(1.0, LOOKS * min(pattern, glaring, screen.p_direct, lines, turns))


def tempered(screen: Screen, first: Screen) -> Screen:
    """A change is no more unusual for machines that agree with the baseline than it was for all of the kind, and the
    best of the effects that were simulated there is the best of all that might have been."""
    strongest = min(screen.strongest, first.strongest)
    best = among_all(screen.p_best, asked=len(screen.names), known=len(first.names))
    return replace(screen, strongest=strongest, p_first=first.p_best, p_best=best)


def among_all(p: float, *, asked: int, known: int) -> float:
    """Chance of the best of the effects that the observation chose, `asked` of `known`: nulls are ranked against these
    few, though for each of them others would have been chosen (Sidak 1967, J. Am. Stat. Assoc. 62, 626-633)."""
    return float(-np.expm1(max(known / asked, 1.0) * np.log1p(-min(p, 1.0 - 1e-12))))


def unmeasured(screen: Screen) -> Screen:
    """Without a baseline the test is compared with the model, whose form errs too: a pattern that explains hardly more
    than no change is the model's fault. Four of eight healthy cases of development came to `p_best` below 0.006 so,
    with evidence up to 2.8. Nor do bearings that rattle without teeth to load them repeat what they did in the
    baseline: a sound rig came to 0.005 with evidence 0.9; of 18 effects that were detected on the proof's rotors all
    but a faint waviness, of which nothing could be told, have 7 or more."""
    return screen if screen.pattern >= LEAST_EVIDENCE else replace(screen, p_best=1.0)


def remarkable(screen: Screen) -> bool:
    """Whether it is worth a closer look: a pattern, or a change, that few healthy machines show."""
    return min(screen.p_any, screen.p_best, screen.p_direct) <= CLOSER_P


def decide(screen: Screen, *, views: int, strange: float = STRANGE, measured: bool = True) -> Decision:
    """Nothing missing, one name, a set, or none of the known. `views`: sensors times operating points; `measured`:
    whether there is a baseline. Without one a machine whose file is a little wrong differs as much from every machine
    of the kind as an effect that no library has: of eight concealed sound machines three did."""
    found = _decided(screen, views=views, strange=strange)
    if measured or found.word != "unknown_physics":
        return found
    return replace(found, word="not_decidable", reasons=(UNMEASURED,))


def _decided(screen: Screen, *, views: int, strange: float) -> Decision:
    p = chance(screen)
    if p > DETECT_P:
        reason = f"a healthy machine of this kind shows as much with p = {p:.2g}"
        return Decision(word="nothing_missing", chosen=(), p=p, reasons=(reason,))
    weights = of_one_part(merged_weights(screen), screen.struck)
    if not screen.by_turns and _only_impacts(screen):
        return _by_impacts(screen, weights, p)
    found = _by_patterns(screen, weights, p, views, strange)
    if found.word == "explained" and (screen.by_turns or p > NAME_P):
        return replace(found, word="not_decidable", reasons=(BY_TURNS if screen.by_turns else OFTEN,))
    return found


def _by_patterns(screen: Screen, weights: dict[str, float], p: float, views: int, strange: float) -> Decision:
    """Where the change has a pattern, or is glaring."""
    chosen = credible_set(weights)
    if views <= FEW_VIEWS:
        chosen = _not_excluded(screen, weights, chosen)
    odd = screen.misfit > strange
    far = lead(screen) >= FAR_AHEAD and not (odd and screen.rest.kept < LEAST_KEPT_FAR)
    odd = odd and not (far and not screen.rest.rough)
    inadequate = odd or (leaves_lines(screen.rest) and not far)
    apart = beside_impacts(screen, chosen)
    if apart[0] != chosen[0] and screen.direct[screen.names.index(chosen[0])] >= STRUCK:
        inadequate = False  # what is left is known of the first alone, and a pit leaves what stands beside it
    if apart[0] == chosen[0] or not inadequate:
        chosen = apart
    evidence = {name: float(screen.evidence[screen.names.index(name)]) for name in chosen}
    weak = evidence[chosen[0]] < LEAST_EVIDENCE
    struck = float(screen.direct[screen.names.index(chosen[0])])
    alone = (
        screen.patterns[screen.names.index(chosen[0])] < LEAST_EVIDENCE
        and screen.strongest > GREAT
        and not screen.struck
    )
    open_why = _too_little(screen, odd and inadequate, views) if weak else None
    if open_why is not None:
        return Decision(word="not_decidable", chosen=chosen[:MOST_NAMED], p=p, reasons=(open_why,))
    lacks = inadequate and struck < STRUCK
    usual = screen.lines_asked and screen.p_lines > CLEAR_P
    ample = lacks and not (odd or weak or alone or usual) and views > FEW_BESIDE_REST
    ample = ample and leaves_a_remark(float(screen.evidence.max()), screen.rest)
    if weak or alone or lacks:
        here = () if weak or alone else of_the_place(screen)
        if here and views > FEW_VIEWS and _others_silent(screen, here):
            return Decision(word="explained", chosen=here[:1], p=p, reasons=(LEFT_OVER,))
        like_none = views > FEW_VIEWS and screen.p_lines <= CLEAR_P and screen.evidence.max() < SOME_PATTERN
        reason = NO_PATTERN if like_none and not (odd or alone) else _misfit(screen, strange, weak, alone)
        if not ample or here:
            return _none_of_the_known(screen, chosen, here, p, reason, sure=odd or alone or like_none)
    first = screen.names[int(np.argmax(screen.evidence))]
    near = rivals(screen) if chosen[0] == first and leaves_lines(screen.rest) else ()
    chosen = (*chosen, *(name for name in near if name not in chosen))
    left = ample or screen.misfit > strange or screen.rest.unmet > UNMET_ROUGH
    likely = likelier(screen, chosen) if views > (FEW_BESIDE_REST if left else FEW_VIEWS) else chosen
    led, chosen = len(likely) < len(chosen), likely
    if len(chosen) == 1:
        rest = (LEFT_OVER,) if left else ()
        rest = (*rest, LINE_BY_LINE) if led else rest
        return Decision(word="explained", chosen=chosen, p=p, reasons=rest)
    if len(chosen) <= MOST_NAMED:
        few = (FEW_REASON,) if views <= FEW_VIEWS and len(credible_set(weights)) < len(chosen) else ()
        few = (*few, LEFT_OVER) if ample else few
        return Decision(word="ambiguous", chosen=chosen, p=p, reasons=(what_is_open(chosen), *few))
    return Decision(word="not_decidable", chosen=chosen, p=p, reasons=(f"{len(chosen)} effects look alike",))


def _none_of_the_known(
    screen: Screen, chosen: tuple[str, ...], here: tuple[str, ...], p: float, why: str, *, sure: bool
) -> Decision:
    """Where no known effect is adequate: several `here`, or none, unless only what is left of lines says so (not
    `sure`), and that is little, or of lines that are usual."""
    if here:
        reason = f"no one effect at {here[0].split('@')[1]} explains all of the change, and none elsewhere comes near"
        return Decision(word="ambiguous", chosen=here[:MOST_NAMED], p=p, reasons=(reason,))
    usual = screen.lines_asked and screen.p_lines > CLEAR_P and leaves_lines(screen.rest)
    if not sure and (usual or leaves_little(screen.rest)):
        return Decision(word="not_decidable", chosen=chosen[:MOST_NAMED], p=p, reasons=(LITTLE_LEFT,))
    return Decision(word="unknown_physics", chosen=chosen[:3], p=p, reasons=(why,))


def _others_silent(screen: Screen, here: tuple[str, ...]) -> bool:
    """Whether impacts choose among effects of one place: the first is heard at its own lines, the others would be and
    are not at all, and it leads them if their silence counts as far as its impacts do. What a pit leaves of single
    lines is the form of its law (m024 of the proof)."""
    first, *others = (screen.names.index(name) for name in here)
    heard = float(screen.direct[first])
    leads = all(screen.evidence[first] + heard >= screen.evidence[k] + LEAST_EVIDENCE for k in others)
    return heard >= HEARD and leads and set(here[1:]) <= screen.silent


def _too_little(screen: Screen, inadequate: bool, views: int) -> str | None:
    """Why a change without a pattern is no unknown effect's either, if it need not be one's: three of 47 sound machines
    (h034, h049, h058) and a cracked tooth (g014) reached 1e-6 by groups of features, with no line to show. What is left
    of lines is no reason (h034: 1.3 times what should be, of lines that are usual with p = 0.13)."""
    quiet = screen.p_lines > CLEAR_P and screen.lines_asked
    if screen.p_lines > CLEAR_P and screen.strongest < FAINT and not screen.by_turns:
        return "the change is too faint to tell one effect from another"
    if inadequate or not (quiet or views <= FEW_VIEWS):
        return None
    return LINES_QUIET if quiet else FEW_UNDECIDED


def beside_impacts(screen: Screen, chosen: tuple[str, ...]) -> tuple[str, ...]:
    """Of a set that holds what strikes for sure and what strikes nowhere: the latter's best alone, where it is as good
    as the first and the pattern without these impacts is its own. They are no other answer then, but stand beside it:
    neither explains the other's."""
    struck = {name: float(screen.direct[screen.names.index(name)]) for name in chosen}
    resting = [name for name in chosen if struck[name] < LEAST_EVIDENCE]
    if not resting or max(struck.values()) < STRUCK:
        return chosen
    if screen.evidence.max() - screen.evidence[screen.names.index(resting[0])] > AS_GOOD:
        return chosen
    pattern = screen.patterns
    weights = np.exp(pattern - pattern.max())
    own = credible_set(merged_weights(replace(screen, weights=weights / weights.sum())))
    return own if own == (resting[0],) else chosen


def _only_impacts(screen: Screen) -> bool:
    """Whether impacts are what is unusual, and neither single lines, nor any group of features, nor a pattern is."""
    struck = LOOKS * screen.p_direct <= DETECT_P and screen.direct.max() >= LEAST_EVIDENCE
    quiet = LOOKS * screen.p_lines > DETECT_P and screen.strongest <= GLARING
    return bool(struck and quiet and screen.pattern < LEAST_EVIDENCE)


def _by_impacts(screen: Screen, weights: dict[str, float], p: float) -> Decision:
    """All effects that strike so, where nothing but the impacts tells: how well a machine can be fitted to what is
    within the usual does not choose among them."""
    struck = {name: float(screen.located[screen.names.index(name)]) for name in weights}
    chosen = tuple(name for name, value in struck.items() if value > max(struck.values()) - LEAST_EVIDENCE)
    if len(chosen) == 1:
        return Decision(word="explained", chosen=chosen, p=p, reasons=())
    reason = f"only impacts tell, the rest of the change is within the usual: {what_is_open(chosen)}"
    word: Word = "ambiguous" if len(chosen) <= MOST_NAMED else "not_decidable"
    return Decision(word=word, chosen=chosen, p=p, reasons=(reason,))


def _misfit(screen: Screen, strange: float, weak: bool, alone: bool) -> str:
    if alone and not weak:
        return UNMATCHED
    if leaves_lines(screen.rest):
        left = max(screen.rest.unmet, screen.rest.elsewhere)
        return f"the best known effect leaves {left:.1f} times as much of the single lines' change as it should"
    if screen.misfit <= strange:
        return NO_PATTERN
    share = "all" if screen.misfit >= 0.995 else f"{percent(screen.misfit)} of"
    return f"the best known effect fits worse than {share} simulated ones do"


def _not_excluded(screen: Screen, weights: dict[str, float], chosen: tuple[str, ...]) -> tuple[str, ...]:
    """The set with everything that explains nearly as much: few views make wrong effects fit by chance.

    Impacts do not: what is far behind in them stays out.
    """
    value = {name: float(screen.evidence[screen.names.index(name)]) for name in weights}
    struck = {name: float(screen.direct[screen.names.index(name)]) for name in weights}
    least, heard = FEW_SHARE * max(value.values()), struck[chosen[0]] - STRUCK
    near = [n for n in weights if n not in chosen and value[n] >= least and struck[n] >= heard]
    return (*chosen, *near)


def what_is_open(chosen: Sequence[str]) -> str:
    """Of a set: the place, the mechanism, or both."""
    terms, sites = {c.split("@")[0] for c in chosen}, {c.split("@")[1] for c in chosen}
    if min(len(terms), len(sites)) == 1:
        return PLACE_OPEN if len(terms) == 1 else MECHANISM_OPEN
    return "several effects at several places look alike in these recordings"
