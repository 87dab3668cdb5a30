"""Stage 5: machine, size and shape of the leading effects fitted jointly to what was observed.

The machines that agree with a baseline still differ in what an effect changes on them. For each leading effect an
ensemble of such machines that have it is moved towards the observed changes, numbers of the machine and parameters of
the effect together: the ensemble smoother of `reconcile.calibrate.posterior`, with the same limits. What the right
effect leaves shrinks by that; a wrong one stays wrong (docs/decisions/reconcile-joint.md).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from reconcile.atlas.bank import Mapper
from reconcile.atlas.candidates import COUNTED, Candidate
from reconcile.atlas.plan import Draw
from reconcile.calibrate.posterior import FARTHEST, smoothed
from reconcile.calibrate.uncertain import SPREAD, Offsets
from reconcile.judge.screen import judge
from reconcile.judge.space import Fitted, with_draws
from reconcile.machine.library import Catalogued, catalogued, joined
from reconcile.machine.local import simulated_banks
from reconcile.machine.setting import Found, Setting
from signals.series import FloatArray
from sim.core.errors import SpecError
from sim.core.params import Param
from sim.core.spec import TermSpec
from sim.terms import REGISTRY

LINE_ERROR = 1.5
"""Standard deviation of the model's own error at a single line, in deviations of measurement and drift."""
FAR_BEHIND = 10.0
"""Log evidence; an ensemble gained at most 7 by being moved (eight development cases)."""
LEAST = 1e-30
FEWEST = 6
"""Members that must run."""


@dataclass(frozen=True, kw_only=True)
class Task:
    """An effect that is fitted together with the machine, the `view` of single lines that is compared, and the `target`
    (F,) in dB that it is fitted to: the whole change, or what another effect leaves of it (`second`)."""

    name: str
    view: Fitted
    target: FloatArray
    second: bool = False


@dataclass(frozen=True, kw_only=True)
class Ensemble:
    """Machines with an effect: the `offsets` of each member, its term and the `changes` (n, F) it shows, dB; `also`: a
    second effect of each, or none."""

    candidate: Candidate
    offsets: tuple[Offsets, ...]
    terms: tuple[TermSpec, ...]
    changes: FloatArray
    also: tuple[TermSpec, ...] = ()


def _moves(param: Param) -> bool:
    """Choices, orders and what is nothing unless it is asked for stay: every member has the same parameters to move."""
    counted = param.unit == "1" and param.default >= COUNTED and float(param.default).is_integer()
    return not (param.choices or param.default == 0.0 or counted)


def _linear(param: Param) -> bool:
    return param.unit == "rad" and param.scale == "linear"


def _params(term: TermSpec) -> list[Param]:
    known = REGISTRY.get(term.term)
    if known is None:
        raise ValueError(f"no term {term.term}")
    return [p for p in known.params if p.name in term.parameters and _moves(p)]


def packed(term: TermSpec) -> FloatArray:
    """The parameters that move, (k,): logarithms, angles as they are."""
    values = [(p, term.parameters[p.name]) for p in _params(term)]
    return np.array([v if _linear(p) else np.log(max(abs(v), LEAST)) for p, v in values])


def unpacked(term: TermSpec, values: FloatArray) -> TermSpec:
    """The term with these parameters, within their bounds."""
    found = dict(term.parameters)
    for param, value in zip(_params(term), values, strict=True):
        new = value if _linear(param) else np.copysign(np.exp(min(value, 300.0)), found[param.name])
        found[param.name] = float(np.clip(new, param.low, param.high))
    return term.model_copy(update={"parameters": found})


def known_ensemble(setting: Setting, known: Catalogued, name: str, members: int) -> Ensemble | None:
    """The last draws of an effect, which are the nearest to its best; None where they are too few."""
    rows = known.library.groups.get(name, ())[-members:]
    if len(rows) < FEWEST:
        return None
    term, site = name.split("@")
    return Ensemble(
        candidate=Candidate(term=term, site=site),
        offsets=tuple(setting.plan.offsets[known.pairs[k]] for k in rows),
        terms=tuple(known.terms[k] for k in rows),
        changes=known.library.changes[list(rows)],
    )


