"""Which of several effects it is, by what each forecasts of data that it was not fitted to.

The screen asks how near draws come to what was observed, and a set is what it leaves open. A law fitted at some speeds
must hold at the others: so each operating point is held out in turn, and of the effects in question that one is named
which alone forecasts it. All have the same chance: as many machines that agree with the baseline, at sizes evenly over
what is left open (docs/decisions/reconcile-contest.md).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from reconcile.kinematics.candidate import DEFECTS
from reconcile.machine.decide import STRUCK, Decision, looks_alike
from reconcile.machine.direct import HEARD
from reconcile.machine.heldout import MANY, Trial, lead_by, trial
from reconcile.machine.level_size import with_sizes
from reconcile.machine.library import Catalogued
from reconcile.machine.meter import Meter
from reconcile.machine.search import LIKE_IT
from reconcile.machine.second import Beside, second_effect, strikes
from reconcile.machine.setting import Found, Setting
from reconcile.machine.unstruck import SILENT
from reconcile.machine.weigh import LEAST_EVIDENCE, MOST_NAMED, variants
from reconcile.verdict import Word
from signals.series import FloatArray
from sim.terms import REGISTRY

FEWEST_POINTS = 2
"""A later time of the same record holds whatever the law is."""
LEAST_GAIN = 0.1
"""Held-out gain below which no forecast says anything of an effect."""
SHARE, SHARE_BESIDE = 0.5, 0.3
"""Share of the gain of a perfect model that the one which is named must reach; where impacts are sure that it does not
make, so that something stands beside it, less."""
CLEARLY = 0.05
"""Gain by which it must be ahead of every other, at the lower end of a 90 % interval of the difference."""
LEVEL = 0.02
"""Gain by which the first must be ahead of what had its chance already, for the others to get theirs."""
LED, MOST = 5, 5
"""How many by their evidence may lead, and how many take part."""
BY_FORECAST = "all else that it may be forecasts data not fitted to far less well"
FORM_BY_FIT = "of what shows alike at this place it fits best, and all else forecasts data not fitted to far less well"
BEATEN = "what fits best and what forecasts data not fitted to best are not the same effect"


@dataclass(frozen=True, kw_only=True)
class Contest:
    """`gains`: held-out gain of each that took part, the best first; `ahead`: by how much it is ahead of each other,
    at the lower end of the interval; `ceiling`: gain of a perfect model; `drawn`: what was simulated of them."""

    decision: Decision
    gains: Mapping[str, float]
    ahead: Mapping[str, float]
    ceiling: float
    drawn: Mapping[str, Catalogued] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True)
class _Entrant:
    """An effect, what its forecasts leave of each held-out part, and their gain."""

    name: str
    left: Sequence[FloatArray]
    gain: float
    draws: int


def contest(setting: Setting, found: Found, decision: Decision, spectral: np.ndarray, meter: Meter) -> Contest | None:
    """Who took part, and the decision by it; None where nothing is open, or forecasts of the draws at hand do not put
    one ahead."""
    if not _asked(setting, found, decision):
        return None
    held = trial(setting.changes, spectral)
    known = found.unled
    every = {name: _entrant(held, known, name) for name in known.library.groups if name in found.screen.names}
    hand = {name: one for name, one in every.items() if one is not None}
    if decision.chosen[0] not in hand:
        return None
    silent = decision.reasons == (SILENT,)
    field_of = _pits_there(setting, decision, hand) if silent else _in_question(found, decision, hand)
    if field_of is None or not _worth(field_of, held.ceiling) or (not silent and _level(field_of)):
        return None
    if decision.word == "explained" and field_of[0].gain < hand[decision.chosen[0]].gain + CLEARLY:
        return None
    drawn = {one.name: k for one in field_of if (k := with_sizes(setting, found, one.name, meter)) is not None}
    fair = [_entrant(held, drawn[e.name], e.name) if e.name in drawn else e for e in field_of]
    if any(one is None for one in fair):
        return None
    first, *others = sorted((one for one in fair if one is not None), key=lambda one: -one.gain)
    ahead = {one.name: lead_by(held, first.left, one.left, setting.seed) for one in others}
    told = _decided(found, decision, first, ahead, held.ceiling, silent=silent)
    gains = {one.name: one.gain for one in (first, *others)}
    return Contest(decision=told, gains=gains, ahead=ahead, ceiling=held.ceiling, drawn=drawn)


def by_contest(
    setting: Setting,
    found: Found,
    first: Decision,
    told: tuple[Decision, Beside | None],
    spectral: np.ndarray,
    meter: Meter,
) -> tuple[Contest | None, Decision, Beside | None]:
    """Who took part, the decision, and what stands beside its effect. `first`: as the screen decides; `told`: with what
    was found beside it: then nothing is open, unless the first of both is a pit in which nothing strikes."""
    decision, other = told
    silent = first.reasons == (SILENT,)
    if other is not None and not silent:
        return None, decision, other
    asked = first if silent else decision
    held = contest(setting, found, asked, spectral, meter)
    if held is None or held.decision is asked:
        return held, decision, other
    chosen = held.decision
    resting = chosen.word == "explained" and not strikes(chosen.chosen[0])
    return held, chosen, second_effect(setting, found, chosen) if resting else None


def _asked(setting: Setting, found: Found, decision: Decision) -> bool:
    """Whether it is open which known effect it is, and held-out points of a machine that agrees with a baseline can
    tell."""
    if len(setting.data) < FEWEST_POINTS or not setting.changes.with_baseline or setting.fitted_machine is None:
        return False
    if not decision.chosen or decision.chosen[0] not in found.screen.names:
        return False
    if decision.word == "explained":
        return float(found.screen.direct[found.screen.names.index(decision.chosen[0])]) < STRUCK
    if decision.word == "ambiguous":
        return len({name.split("@")[0] for name in decision.chosen}) > 1  # of places `by_forecast` decides
    return decision.reasons == (SILENT,) or (decision.word == "not_decidable" and many_alike(decision))


def many_alike(decision: Decision) -> bool:
    """Whether nothing is decided for the number of effects alone: where none is adequate or the change is too faint,
    no forecast makes a name of one."""
    return decision.reasons == (looks_alike(len(decision.chosen)),)


def _entrant(held: Trial, known: Catalogued, name: str) -> _Entrant | None:
    """None where its draws do not tell all that is held out."""
    left = held.left(known, known.library.groups[name])
    whole = [one.size for one in left] == [one.size for one in held.before]
    many = len(known.library.groups[name])
    return _Entrant(name=name, left=left, gain=held.gain(left), draws=many) if whole else None


def _in_question(found: Found, decision: Decision, hand: Mapping[str, _Entrant]) -> list[_Entrant] | None:
    """The one that forecasts best of those in the answer and next to it, and those it must beat: of these, and of all
    others by what the draws at hand forecast; none of them a form of it. None where a fault of a tooth leads, which
    moves hardly a level."""
    told = dict(zip(found.screen.names, map(float, found.screen.evidence), strict=True))
    order = sorted((n for n in hand if told[n] >= LEAST_EVIDENCE), key=lambda n: -told[n])
    near = [n for n in dict.fromkeys((*decision.chosen, *order[:LED])) if n in hand and told[n] >= LEAST_EVIDENCE]
    if not near:
        return None
    leader = max(near, key=lambda n: hand[n].gain)
    if _strikes(leader) == "tooth":
        return None
    best = sorted((n for n in hand if told[n] > -LEAST_EVIDENCE), key=lambda n: -hand[n].gain)[:2]
    listed = dict.fromkeys((leader, decision.chosen[0], *best, *(n for n in decision.chosen if n in hand), *near))
    others = [n for n in listed if n != leader and n in hand and not variants(n, leader)]
    return [hand[n] for n in (leader, *others[: MOST - 1])]


def _pits_there(setting: Setting, decision: Decision, hand: Mapping[str, _Entrant]) -> list[_Entrant] | None:
    """Where a pit fits best in which nothing strikes: the one of that bearing that is heard, and the others."""
    site = decision.chosen[0].split("@")[1]
    pits = [n for n in hand if n.split("@")[1] == site and _strikes(n) in DEFECTS]
    heard = [n for n in pits if setting.direct.evidence.get(n, 0.0) >= HEARD]
    if len(heard) != 1 or len(pits) < 2:
        return None
    return [hand[heard[0]], *(hand[n] for n in pits if n != heard[0])]


def _worth(entrants: Sequence[_Entrant], ceiling: float) -> bool:
    """Whether the first may win: its draws at hand forecast enough for that."""
    first, *others = entrants
    return bool(others) and first.gain >= max(LEAST_GAIN, SHARE_BESIDE * ceiling)


def _level(entrants: Sequence[_Entrant]) -> bool:
    """Whether another that had its chance already forecasts as much as the first."""
    first, *others = entrants
    return any(one.draws >= MANY and one.gain > first.gain - LEVEL for one in others)


def _decided(
    found: Found, decision: Decision, first: _Entrant, ahead: Mapping[str, float], ceiling: float, *, silent: bool
) -> Decision:
    told = dict(zip(found.screen.names, map(float, found.screen.evidence), strict=True))
    struck = dict(zip(found.screen.names, map(float, found.screen.direct), strict=True))
    if silent:
        heard = struck[first.name] >= HEARD and min(ahead.values()) > 0.0 and first.gain >= LEAST_GAIN
        return _named(decision, first.name) if heard else decision
    beside = max(struck.values()) >= STRUCK > struck[first.name]
    least = max(LEAST_GAIN, (SHARE_BESIDE if beside else SHARE) * ceiling)
    forms = sorted(
        (first.name, *(n for n in like_it(first.name) if told.get(n, 0.0) >= LEAST_EVIDENCE)), key=lambda n: -told[n]
    )
    enough = told[first.name] >= LEAST_EVIDENCE and first.gain >= least and _strikes(first.name) != "tooth"
    if enough and all(by >= CLEARLY for n, by in ahead.items() if n not in forms):
        sure = len(forms) == 1 or told[forms[0]] >= told[forms[1]] + LEAST_EVIDENCE
        why = BY_FORECAST if forms[0] == first.name else FORM_BY_FIT
        return _named(decision, forms[0], why) if sure else _open(decision, tuple(forms))
    if decision.word == "explained":
        return decision if decision.chosen[0] in forms else _beaten(decision, first, ahead)
    if not enough:
        return decision
    kept = [n for n in decision.chosen if ahead.get(n, 0.0) < CLEARLY]
    more = [n for n, by in ahead.items() if by <= 0.0]
    return _open(decision, tuple(dict.fromkeys((first.name, *kept, *forms, *more))))


def _beaten(decision: Decision, first: _Entrant, ahead: Mapping[str, float]) -> Decision:
    """A name that another effect forecasts better than is a set of both."""
    own = decision.chosen[0]
    return _open(decision, (first.name, *decision.chosen)) if ahead.get(own, 0.0) > 0.0 else decision


def _open(decision: Decision, chosen: tuple[str, ...]) -> Decision:
    same = chosen[0] == decision.chosen[0] and set(chosen) == set(decision.chosen)
    if same or len(chosen) > MOST_NAMED:
        return decision
    word: Word = "ambiguous"
    return replace(decision, word=word, chosen=chosen, reasons=(BEATEN,))


def _named(decision: Decision, name: str, why: str = BY_FORECAST) -> Decision:
    if decision.word == "explained" and name == decision.chosen[0]:
        return decision
    return replace(decision, word="explained", chosen=(name,), reasons=(why,))


def _strikes(name: str) -> str | None:
    term = REGISTRY.get(name.split("@", maxsplit=1)[0])
    return None if term is None else term.strikes


def like_it(name: str) -> list[str]:
    """What shows alike at that place: which of them forecasts better is their form's merit, as no machine has quite
    that. Two loose fits were named a wider clearance, 0.40 and 0.46 for 0.17 and 0.21 (v017 and v064 of the proof)."""
    term, site = name.split("@")
    return [f"{other}@{site}" for other in LIKE_IT.get(term, ())]
