"""From the laws that were nominated to those that are judged: fitted, held out both ways, and pruned.

A law is nominated because a run went better with it, which chance can do beside a law that is right: its interval may
then include zero, and the set would be refused as a whole, or a law be named that is not there. So each law of several
must be asked for by the part that was held out, where the run, free or led, is clearly worse without it. Those that are
not go one by one, the faintest first, and what stays is fitted and held out anew (backward elimination; Draper & Smith
1998, Applied Regression Analysis, section 15.2).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from reconcile.driven.doubt import doubted
from reconcile.driven.fit import LED, Fitted, best_fit, fit
from reconcile.driven.forced import Calibrated, Validation, calibrate, validate
from reconcile.driven.model import LINEAR, Model, Run, errors, ready, simulated
from reconcile.driven.nominate import Nominated, better, squares_in_blocks, trial
from reconcile.driven.split import Part
from reconcile.force_law.library import Law

LOST = 0.25
"""Share of the output that a free run leaves when it has left for another branch of the motion."""
DRAWS = 6
SENSITIVE = 0.3
"""Spread of runs whose numbers are drawn from what is known of them, over what the free run leaves, from which on that
says nothing of the law."""


@dataclass(frozen=True, kw_only=True)
class Case:
    """What is fitted and what is held out, with the linear model of the fitted part."""

    parts: Sequence[Part]
    start: Calibrated
    held: Run
    names: tuple[str, str]
    """Of the fitted and of the held-out part."""
    seed: int
    half: str = ""
    """Which half of the latter is held out; empty where all of it is."""


@dataclass(frozen=True, kw_only=True)
class Settled:
    """The fit on both stretches, its doubts known, and what it does on parts that it did not see."""

    final: Fitted
    validations: tuple[Validation, ...]
    dropped: tuple[Law, ...] = ()


def settle(case: Case, chosen: Model) -> Settled:
    """Fit the chosen laws, hold them out, and leave out those that the part held out does not ask for.

    Which laws go is asked of its first half; where some went the gain is that of the second, which chose nothing.
    """
    found = _settled(case, chosen)
    asked, unseen = _halves(case)
    while (fewer := _fewer(asked, found.final)) is not None:
        gone = [law for law in found.final.model.laws if law.key not in {x.key for x in fewer.laws}]
        found = replace(_settled(unseen, fewer), dropped=(*found.dropped, *gone))
    return found


def _halves(case: Case) -> tuple[Case, Case]:
    """The case with the first half of what is held out, and with the second."""
    data, memory_s = case.held.data, case.start.linear.model.memory_s
    middle = data.answer.size // 2
    first, second = (ready(data.part(*ends), memory_s) for ends in ((0, middle), (middle, data.answer.size)))
    return replace(case, held=first), replace(case, held=second, half="the second half of ")


def _fewer(case: Case, found: Fitted) -> Model | None:
    """The model without the faintest law that can go; None where each that is left is worth its name."""
    model = found.model
    for law in faintest_first(found):
        kept = [i for i in range(len(model.laws)) if i != law]
        start = model.with_laws([model.laws[i] for i in kept], [model.coefficients[i] for i in kept])
        fewer = fit(start, case.start.run, stretches=(case.start.other,)).model
        runs = (case.held, replace(case.held, led=LED)) if case.held.data.order < 2 else (case.held,)
        told = [[squares_in_blocks(errors(m, r)) for m in (fewer, model)] for r in runs]
        if not any(better(without, beside) for without, beside in told):
            return fewer
    return None


def _settled(case: Case, chosen: Model) -> Settled:
    run, other = case.start.run, case.start.other
    final = fit(chosen, run, stretches=(other,))
    back, again, fit_back, held_back = _reverse(case, final.model)
    final = doubted(final, (run, other), again)
    names = (case.names[1], case.names[0])
    ways = (
        _held_out(case.start.linear, final, run, case.held, (case.names[0], case.half + case.names[1]), case.seed),
        _held_out(back, again, fit_back, held_back, names, case.seed),
    )
    return Settled(final=final, validations=ways)


def faintest_first(found: Fitted) -> list[int]:
    """Of several laws, by their size over their interval; a lone one is not asked."""
    sizes = []
    for i in range(len(found.model.laws)):
        value, low, high = found.interval(LINEAR + i)
        sizes.append(abs(value) / max(high - low, 1e-300))
    return sorted(range(len(sizes)), key=lambda i: sizes[i]) if len(sizes) > 1 else []


def _reverse(case: Case, final: Model) -> tuple[Fitted, Fitted, Run, Run]:
    """Linear model and structure fitted on the part that was held out, that stretch, and the fitted part to run on."""
    by_name = {p.name: p for p in case.parts}
    fit_part, held_part = by_name[case.names[1]], by_name[case.names[0]]
    found = calibrate(fit_part)
    base, quiet = found.linear.model, calibrate(fit_part, quiet=True).linear.model
    none = (0.0,) * len(final.laws)
    starts = [model.with_laws(final.laws, none) for model in (base, quiet)]
    again = best_fit([*starts, final], found.run, stretches=(found.other,))
    held = ready(held_part.data, found.linear.model.memory_s)
    return found.linear, again, found.run, held


def _held_out(linear: Fitted, final: Fitted, run: Run, held: Run, names: tuple[str, str], seed: int) -> Validation:
    """By a free run; led by the output where that is lost because it is at the mercy of the last digits."""
    free = validate(linear, final, run, held, names, seed)
    gains = free.gain[1] > max(free.retuned, 0.0) and free.after < LOST
    if gains or held.data.order > 1 or not sensitive(final, held):
        return free
    return validate(linear, final, run, held, names, seed, led=LED)


def sensitive(found: Fitted, held: Run) -> bool:
    """Whether numbers within what is known of them part the free run by as much as it is off."""
    rng = np.random.default_rng(0)
    model, mean = found.model, found.model.vector()
    scatter = found.covariance + sum((np.outer(m, m) for m in found.doubts.moved), np.zeros_like(found.covariance))
    size = np.sqrt(np.maximum(np.diag(scatter), 0.0))
    unit = np.where(size > 0.0, size, 1.0)
    values, vectors = np.linalg.eigh(scatter / np.outer(unit, unit))
    root = unit[:, None] * vectors * np.sqrt(np.maximum(values, 0.0))
    first = simulated(model, held)[held.skip :]
    drawn = [model.of(mean + root @ rng.normal(size=mean.size)) for _ in range(DRAWS)]
    apart = [float(np.mean((simulated(m, held)[held.skip :] - first) ** 2)) for m in drawn]
    return float(np.median(apart)) > SENSITIVE**2 * float(np.mean(errors(model, held) ** 2))


def renominated(found: Nominated, settled: Settled, case: Case) -> Nominated:
    """The nomination with the laws that stayed as the chosen ones, scored as the others are."""
    if not settled.dropped:
        return found
    model = settled.final.model
    chosen = trial(model, model.laws, case.start.run, case.start.other, model.coefficients)
    if len(model.laws) > 1:
        return replace(found, chosen=chosen)
    others = [t for t in found.singles if t.laws[0].key != model.laws[0].key]
    singles = sorted([chosen, *others], key=found.merit)
    return replace(found, chosen=chosen, singles=tuple(singles))
