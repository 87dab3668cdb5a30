"""Two effects fitted together: what a second one adds to the best, first by sums, then by simulating both.

Simulating all pairs is out of reach, and what the first effect leaves of the observed decibels is no second effect's
change: where both raise a line they add as powers. So the draws of the best effect and those of every other are summed
so, and each sum is judged as a draw of one effect is. The few seconds that add most are simulated beside the first on
machines that are fitted to the observation together with both (docs/decisions/reconcile-pairs.md).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from reconcile.atlas.bank import Mapper
from reconcile.atlas.candidates import Candidate, size_parameter
from reconcile.calibrate.uncertain import Offsets
from reconcile.judge.adequacy import Rest, rest_beside
from reconcile.judge.screen import KINDS, quantile_of_misfit, together
from reconcile.judge.space import Fitted
from reconcile.machine.assimilate import Ensemble, moved, simulated_again
from reconcile.machine.decide import STRANGE, Decision
from reconcile.machine.direct import HEARD
from reconcile.machine.left_lines import leaves_lines
from reconcile.machine.library import Catalogued
from reconcile.machine.of_teeth import APART, look_alike, of_one_gear
from reconcile.machine.refine import known_term
from reconcile.machine.second import Beside, Together, strikes
from reconcile.machine.setting import Found, Setting
from reconcile.machine.severity import weighted_severity
from reconcile.machine.weigh import LEAST_EVIDENCE, exclusive, variants
from reconcile.verdict import Severity
from signals.series import FloatArray
from sim.core.spec import TermSpec

FORMS = 4
"""Draws of the first effect to which others are added: the best of all views together, and of each."""
PROMISING = 4.0
"""Log evidence that a second effect must add by sums to be simulated beside the first."""
LEAST_GAIN, LEAST_BESIDE_IMPACTS = 12.0, 8.0
"""Log evidence that it must add as simulated; the second beside impacts, which prove the first. Of cases of the proof
right seconds add 8.7 and 15 beside impacts and 29 beside an unbalance; a wrong one beside a clearance, which is the
least repeatable, 11. Where rivals come near the second it must be the first: beside a pit alone one of six effects that
come once a turn added 8.4."""
UNTRIED = 6.0
"""Log evidence by which it must lead what was summed only: simulated beside the first, seconds gain up to 5 more."""
SIDEBANDS = (2, 3, 5)
"""Numbers of the views of single sidebands."""


@dataclass(frozen=True, kw_only=True)
class Sum:
    """A second effect beside the first: log `gain` over the first alone, `rows` (k, 2): draws of the first and of the
    second whose sums gain most, the best first, and the view of single lines that speaks for it."""

    name: str
    gain: float
    rows: tuple[tuple[int, int], ...]
    view: Fitted


@dataclass(frozen=True, kw_only=True)
class Pair:
    """What stands beside the effect `first`, fitted together with it; `others` that may as well, if the first of them
    is not decided; `gain`: log evidence of the second over the best that the first alone shows, `parts` of it at
    each operating point; `drawn`: what both show on machines not led there, (n, F) dB, where simulated."""

    first: str
    beside: Beside
    gain: float
    rest: Rest
    others: tuple[str, ...] = ()
    drawn: FloatArray | None = None
    parts: tuple[float, ...] = ()


def evidence_in(view: Fitted, changes: FloatArray, observed: FloatArray) -> FloatArray:
    """Log evidence of each of `changes` (n, F) over no change, (n,)."""
    place = view.place(observed)
    points = view.metric(view.view(view.whiten(changes)))
    nothing = float(np.sum(place**2))
    return np.asarray((nothing - np.sum((points - place) ** 2, axis=1)) / (2.0 * view.overdispersion))


@dataclass(frozen=True, kw_only=True)
class Pairs:
    """What was tried beside the effect `first`: of each second the log evidence it adds by sums, and as simulated where
    it was; the pair that stands, if any."""

    first: str
    tried: tuple[tuple[str, float, float | None], ...]
    best: Pair | None = None


def heard_in(found: Found, first: str) -> list[Fitted]:
    """The views in which a second effect shows: impacts bring a forest of lines in which sidebands drown, and what
    stands in it had the pattern of an eccentric gear (33 over the spall alone, in a case without one)."""
    return [view for k, view in enumerate(found.views) if k not in SIDEBANDS or not strikes(first)]


def alone(views: Sequence[Fitted], name: str, observed: FloatArray) -> FloatArray:
    """Log evidence of an effect's path in every view, (views,)."""
    values = []
    for view in views:
        place = view.place(observed)
        own = view.paths.owner == view.paths.names.index(name)
        left = float(view.paths.distances(place)[own].min())
        values.append((float(np.sum(place**2)) - left) / (2.0 * view.overdispersion))
    return np.array(values)


