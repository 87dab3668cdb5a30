"""Which effects are simulated, on which machines, and what they say of the recordings."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from itertools import zip_longest

import numpy as np

from reconcile.atlas.bank import Mapper
from reconcile.atlas.plan import AtlasPlan, Draw
from reconcile.judge.nulls import noisy, squared_distances
from reconcile.judge.pooled import OneByOne
from reconcile.judge.screen import judge
from reconcile.judge.space import fit_space
from reconcile.machine.assimilate import Task
from reconcile.machine.beneath import asked_beneath
from reconcile.machine.budget import Budget
from reconcile.machine.decide import DETECT_P
from reconcile.machine.library import Catalogued, catalogued, joined
from reconcile.machine.local import COSTLY, LANES, first_heat, more_draws, ordered_draws, second_heat, simulated_banks
from reconcile.machine.of_teeth import looks_like
from reconcile.machine.rattle import draws_around
from reconcile.machine.refine import best_draws, refined_plan, seen_draws, spread_plan
from reconcile.machine.second import beside, looks_for_second, strikes, struck_too
from reconcile.machine.setting import Found, Setting
from reconcile.machine.weigh import LEAST_EVIDENCE, credible_set, merged_weights, plausible
from signals.series import FloatArray
from sim.core.errors import SpecError
from sim.core.spec import TermSpec

POINTS_OF_LINES, CHANNELS_OF_LINES, CHANNELS_OF_PHASES = 2, 6, 3
"""Operating points from which single lines have a pattern: at one, few sensors see each meet its resonance by chance;
sensors from which one point will do, and fewer of which where their phases are compared."""
LEAST_OF_LINES = 4.0
"""Overdispersion of single lines: that of sixteen effects on development cases was 4 to 8."""
LEAST_TERMS = 5
"""Effects that are simulated at all their places, however far ahead the best is."""
EXPLAINED = 0.15
"""Share of the squared change that a draw must explain for its size to say something: of eleven development cases the
nearest draw of the right effect explains 0.2 to 0.6 in five, with a size within 30 %, and below 0.1 it says nothing."""
NEAREST = 2
FEW_PLAUSIBLE, NEAR_RANK = 10, 10
"""Effects that a look leaves plausible at most, so that a loose ring is hopeless at all, and rank by either look down
to which it is simulated though out of the question by evidence."""
SECONDS = 3
"""Candidates for a second effect that are simulated with all their draws."""
MOSTLY_SEEN, SPREAD, SPREAD_ABOUT = 0.75, 6, 2
"""Share of an effect's draws from which its sizes are known as they are drawn, else so many draws spread over the sizes
about so many of the best."""
LIKE_IT = {
    "torque_ripple": ("angular_misalignment",),
    "angular_misalignment": ("torque_ripple",),
    "radial_clearance": ("fit_clearance_series", "fit_clearance"),
    "fit_clearance": ("radial_clearance",),
    "fit_clearance_series": ("radial_clearance",),
}
"""A bearing with more play and a ring loose in its seat let the shaft stand off alike: where one is the best, the other
is simulated too, the first form of it that there may be: beside a fit of the machine file the other form cannot be. A
ring loose by 11 um was unknown physics, the wider clearance of its bearing the best (w032). An angle at a coupling
twists the shaft twice a turn, as a torque does that comes twice (a005)."""
FITTED_SECONDS = 2
"""Of these so many are fitted together with the machine."""


def fit_views(setting: Setting, known: Catalogued) -> Found:
    """Families of features; on machines that agree with the baseline single lines beside them."""
    changes, direct = setting.changes, setting.direct
    banks = noisy(changes, known.library.changes, setting.seed)
    fitted = fit_space(changes, known.library, seed=setting.seed, least=setting.overdispersion, banks=banks)
    enough = CHANNELS_OF_PHASES if changes.phased else CHANNELS_OF_LINES
    told = len(setting.data) >= POINTS_OF_LINES or len(setting.channels) >= enough
    views: tuple[OneByOne, ...] = ()
    if setting.fitted_machine is not None and told:
        toothed = (changes.twice, *changes.phased) if np.any(changes.twice.chosen) else ()
        views = (changes.single, changes.sides, *toothed)
    lines = [
        fit_space(changes, known.library, seed=setting.seed, view=view, least=LEAST_OF_LINES, banks=banks)
        for view in views
    ]
    screen = judge((fitted, *lines), changes.observed, direct.evidence, direct.p)
    if not lines:
        return Found(known=known, fitted=fitted, screen=screen)
    fine, sides, twice = (*lines, None)[:3]
    return Found(
        known=known, fitted=fitted, screen=screen, fine=fine, sides=sides, twice=twice, phases=tuple(lines[3:])
    )


def screen_atlas(setting: Setting) -> Found:
    """All candidates of the atlas against what was observed."""
    known = catalogued(
        setting.plan,
        setting.banks,
        setting.seen_through,
        setting.plan,
        setting.banks,
        with_baseline=setting.changes.with_baseline,
    )
    return fit_views(setting, known)


def located(
    setting: Setting,
    screened: Found,
    before: Setting,
    budget: Budget,
    mapper: Mapper,
    seen: Found,
    seconds: Sequence[str] = (),
) -> Found:
    """The best of the candidates that were `screened` in the setting `before`, or `seen` by the single lines of the
    setting, simulated on its own machines alone, the best of them more. `seconds` may stand beside the best."""
    near = nearest_effects(screened, before.changes.observed)
    ranked = with_others(screened, seen, seconds)
    ranked = ranked if seconds else without_hopeless(ranked, screened, seen, near)
    draws = _draws(screened, before)
    first = first_heat(setting.plan, ranked, draws, budget.terms)
    known = simulated(setting, first, mapper)
    found = fit_views(setting, known)
    best = plausible(found.screen)[: budget.candidates]
    best += [n for n in near if n in known.library.groups and n not in best]
    if looks_for_second(found):
        others = beside(setting, found, best[0])
        best += [n for n in (others.names[:SECONDS] if others else ()) if n not in best]
    best += [n for n in map(looks_like, best) if n in draws and n not in best]
    best += [n for n in like_it(best[0], draws) if n not in best]
    second = second_heat(setting.plan, best, draws, first)
    if not second.draws:
        return found  # effects with one place only: the first heat had all of their draws
    return fit_views(setting, simulated(setting, second, mapper, known))


def like_it(name: str, known: Collection[str]) -> list[str]:
    """The other play of that bearing or what drives that shaft alike, if it is `known`; none of what is neither."""
    term, site = name.split("@")
    return [other for form in LIKE_IT.get(term, ()) if (other := f"{form}@{site}") in known][:1]


def _draws(screened: Found, before: Setting) -> dict[str, list[Draw]]:
    shown = [t for t, seen in zip(screened.known.terms, screened.fitted.visible, strict=True) if seen]
    return ordered_draws(before.plan, shown, nearest_terms(screened, before.changes.observed))


def broader(setting: Setting, found: Found, screened: Found, before: Setting, budget: Budget, mapper: Mapper) -> Found:
    """More draws of the best effects that have few: one that is not met at its size looks like none at all."""
    groups = found.known.library.groups
    order = [found.screen.names[k] for k in np.argsort(-found.screen.evidence)]
    few = {name: len(groups[name]) for name in order if len(groups[name]) < LANES}
    plan = more_draws(setting.plan, dict(list(few.items())[: budget.broader]), _draws(screened, before))
    return found if not plan.draws else fit_views(setting, simulated(setting, plan, mapper, found.known))


def explained_shares(screened: Found, observed: FloatArray) -> dict[str, tuple[float, int]]:
    """Of each effect the draw nearest to the observation: share of the squared change it explains, and its row."""
    fitted = screened.fitted
    place = fitted.place(observed)
    quiet = fitted.metric(fitted.view(fitted.whiten(screened.known.library.changes)))
    left = squared_distances(quiet, place[None])[:, 0] / max(float(np.sum(place**2)), 1e-300)
    best = {name: min(rows, key=lambda k: left[k]) for name, rows in screened.known.library.groups.items()}
    return {name: (1.0 - float(left[k]), k) for name, k in best.items()}


def nearest_effects(screened: Found, observed: FloatArray) -> tuple[str, ...]:
    """The few effects one of whose draws explains most, on machines of the kind: of seventeen development cases the
    right one is among the first two in ten, also where its other draws are so far away that its evidence is small."""
    shares = {n: share for n, (share, _) in explained_shares(screened, observed).items() if share >= EXPLAINED}
    return tuple(sorted(shares, key=lambda n: -shares[n]))[:NEAREST]


def nearest_terms(screened: Found, observed: FloatArray) -> set[int]:
    """`id` of each effect's draw that is nearest to the observation, where it explains a share of it: on machines of
    the kind that is nearly always one of the right size, of the right effect."""
    shares = explained_shares(screened, observed).values()
    return {id(screened.known.terms[row]) for share, row in shares if share > EXPLAINED}


def with_others(screened: Found, seen: Found, seconds: Sequence[str] = ()) -> list[str]:
    """What is plausible, so much more that the metric learns what differs, and what may stand beside the best.

    What machines of the kind make plausible and what single lines do, in turn: a loose fit stood fourteenth among the
    one and third among the other, a film first among the other alone.
    """
    ranked = in_turn(plausible(screened.screen), plausible(seen.screen))
    names = screened.screen.names
    for name in [names[k] for k in np.argsort(-screened.screen.evidence) if names[k] not in ranked]:
        known = {n.split("@")[0] for n in ranked}
        if len(known) < LEAST_TERMS or name.split("@")[0] in known:
            ranked.append(name)
    return ranked + [n for n in seconds if n not in ranked]


def without_hopeless(ranked: Sequence[str], screened: Found, seen: Found, near: Sequence[str] = ()) -> list[str]:
    """Without loose rings, whose simulation is dear, where few effects are plausible, at bearings where nothing speaks
    for them: neither machines of the kind nor single lines, nor a draw `near` the observation. Where much is plausible
    a ring less is little saved, and the metric another, as where an impact leaves something: there none is left out."""
    looks = [plausible(screened.screen), plausible(seen.screen)]
    if min(map(len, looks)) > FEW_PLAUSIBLE:
        return list(ranked)
    likely = {name for look in looks for name in look} | {*near}
    for screen in (screened.screen, seen.screen):
        likely |= {screen.names[k] for k in np.argsort(-screen.evidence)[:NEAR_RANK]}
    return [n for n in ranked if n in likely or n.split("@")[0] not in COSTLY]


def in_turn(first: Sequence[str], second: Sequence[str]) -> list[str]:
    """The best of both, then the next of both, each name once."""
    both = [name for pair in zip_longest(first, second) for name in pair if name is not None]
    return list(dict.fromkeys(both))


def possible_seconds(setting: Setting, seen: Found) -> tuple[str, ...]:
    """What may stand beside an effect whose impacts are sure, by what it leaves of single lines, the best first; draws
    of the atlas `seen` on machines that agree with the baseline."""
    struck = tuple(name for part in setting.direct.struck for name in part if name in seen.screen.names)
    if not looks_for_second(seen):
        return struck
    best = seen.screen.names[int(np.argmax(seen.screen.evidence))]
    others = beside(setting, seen, best)
    return (*struck, *(others.names if others else ()))


def simulated(setting: Setting, plan: AtlasPlan, mapper: Mapper, known: Catalogued | None = None) -> Catalogued:
    """The plan's draws, with what was `known` before; that alone where none of them runs."""
    banks = simulated_banks(setting, plan, mapper)
    try:
        more = catalogued(
            plan,
            banks,
            setting.seen_through,
            setting.plan,
            setting.banks,
            with_baseline=setting.changes.with_baseline,
        )
    except SpecError:
        if known is None:
            raise
        return known
    return more if known is None else joined(known, more)