def simulated_again(
    setting: Setting,
    candidate: Candidate,
    offsets: Sequence[Offsets],
    terms: Sequence[TermSpec],
    mapper: Mapper,
    also: Sequence[TermSpec] = (),
) -> Catalogued | None:
    """What the moved machines show with the effect, and a second one where there are any, against what they show
    without; None where too few run."""
    count, based = range(len(offsets)), setting.changes.with_baseline
    every = tuple(offsets)
    rest = replace(setting.plan, offsets=every, twins=every, draws=tuple(Draw(pair=k) for k in count))
    more = [(also[k],) if also else () for k in count]
    draws = tuple(Draw(pair=k, candidate=candidate, term=terms[k], also=more[k]) for k in count)
    plan = replace(rest, draws=draws)
    healthy, banks = simulated_banks(setting, rest, mapper), simulated_banks(setting, plan, mapper)
    try:
        known = catalogued(plan, banks, setting.seen_through, rest, healthy, with_baseline=based)
    except SpecError:
        return None
    return known if len(known.terms) >= FEWEST else None


def moved(before: Ensemble, fine: Fitted, observed: FloatArray, inflation: float, rng: np.random.Generator) -> Ensemble:
    """Machines and parameters of the members after one assimilation of the single lines of `observed` (F,); what they
    show is what they showed before."""
    numbers = np.array([o.values for o in before.offsets])
    sets = [terms for terms in (before.terms, before.also) if terms]
    shown = fine.view(fine.whiten(before.changes))
    seen = fine.view(fine.whiten(observed)[None])[0]
    parts = [numbers, *(np.array([packed(t) for t in terms]) for terms in sets)]
    theta = np.concatenate(parts, axis=1)
    errors = inflation * LINE_ERROR**2 * np.eye(seen.size)
    after = smoothed(theta, shown, np.ones(len(theta), dtype=bool), seen, errors, rng)
    limit = FARTHEST * SPREAD
    machines, *found = np.split(after, np.cumsum([part.shape[1] for part in parts])[:-1], axis=1)
    offsets = tuple(Offsets(values=np.clip(row, -limit, limit)) for row in machines)
    led = [tuple(map(unpacked, terms, rows)) for terms, rows in zip(sets, found, strict=True)]
    return replace(before, offsets=offsets, terms=led[0], also=led[1] if before.also else ())


def assimilated(
    setting: Setting, found: Found, tasks: Sequence[Task], members: int, rounds: int, mapper: Mapper
) -> Found:
    """What the candidates say when ensembles of some are moved to their targets, in `rounds` steps.

    How unusual the change is stays as it was: healthy machines were not moved towards anything.
    """
    if found.fine is None:
        return found
    now = replace(found, before=found.known)
    for task in tasks:
        if not task.second and settled(now, task.name):
            continue
        first = known_ensemble(setting, found.known, task.name, members)
        for middle, more in _steps(setting, task.view, first, task.target, rounds, mapper):
            now = _with(setting, replace(now, led={**now.led, task.name: middle}), more)
    return now


def settled(found: Found, name: str) -> bool:
    """Whether another effect is met to the last line and so far ahead that this one need not be moved."""
    screen = found.screen
    behind = float(screen.evidence.max() - screen.evidence[screen.names.index(name)])
    return screen.rest.unmet == 0.0 and screen.rest.kept > 0.0 and behind > FAR_BEHIND


def _with(setting: Setting, found: Found, more: Catalogued) -> Found:
    """The candidates judged anew with draws that were led to the observation."""
    views = [with_draws(v, more.library) for v in found.views]
    before, direct = found.screen, setting.direct
    after = judge(views, setting.changes.observed, direct.evidence, direct.p)
    kept = {n: getattr(before, n) for n in ("p_any", "p_best", "p_direct", "p_lines", "lines_asked", "strongest")}
    best = after.names[int(np.argmax(after.evidence))]
    rest = replace(after.rest, rough=best not in found.led)
    screen = replace(after, rest=rest, unmoved=before.pattern, **kept)
    fitted, fine, sides, twice = (*views, None, None, None)[:4]
    phases = tuple(views[4:])
    return replace(
        found,
        known=joined(found.known, more),
        fitted=fitted or found.fitted,
        fine=fine,
        sides=sides,
        twice=twice,
        phases=phases,
        screen=screen,
    )


def _steps(
    setting: Setting, fine: Fitted, now: Ensemble | None, target: FloatArray, rounds: int, mapper: Mapper
) -> Iterator[tuple[Offsets, Catalogued]]:
    """After each assimilation the mean machine and what the members show, while enough of them run."""
    rng = np.random.default_rng([setting.seed, 21, *(now.candidate.label.encode() if now else b"")])
    for _ in range(rounds):
        if now is None:
            return
        led = moved(now, fine, target, float(rounds), rng)
        more = simulated_again(setting, led.candidate, led.offsets, led.terms, mapper)
        if more is None:
            return
        kept = more.offsets
        yield Offsets(values=np.mean([o.values for o in kept], axis=0)), more
        now = replace(now, offsets=kept, terms=more.terms, changes=more.library.changes)
