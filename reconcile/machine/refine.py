"""Stage 5: the best candidates simulated again, near what fitted best, with all their parameters free."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from reconcile.atlas.candidates import Candidate, size_parameter, sought_range
from reconcile.atlas.plan import AtlasPlan, Draw
from reconcile.judge.space import Fitted
from reconcile.machine.library import Catalogued
from signals.series import FloatArray
from sim.core.params import Param
from sim.core.spec import TermSpec
from sim.core.terms import Term
from sim.terms import REGISTRY

NEAR_SIZE = 0.35
"""Standard deviation of the logarithm of the size around the best draws."""
NEAR_ANGLE_RAD = 0.5
NEAR = 0.25
NEAR_UNSTATED = 0.7
"""Of a parameter that is searched beside the size: nobody measured it, and draws leave decades between them."""
SMALLER, LARGER = 4.0, 8.0
"""Times by which sizes are spread about those of the best draws."""


def _moved(param: Param, value: float, rng: np.random.Generator) -> float:
    if param.choices or value == 0.0:
        return value
    if param.unit == "rad" and param.scale == "linear":
        moved = value + rng.normal(0.0, NEAR_ANGLE_RAD)
    elif param.unit == "1" and float(value).is_integer() and value >= 2.0:
        moved = value
    else:
        moved = value * float(np.exp(rng.normal(0.0, NEAR if param.sought is None else NEAR_UNSTATED)))
    return float(np.clip(moved, param.low, param.high))


def known_term(name: str) -> Term:
    """The registered term; ValueError for another name."""
    term = REGISTRY.get(name)
    if term is None:
        raise ValueError(f"no term {name}")
    return term


def _near(term: TermSpec, rng: np.random.Generator) -> TermSpec:
    known = known_term(term.term)
    size = size_parameter(known)
    values = {p.name: _moved(p, term.parameters[p.name], rng) for p in known.params if p.name in term.parameters}
    grown = term.parameters[size.name] * float(np.exp(rng.normal(0.0, NEAR_SIZE)))
    values[size.name] = float(np.clip(grown, size.low, size.high))
    return term.model_copy(update={"parameters": values})


def near_draws(leaders: Sequence[TermSpec], count: int, rng: np.random.Generator) -> list[TermSpec]:
    """The leaders and further terms about them in turn, `count` in all."""
    further = (_near(leaders[k % len(leaders)], rng) for k in range(count - len(leaders)))
    return [*leaders, *further][:count]


def best_draws(fitted: Fitted, known: Catalogued, name: str, observed: FloatArray, count: int = 3) -> list[TermSpec]:
    """The draws of one effect nearest to what was observed."""
    squared = fitted.paths.distances(fitted.place(observed))
    owner = fitted.paths.names.index(name)
    rows = [k for k in np.argsort(squared) if fitted.paths.owner[k] == owner]
    chosen: list[int] = []
    for k in rows:
        for row in (int(fitted.paths.high[k]), int(fitted.paths.low[k])):
            if row >= 0 and row not in chosen:
                chosen.append(row)
    return [known.terms[k] for k in chosen[:count]]


def seen_draws(
    fitted: Fitted, visible: np.ndarray, known: Catalogued, name: str, observed: FloatArray, count: int = 3
) -> list[TermSpec]:
    """The same of the draws that are `visible`, (draws,): a pit of an outer race that no loaded ball meets is as near
    to a small change as one that brings it."""
    rows = known.library.groups[name]
    shown = {id(known.terms[k]) for k in rows if visible[k]}
    nearest = best_draws(fitted, known, name, observed, count=len(rows))
    return [term for term in nearest if id(term) in shown][:count]


def spread_plan(
    plan: AtlasPlan,
    around: Sequence[tuple[str, Sequence[TermSpec]]],
    *,
    draws: int,
    pairs: int,
    seed: int,
) -> AtlasPlan:
    """`draws` machines an effect, near its best draws in all but the size, which goes in even steps between a
    fourth and eight times theirs, as far as it is sought at all."""
    planned = []
    for name, terms in around:
        term, site = name.split("@")
        rng = np.random.default_rng([seed, 5, *name.encode()])
        size = size_parameter(known_term(term))
        least, most = sought_range(plan.machine, known_term(term), site)
        middle = float(np.exp(np.mean(np.log(np.clip([t.parameters[size.name] for t in terms], least, most)))))
        low, high = max(middle / SMALLER, least), min(middle * LARGER, most)
        for j in range(draws):
            near = _near(terms[j % len(terms)], rng)
            share = (j + 0.5) / draws
            sized = {**near.parameters, size.name: low ** (1.0 - share) * high**share}
            spread = near.model_copy(update={"parameters": sized})
            planned.append(Draw(pair=j % pairs, candidate=Candidate(term=term, site=site), term=spread))
    return replace(plan, draws=tuple(planned), seed=plan.seed + 7907)


def refined_plan(
    plan: AtlasPlan,
    around: Sequence[tuple[str, Sequence[TermSpec]]],
    *,
    draws: int,
    pairs: int,
    seed: int,
) -> AtlasPlan:
    """`draws` machines an effect, spread over its best draws; the machine's own offsets are the atlas'."""
    planned = []
    for name, terms in around:
        term, site = name.split("@")
        rng = np.random.default_rng([seed, 4, *name.encode()])
        candidate = Candidate(term=term, site=site)
        for j in range(draws):
            start = terms[j % len(terms)]
            planned.append(Draw(pair=(j + 8) % pairs, candidate=candidate, term=_near(start, rng)))
    return replace(plan, draws=tuple(planned), seed=plan.seed + 7919)
