"""Force in, motion out: calibrated, validated; the result of each step in one place."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from reconcile.driven.channels import FloatArray
from reconcile.driven.fit import Fitted, first_guess, fit
from reconcile.driven.missing import Missing
from reconcile.driven.model import Model, Run, diverges, errors, nrmse, ready
from reconcile.driven.nominate import Nominated, PowerFit, squares_in_blocks
from reconcile.driven.rivals import black_box, black_box_error, placebo_errors
from reconcile.driven.split import Part, stretches
from reconcile.force_law.exponent import Exponent
from reconcile.force_law.library import Law
from reconcile.force_law.samples import ForceSamples
from reconcile.force_law.search import SearchResult

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
    led: bool = False
    """All errors are of runs that the measured output leads: the free run is at the mercy of the numbers."""
    free: float | None = None
    """What the laws leave in a free run, where `after` is led."""


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
    beyond_noise: float = 0.0
    """Share of the output that the laws leave on the fitted stretch and that no noise known apart accounts for."""
    laws_leave: float = 0.0
    """Share of the output that the laws leave on the fitted stretch."""
    unsure: bool = False
    """The free run on the part held out is off by no more than what is known of the numbers lets it be."""
    dropped: tuple[Law, ...] = ()
    """Laws that were nominated and left out again: the part held out did not ask for them."""

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


def validate(
    linear: Fitted, final: Fitted, run: Run, held: Run, names: tuple[str, str], seed: int, *, led: float = 0.0
) -> Validation:
    """Score on a part that no fit saw, with the rivals; `led`: share of the frequency at which all runs are led."""
    rng = np.random.default_rng([seed, 7])
    shown = replace(held, led=led)
    before, after = errors(linear.model, shown), errors(final.model, shown)
    retuned = fit(linear.model, shown)
    box = black_box(run.data, final.model.vector().size)
    placebo = min(placebo_errors(linear.model, final.model.laws, run, shown, rng), key=lambda e: float(np.mean(e**2)))
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
        led=led > 0.0,
        free=nrmse(errors(final.model, held), held.compared) if led else None,
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