def _forms(views: Sequence[Fitted], found: Found, name: str, observed: FloatArray) -> list[int]:
    library = found.known.library
    rows = list(library.groups[name])
    told = [evidence_in(view, library.changes[rows], observed) for view in views]
    best = [int(k) for k in np.argsort(-together(told))[:FORMS]] + [int(np.argmax(one)) for one in told]
    return [rows[k] for k in dict.fromkeys(best)]


def sums(setting: Setting, found: Found, first: str, members: int) -> list[Sum]:
    """What every other effect that can act beside the first adds to it, the most first; empty without views of lines.
    What would strike and is not heard is none: a ball's pit added 10 to an inner race's beside which an outer race was
    pitted, and a pit of both races of one bearing looks like a larger one of the inner race."""
    observed, library = setting.changes.observed, found.known.library
    heard = {n for n, value in setting.direct.evidence.items() if value >= HEARD}
    others = {
        n: rows
        for n, rows in library.groups.items()
        if n != first and not exclusive(n, first) and (n in heard or not strikes(n))
    }
    rows = [k for own in others.values() for k in own]
    views = heard_in(found, first)
    if not rows or len(views) == 1:
        return []
    base = alone(views, first, observed)
    forms = _forms(views, found, first, observed)
    table = np.array(
        [
            [
                evidence_in(view, setting.changes.both(library.changes[form][None], library.changes[rows]), observed)
                - least
                for view, least in zip(views, base, strict=True)
            ]
            for form in forms
        ]
    )
    starts = np.cumsum([0, *(len(own) for own in others.values())])
    seen = []
    for name, low, high in zip(others, starts[:-1], starts[1:], strict=True):
        part = table[:, :, low:high]
        gains = np.array([together(list(one)) for one in part])
        places = [divmod(int(k), int(high - low)) for k in np.argsort(-gains, axis=None)[:members]]
        seen.append(
            Sum(
                name=name,
                gain=float(together(list(part.max(axis=(0, 2))[:, None]))[0]),
                rows=tuple((forms[a], rows[int(low) + b]) for a, b in places),
                view=views[1 + int(np.argmax(part[places[0][0], 1:, places[0][1]]))],
            )
        )
    return sorted(seen, key=lambda one: -one.gain)


def fitted_pair(setting: Setting, found: Found, first: str, second: Sum, mapper: Mapper) -> Pair | None:
    """Both on the machines of the first one's draws, fitted together; None where too few run."""
    observed, known = setting.changes.observed, found.known
    a, b = (list(rows) for rows in zip(*second.rows, strict=True))
    term, site = first.split("@")
    start = Ensemble(
        candidate=Candidate(term=term, site=site),
        offsets=tuple(known.offsets[k] for k in a),
        terms=tuple(known.terms[k] for k in a),
        also=tuple(known.terms[k] for k in b),
        changes=setting.changes.both(known.library.changes[a], known.library.changes[b]),
    )
    rng = np.random.default_rng([setting.seed, 22, *f"{first}+{second.name}".encode()])
    led = moved(start, found.levels_like(second.view), observed, 1.0, rng)
    more = simulated_again(setting, led.candidate, led.offsets, led.terms, mapper, also=led.also)
    if more is None:
        return None
    changes = more.library.changes
    views = heard_in(found, first)
    told = [evidence_in(v, changes, observed) - x for v, x in zip(views, alone(views, first, observed), strict=True)]
    gains = together(told)
    return pair_of(setting, found, first, second.name, second.view, Simulated(known=more, also=led.also, gains=gains))


@dataclass(frozen=True, kw_only=True)
class Simulated:
    """Machines with both effects: what they show and with which first effect (`known`), the second effect `also` of
    every machine asked for, and log evidence (n,) of every one that ran over the first alone."""

    known: Catalogued
    also: tuple[TermSpec, ...]
    gains: FloatArray


def pair_of(
    setting: Setting, found: Found, first: str, second: str, view: Fitted, made: Simulated, gain: float | None = None
) -> Pair:
    """The pair as these machines show it, by the best of them if no other `gain` is given, with which the first's size
    beside the second counts; `view`: of single lines, in which they were fitted."""
    observed, changes = setting.changes.observed, made.known.library.changes
    order = np.argsort(-made.gains)
    terms = tuple((made.known.terms[k], made.also[made.known.pairs[k]]) for k in order)
    weights = np.exp(made.gains[order] - made.gains.max())
    sizes = [_size_of(name, [t[k] for t in terms], weights) for k, name in enumerate((first, second))]
    middle = Offsets(values=np.mean([o.values for o in made.known.offsets], axis=0))
    both = Together(severity=sizes[1], terms=terms, middle=middle, own=None if gain is None else sizes[0])
    adds = float(made.gains.max()) if gain is None else gain
    beside = Beside(
        view=view,
        left=observed,
        names=(second,),
        evidence=np.array([adds]),
        p=float(np.exp(-max(adds, 0.0))),
        misfit=_misfit(view, changes, observed),
        together=both,
    )
    return Pair(first=first, beside=beside, gain=adds, rest=_rest(found, first, changes, observed))


