"""How large an effect is by levels: the size that, simulated on machines that agree with the baseline, shows what was
observed.

The draws near an observation crowd where the search went, and it was led by the one view in which the effect shows
best. Here sizes evenly over what those draws leave open are simulated, each on another of the machines that agree with
the baseline, and every view is asked: how far is the observed change from what such machines show at a size, in
deviations of measurement, of drift and of what the machines scatter (docs/decisions/reconcile-level-size.md).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from reconcile.atlas.candidates import Candidate, sought_range
from reconcile.atlas.plan import Draw, simulated_at
from reconcile.atlas.run import may_strike, steps_of
from reconcile.judge.space import Fitted
from reconcile.machine.library import Catalogued, catalogued, joined
from reconcile.machine.local import simulated_banks
from reconcile.machine.meter import Meter
from reconcile.machine.rattle import draws_around
from reconcile.machine.refine import known_term
from reconcile.machine.rolling import kind_of
from reconcile.machine.setting import Found, Setting
from reconcile.machine.severity import estimated_severity, parameter_of, severity_of
from reconcile.machine.size_likelihood import Curve, Heard, Sized, sized
from reconcile.verdict import Severity
from signals.series import FloatArray
from sim.assembly.assemble import assemble
from sim.core.errors import SidebandError, SpecError
from sim.core.spec import TermSpec

DRAWS, STRIKING, NEAR = 24, 18, 6
"""Sizes that are simulated, where rings may strike walls, which costs more; the nearest draws whose other parameters
they have, in turn."""
WIDER = 2.0
"""Times by which the sizes go beyond the interval of the nearest draws, at either end."""
BEYOND = 4.0
"""Times by which they go on, with half as many, where the size may lie beyond an end."""
CURVE = Curve(bandwidth=0.7, degree=2)
"""Through what the draws show."""


@dataclass(frozen=True, kw_only=True)
class _Asked:
    """An effect, the sizes from `low` to `high` that are tried of those `sought`, draws whose other parameters they
    have, and how many."""

    name: str
    low: float
    high: float
    sought: tuple[float, float]
    near: tuple[TermSpec, ...]
    many: int


def by_levels(setting: Setting, found: Found, names: Sequence[str], meter: Meter) -> dict[str, Severity]:
    """That of the first of the effects, where it strikes nothing and machines agree with a baseline."""
    if not names or kind_of(names[0]) or setting.fitted_machine is None or not setting.changes.with_baseline:
        return {}
    asked = _asked(setting, found, names[0])
    known = None if asked is None else _simulated(setting, asked, meter)
    if asked is None or known is None:
        return {}
    told = _told(setting, found, asked.name, known)
    further = _further(asked, told)
    more = None if further is None else _simulated(setting, further, meter)
    if more is not None:
        told = _told(setting, found, asked.name, joined(known, more))
    if told is None:
        return {}
    size = severity_of(parameter_of(asked.name), told.mean, told.spread)
    return {asked.name: _open(size, told, asked.sought)}


def _asked(setting: Setting, found: Found, name: str) -> _Asked | None:
    """Sizes over more than the interval of the nearest draws; None where nothing is left open."""
    observed, view = setting.changes.observed, found.view(name)
    levels = estimated_severity(view, found.known, name, observed)
    term, site = name.split("@")
    least, most = sought_range(setting.plan.machine, known_term(term), site)
    near = tuple(draws_around(setting, found, name, NEAR))
    low, high = max(levels.low / WIDER, least), min(levels.high * WIDER, most)
    many = _worth(setting, near) if near and 0.0 < low < high else 0
    return _Asked(name=name, low=low, high=high, sought=(least, most), near=near, many=many) if many else None


def _worth(setting: Setting, terms: Sequence[TermSpec]) -> int:
    """How many sizes of an effect are simulated; none where one of the `terms` moves something so light that a machine
    with it takes shorter steps: several times the price, and no better a size."""
    plan, point = setting.plan, simulated_at(setting.machine, setting.data[0].point)
    members = (plan.member(Draw(pair=0, term=term), point) for term in (None, *terms))
    try:
        alone, *others = (assemble(m.machine, seed=m.seed) for m in members)
    except SidebandError:
        return 0
    if max(map(steps_of, others)) > steps_of(alone):
        return 0
    return STRIKING if any(map(may_strike, others)) else DRAWS


def _simulated(setting: Setting, asked: _Asked, meter: Meter) -> Catalogued | None:
    """What machines that agree with the baseline show with these sizes, evenly over their logarithm, each on another
    machine and with what else a near draw has; None where none runs."""
    term, site = asked.name.split("@")
    size, candidate = parameter_of(asked.name).name, Candidate(term=term, site=site)
    healthy = [d.pair for d in setting.plan.draws if d.candidate is None and not d.twin]
    rng = np.random.default_rng([setting.seed, 43, round(1e3 * np.log(asked.high)) % 2**31, *asked.name.encode()])
    pairs, draws = rng.permutation(healthy), []
    rest = [k % len(asked.near) for k in range(asked.many)]
    rng.shuffle(rest)
    for k, share in enumerate((np.arange(asked.many) + 0.5) / asked.many):
        at = float(asked.low ** (1.0 - share) * asked.high**share)
        form = _sized(asked.near[rest[k]], size, at)
        draws.append(Draw(pair=int(pairs[k % pairs.size]), candidate=candidate, term=form))
    plan = replace(setting.plan, draws=tuple(draws))
    banks = simulated_banks(setting, plan, meter)
    try:
        return catalogued(plan, banks, setting.seen_through, setting.plan, setting.banks, with_baseline=True)
    except SpecError:
        return None


def _sized(term: TermSpec, name: str, size: float) -> TermSpec:
    values = {**term.parameters, name: float(np.copysign(size, term.parameters[name]))}
    return term.model_copy(update={"parameters": values})


def _told(setting: Setting, found: Found, name: str, known: Catalogued) -> Sized | None:
    size = parameter_of(name).name
    logs = np.log([abs(t.parameters[size]) for t in known.terms])
    return sized(logs, [_heard(view, known, setting.changes.observed) for view in found.views], CURVE)


def _heard(view: Fitted, known: Catalogued, observed: FloatArray) -> Heard:
    """In deviations of measurement and drift, as far as the view compresses none of them."""
    seen = view.view(view.whiten(observed)[None])[0]
    return Heard(shown=view.view(view.whiten(known.library.changes)), seen=seen, variance=np.ones(seen.size))


def _further(asked: _Asked, told: Sized | None) -> _Asked | None:
    """The sizes beyond an end, where the size may lie there and such are sought."""
    least, most = asked.sought
    many = asked.many // 2
    if told is not None and told.above and asked.high < most:
        return replace(asked, low=asked.high, high=min(asked.high * BEYOND, most), many=many)
    if told is not None and told.below and asked.low > least:
        return replace(asked, low=max(asked.low / BEYOND, least), high=asked.low, many=many)
    return None


def _open(size: Severity, told: Sized, sought: tuple[float, float]) -> Severity:
    """The size, with an interval as far as is sought where it may lie beyond all that was tried."""
    low = min(size.low, sought[0]) if told.below else size.low
    return replace(size, low=low, high=max(size.high, sought[1]) if told.above else size.high)
