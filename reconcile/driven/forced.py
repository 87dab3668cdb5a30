"""Force in, motion out: calibrate, test, locate, nominate, validate; each step's result in one place."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from reconcile.driven.channels import FloatArray
from reconcile.driven.doubt import doubted
from reconcile.driven.fit import Fitted, best_fit, first_guess, fit
from reconcile.driven.latent import latent_force
from reconcile.driven.missing import Missing, anything_missing
from reconcile.driven.model import Model, Run, bounded, diverges, errors, nrmse, ready, simulated
from reconcile.driven.nominate import Nominated, PowerFit, free_power, nominate, squares_in_blocks
from reconcile.driven.rivals import black_box, black_box_error, placebo_errors
from reconcile.driven.split import Part, order_of_use, stretches
from reconcile.force_law.exponent import Exponent, odd_exponent
from reconcile.force_law.samples import ForceSamples
from reconcile.force_law.search import SearchResult, search

ALPHA = 0.01
RESAMPLES = 1000


@dataclass(frozen=True, kw_only=True)
class Validation:
    """Free-run NRMSE on a held-out part: linear as fitted elsewhere, with the laws, and the rivals."""

    fitted_on: str
    held: str
    before: float
    after: float
    gain: tuple[float, float, float]
    """1 - after / before, with its 90 % interval over resampled blocks."""
    retuned: float
    """The linear model fitted to the held-out part itself: the best that retuning could do there."""
    black_box: float
    placebo: float
    """The better of a wrong law and of the right force scrambled."""
    over_placebo: tuple[float, float, float]
    """1 - what the laws leave / what the placebo leaves, with its 90 % interval over resampled blocks."""
    diverged: bool
    """The free run with the laws flew off: `after` and `gain` are then at their bounds."""


@dataclass(frozen=True, kw_only=True)
class Analysis:
    """Everything that was found."""

    linear: Fitted
    fitted_nrmse: float
    missing: Missing
    left: Missing | None
    latent: ForceSamples
    found: SearchResult
    exponent: Exponent
    nominated: Nominated | None
    final: Fitted
    power: PowerFit | None
    validations: tuple[Validation, ...]
    fitted_run: Run
    held_run: Run
    held_before: FloatArray
    held_after: FloatArray
    """Simulated output on the first held-out part, (n,)."""

    @property
    def published(self) -> Model:
        """The model for the simulator: without laws where these make a free run diverge."""
        return (self.linear if any(v.diverged for v in self.validations) else self.final).model


def gain_interval(a: FloatArray, b: FloatArray, rng: np.random.Generator) -> tuple[float, float, float]:
    """1 - after / before of root mean squares by block (blocks,), with a 90 % interval over resampled blocks."""
    picks = rng.integers(0, a.size, (RESAMPLES, a.size))
    again = 1.0 - np.sqrt(b[picks].mean(axis=1) / a[picks].mean(axis=1))
    low, high = np.quantile(again, (0.05, 0.95))
    return 1.0 - float(np.sqrt(b.mean() / a.mean())), float(low), float(high)


def _fraction(error: FloatArray, before: FloatArray) -> float:
    return 1.0 - float(np.sqrt(np.mean(error**2) / np.mean(before**2)))


def validate(linear: Fitted, final: Fitted, run: Run, held: Run, names: tuple[str, str], seed: int) -> Validation:
    """Score on a part that no fit saw, with the rivals."""
    rng = np.random.default_rng([seed, 7])
    before, after = errors(linear.model, held), errors(final.model, held)
    retuned = fit(linear.model, held)
    box = black_box(run.data, final.model.vector().size)
    placebo = min(placebo_errors(linear.model, final.model.laws, run, held, rng), key=lambda e: float(np.mean(e**2)))
    squares = [squares_in_blocks(e) for e in (before, after, placebo)]
    return Validation(
        fitted_on=names[0],
        held=names[1],
        before=nrmse(before, held.compared),
        after=nrmse(after, held.compared),
        gain=gain_interval(squares[0], squares[1], rng),
        retuned=_fraction(retuned.error, before),
        black_box=_fraction(black_box_error(box, held), before),
        placebo=_fraction(placebo, before),
        over_placebo=gain_interval(squares[2], squares[1], rng),
        diverged=diverges(final.model, held),
    )


@dataclass(frozen=True, kw_only=True)
class Calibrated:
    """Linear model on a part's stretches, with both stretches ready to run."""

    run: Run
    other: Run
    linear: Fitted


def calibrate(part: Part, *, quiet: bool = False) -> Calibrated:
    """Linear model by free-run error, from the frequency response; on the liveliest stretch, or on the quietest."""
    first, second = stretches(part, quiet=quiet)
    start = first_guess(part.data)
    rough = fit(start, ready(first, start.memory_s))
    run, other = ready(first, rough.model.memory_s), ready(second, rough.model.memory_s)
    return Calibrated(run=run, other=other, linear=fit(rough.model, run))


def _reverse(parts: Sequence[Part], final: Model, names: tuple[str, str], seed: int) -> tuple[Validation, Fitted]:
    """The named structure fitted on the part that was held out, scored on the one that was fitted; and that fit."""
    by_name = {p.name: p for p in parts}
    fit_part, held_part = by_name[names[1]], by_name[names[0]]
    found = calibrate(fit_part)
    base, quiet = found.linear.model, calibrate(fit_part, quiet=True).linear.model
    none = (0.0,) * len(final.laws)
    starts = [model.with_laws(final.laws, none) for model in (base, quiet)]
    again = best_fit(starts, found.run, stretches=(found.other,))
    held = ready(held_part.data, found.linear.model.memory_s)
    return validate(found.linear, again, found.run, held, (names[1], names[0]), seed), again


def analyse(parts: Sequence[Part], seed: int) -> Analysis:
    """All steps; the parts are recordings or consecutive stretches of one."""
    rng = np.random.default_rng([seed, 1])
    fit_part, held_part = order_of_use(parts)
    start = calibrate(fit_part)
    run, linear = start.run, start.linear
    missing = anything_missing(linear.model, run, linear.error, rng)
    latent = latent_force(linear.model, run, linear.error)
    found = search(latent)
    exponent = odd_exponent(latent, rng)
    nominated = nominate(linear, found, run, start.other) if missing.p_value < ALPHA else None
    chosen = nominated.chosen.fitted.model if nominated is not None else linear.model
    final = fit(chosen, run, stretches=(start.other,)) if chosen.laws else linear
    held = ready(held_part.data, linear.model.memory_s)
    names = (fit_part.name, held_part.name)
    validations: tuple[Validation, ...] = ()
    if chosen.laws:
        backward, again = _reverse(parts, final.model, names, seed)
        final = doubted(final, (run, start.other), again)
        validations = (validate(linear, final, run, held, names, seed), backward)
    return Analysis(
        linear=linear,
        fitted_nrmse=nrmse(linear.error, run.compared),
        missing=missing,
        left=anything_missing(final.model, run, errors(final.model, run), rng) if chosen.laws else None,
        latent=latent,
        found=found,
        exponent=exponent,
        nominated=nominated,
        final=final,
        power=free_power(linear.model, chosen.laws, run) if chosen.laws else None,
        validations=validations,
        fitted_run=run,
        held_run=held,
        held_before=simulated(linear.model, held),
        held_after=bounded(simulated(final.model, held), held),
    )