def _size_of(name: str, terms: Sequence[TermSpec], weights: FloatArray) -> Severity:
    size = size_parameter(known_term(name.split("@", maxsplit=1)[0]))
    return weighted_severity(size, np.array([abs(t.parameters[size.name]) for t in terms]), weights / weights.sum())


def best_pair(
    setting: Setting, found: Found, decision: Decision, members: int, most: int, mapper: Mapper
) -> Pairs | None:
    """What stands beside the best effect, of at most so many that are simulated: nothing where none adds enough, where
    both leave what no known effects should, or where another first would do as well. None where none is looked for."""
    if decision.word not in ("explained", "ambiguous", "unknown_physics") or not decision.chosen:
        return None
    first = decision.chosen[0]
    seen = [one for one in sums(setting, found, first, members) if one.gain >= PROMISING]
    fitted = {one.name: fitted_pair(setting, found, first, one, mapper) for one in seen[:most]}
    pairs = sorted((p for p in fitted.values() if p is not None), key=lambda p: -p.gain)
    simulated = {name: None if pair is None else pair.gain for name, pair in fitted.items()}
    tried = tuple((one.name, one.gain, simulated.get(one.name)) for one in seen)
    best = pairs[0] if pairs and _stands(setting, found, decision, pairs[0]) else None
    if best is not None:
        second = best.beside.names[0]
        rivals = {p.beside.names[0]: p.gain + LEAST_EVIDENCE for p in pairs[1:]}
        rivals |= {s.name: s.gain + UNTRIED for s in seen[most:]}
        near = [n for n, reach in rivals.items() if reach > best.gain and not variants(n, second)]
        near += [n for n in of_its_tooth(second, tried) if n not in near]
        best = replace(best, others=(second, *near) if near else ())
    if best is not None and best.others and best.gain < LEAST_GAIN:
        best = None
    return Pairs(first=first, tried=tried, best=best)


def of_its_tooth(second: str, tried: Sequence[tuple[str, float, float | None]]) -> list[str]:
    """Faults of a tooth of the same gear that `second` is not far enough ahead of, or that were summed only: a crack
    beside a loose fit was named a broken tooth, 36 as simulated, where a pit had 19 and the crack was not simulated."""
    gains = {name: math.inf if simulated is None else simulated + APART for name, _, simulated in tried}
    own = next((simulated for name, _, simulated in tried if name == second and simulated is not None), 0.0)
    near = [n for n, reach in gains.items() if reach > own or look_alike(n, second)]
    return [n for n in near if n != second and of_one_gear(n, second)]


def _stands(setting: Setting, found: Found, decision: Decision, best: Pair) -> bool:
    least = LEAST_BESIDE_IMPACTS if strikes(best.first) else LEAST_GAIN
    if best.gain < least or (decision.word != "explained" and inadequate(best)):
        return False
    return not any(_as_well(setting, found, rival, best) for rival in decision.chosen[1:])


def named_pair(decision: Decision, other: Beside | None, pairs: Pairs | None) -> tuple[Decision, Beside | None]:
    """The verdict with what stands beside the best effect: what strikes too, or else what was fitted together."""
    pair = pairs.best if pairs is not None else None
    if other is not None or pair is None or pair.others:
        return decision, other
    return replace(decision, word="explained", chosen=(pair.first,), reasons=()), pair.beside


def sizes_of(pairs: Pairs | None) -> Together | None:
    """Of the best pair, where sizes of both had to be searched: the first's, fitted alone, is too large whichever of
    several seconds stands beside it."""
    together = pairs.best.beside.together if pairs is not None and pairs.best is not None else None
    return together if together is not None and together.searched else None


def _as_well(setting: Setting, found: Found, rival: str, best: Pair) -> bool:
    """Whether a rival of the first, summed with the second, comes near both."""
    told = dict(zip(found.screen.names, found.screen.evidence, strict=True))
    second = best.beside.names[0]
    if rival == second or variants(rival, best.first):
        return False
    more = next((one.gain for one in sums(setting, found, rival, 1) if one.name == second), 0.0)
    return bool(told[rival] + max(more, 0.0) > told[best.first] + best.gain - UNTRIED)


def inadequate(pair: Pair) -> bool:
    """Whether both together leave what no known effects should."""
    return leaves_lines(pair.rest) or pair.beside.misfit > STRANGE


def _rest(found: Found, first: str, changes: FloatArray, observed: FloatArray) -> Rest:
    lines = [rest_beside(v, observed, first, changes) for v in found.views[1 : 1 + KINDS]]
    pooled = rest_beside(found.fitted, observed, first, changes).kept
    worst = max(lines, key=lambda rest: rest.unmet)
    return replace(worst, pooled=pooled, elsewhere=worst.unmet, rough=False)


def _misfit(view: Fitted, changes: FloatArray, observed: FloatArray) -> float:
    place = view.place(observed)
    points = view.metric(view.view(view.whiten(changes)))
    left = float(np.sum((points - place) ** 2, axis=1).min())
    return quantile_of_misfit(view, left, float(np.sum(place**2)))
