"""How large an effect is by levels: the size that, simulated on machines that agree with the baseline, shows what was
observed.

The draws near an observation crowd where the search went, and it was led by the one view in which the effect shows
best. Here sizes evenly over what those draws leave open are simulated, each on another of the machines that agree with
the baseline, and every view is asked: how far is the observed change from what such machines show at a size, in
deviations of measurement, of drift and of what the machines scatter (docs/decisions/reconcile-level-size.md).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from reconcile.atlas.candidates import Candidate, sought_range
from reconcile.atlas.plan import AtlasPlan, Draw, simulated_at
from reconcile.atlas.run import may_strike, steps_of
from reconcile.judge.space import Fitted
from reconcile.machine.library import Catalogued, catalogued
from reconcile.machine.local import simulated_banks
from reconcile.machine.meter import Meter
from reconcile.machine.refine import best_draws, known_term
from reconcile.machine.rolling import kind_of
from reconcile.machine.setting import Found, Setting
from reconcile.machine.severity import estimated_severity, parameter_of, severity_of
from reconcile.machine.size_likelihood import Heard, sized
from reconcile.verdict import Severity
from signals.series import FloatArray
from sim.assembly.assemble import assemble
from sim.core.errors import SpecError
from sim.core.spec import TermSpec

DRAWS, STRIKING, NEAR = 24, 18, 6
"""Sizes that are simulated, where rings may strike walls, which costs more; the nearest draws whose other parameters
they have, in turn."""
WIDER = 2.0
"""Times by which the sizes go beyond the interval of the nearest draws, at either end."""
BANDWIDTH = 0.35
"""Of the line through what the draws show, in the logarithm of the size."""


@dataclass(frozen=True, kw_only=True)
class BySizes:
    """Sizes of effects, and the draws that told them: led to nothing but a range of sizes, so they may forecast."""

    sizes: Mapping[str, Severity] = field(default_factory=dict)
    draws: Catalogued | None = None


def by_levels(setting: Setting, found: Found, names: Sequence[str], meter: Meter) -> BySizes:
    """That of the first of the effects, where it strikes nothing and machines agree with a baseline."""
    if not names or kind_of(names[0]) or setting.fitted_machine is None or not setting.changes.with_baseline:
        return BySizes()
    return _size_of(setting, found, names[0], meter)


def _size_of(setting: Setting, found: Found, name: str, meter: Meter) -> BySizes:
    plan = _plan(setting, found, name)
    if plan is None:
        return BySizes()
    banks = simulated_banks(setting, plan, meter)
    try:
        known = catalogued(plan, banks, setting.seen_through, setting.plan, setting.banks, with_baseline=True)
    except SpecError:
        return BySizes()
    size = parameter_of(name)
    logs = np.log([abs(t.parameters[size.name]) for t in known.terms])
    told = sized(logs, [_heard(view, known, setting.changes.observed) for view in found.views], BANDWIDTH)
    return BySizes(sizes={} if told is None else {name: severity_of(size, *told)}, draws=known)


def _plan(setting: Setting, found: Found, name: str) -> AtlasPlan | None:
    """Sizes over more than the interval of the nearest draws, as far as they are sought, each on another machine with
    what else a near draw has; None where nothing is left open."""
    term, site = name.split("@")
    observed, view, size = setting.changes.observed, found.view(name), parameter_of(name)
    levels = estimated_severity(view, found.known, name, observed)
    least, most = sought_range(setting.plan.machine, known_term(term), site)
    low, high = max(levels.low / WIDER, least), min(levels.high * WIDER, most)
    near = best_draws(view, found.known, name, observed, count=NEAR)
    healthy = [d.pair for d in setting.plan.draws if d.candidate is None and not d.twin]
    if not 0.0 < low < high or not near or not healthy:
        return None
    many = _worth(setting, near, healthy[0])
    if many == 0:
        return None
    rng = np.random.default_rng([setting.seed, 43, *name.encode()])
    pairs = rng.permutation(healthy)
    candidate = Candidate(term=term, site=site)
    draws = []
    for k, share in enumerate((np.arange(many) + 0.5) / many):
        at, other = float(low ** (1.0 - share) * high**share), near[(5 * k + k // NEAR) % len(near)]
        draws.append(Draw(pair=int(pairs[k % pairs.size]), candidate=candidate, term=_sized(other, size.name, at)))
    return replace(setting.plan, draws=tuple(draws))


def _worth(setting: Setting, terms: Sequence[TermSpec], pair: int) -> int:
    """How many sizes of an effect are simulated; none where one of the `terms` moves something so light that a machine
    with it takes shorter steps: several times the price, and no better a size."""
    plan, point = setting.plan, simulated_at(setting.machine, setting.data[0].point)
    members = (plan.member(Draw(pair=pair, term=term), point) for term in (None, *terms))
    alone, *others = (assemble(m.machine, seed=m.seed) for m in members)
    if max(map(steps_of, others)) > steps_of(alone):
        return 0
    return STRIKING if any(map(may_strike, others)) else DRAWS


def _sized(term: TermSpec, name: str, size: float) -> TermSpec:
    values = {**term.parameters, name: float(np.copysign(size, term.parameters[name]))}
    return term.model_copy(update={"parameters": values})


def _heard(view: Fitted, known: Catalogued, observed: FloatArray) -> Heard:
    """In deviations of measurement and drift."""
    seen = view.view(view.whiten(observed)[None])[0]
    return Heard(shown=view.view(view.whiten(known.library.changes)), seen=seen, variance=np.ones(seen.size))