def leaders(found: Found, budget: Budget, near: Sequence[str] = ()) -> list[str]:
    """The effects that are simulated again, the best first; those `near` the observation in the atlas among them, and
    what has more of a pattern than a tooth that leads by its burst."""
    weights = merged_weights(found.screen)
    leading = list(weights)[: budget.effects]
    if len(credible_set(weights, 0.999)) == 1:
        leading = leading[:2]
    beneath = asked_beneath(found.screen)
    more = (*near, *((beneath,) if beneath is not None else ()))
    return leading + [n for n in dict.fromkeys(more) if n not in leading and n in found.screen.names]


def to_fit(setting: Setting, found: Found, budget: Budget) -> list[Task]:
    """What is fitted together with the machine: the leaders, to the whole change. Where the first strikes for sure and
    what it leaves is another effect's for all one can tell: the first, and those that may be second, to what it
    leaves. Fitted alone, a gear that runs out led an outer race's pit with impacts of 12 deviations."""
    leading = leaders(found, budget)
    others = beside(setting, found, leading[0]) if looks_for_second(found) else None
    if others is None or others.p > DETECT_P or others.evidence[0] < LEAST_EVIDENCE:
        return [Task(name=n, view=found.lines(n), target=setting.changes.observed) for n in leading]
    view = found.levels_like(others.view)
    first = Task(name=leading[0], view=found.lines(leading[0]), target=setting.changes.observed)
    seconds = [Task(name=n, view=view, target=others.left, second=True) for n in others.names[:FITTED_SECONDS]]
    return [first, *seconds]


def spread_out(setting: Setting, found: Found, leading: Sequence[str], mapper: Mapper) -> Found:
    """With leading effects that strike and that most draws hide simulated over the sizes, as they are best else: of an
    outer race's pits those outside the load show nothing, and the few in it are not of all sizes."""
    visible, groups = found.fitted.visible, found.known.library.groups
    few = [n for n in leading if strikes(n) and 0.0 < visible[list(groups[n])].mean() < MOSTLY_SEEN]
    if not few:
        return found
    seen = setting.changes.observed

    def best(name: str) -> list[TermSpec]:
        """Of those that show something; of all where the view has none of these on the effect's path."""
        shown = seen_draws(found.view(name), visible, found.known, name, seen, SPREAD_ABOUT)
        return shown or best_draws(found.view(name), found.known, name, seen, SPREAD_ABOUT)

    around = [(n, best(n)) for n in few]
    pairs = len(setting.plan.offsets)
    plan = spread_plan(setting.plan, around, draws=SPREAD, pairs=pairs, seed=setting.seed)
    return fit_views(setting, simulated(setting, plan, mapper, found.known))


def refined(
    setting: Setting, found: Found, budget: Budget, mapper: Mapper, turn: int, near: Sequence[str] = ()
) -> Found:
    """Simulate the leading candidates again near their best draws, and judge with both libraries."""
    if turn == 0:
        found = spread_out(setting, found, leaders(found, budget, near), mapper)
    leading = leaders(found, budget, near)
    around = [(name, draws_around(setting, found, name)) for name in leading]
    others = beside(setting, found, leading[0]) if looks_for_second(found) else None
    if others is not None:
        names = [n for n in others.names[:SECONDS] if n not in leading]
        around += [(n, best_draws(others.view, found.known, n, others.left)) for n in names]
    struck = struck_too(setting, found, leading[0])
    if struck is not None and struck.names[0] not in leading:
        around.append((struck.names[0], best_draws(struck.view, found.known, struck.names[0], struck.left)))
    pairs = len(setting.plan.offsets)
    plan = refined_plan(setting.plan, around, draws=budget.members, pairs=pairs, seed=setting.seed + turn)
    return fit_views(setting, simulated(setting, plan, mapper, found.known))
