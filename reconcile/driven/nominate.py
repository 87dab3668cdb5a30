"""Candidate laws tried by free-running simulation: fitted on one stretch, scored on another that the fit never saw."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from reconcile.driven.channels import FloatArray
from reconcile.driven.fit import Fitted, fit
from reconcile.driven.model import Model, Run, errors
from reconcile.force_law.library import FREE_POWER, Law
from reconcile.force_law.samples import block_sums, even_blocks
from reconcile.force_law.search import SearchResult

MOST_TRIED = 8
MOST_LAWS = 3
LEAST_GAIN = 0.05
"""Fall of the mean square error that is worth another law."""
BLOCKS = 20
LEAD = 2.0
"""Standard errors by which a law must lead another."""


@dataclass(frozen=True, kw_only=True)
class Trial:
    """A model with laws: fitted on one stretch, with its squared error in blocks of the other, (blocks,)."""

    laws: tuple[Law, ...]
    fitted: Fitted
    squares: FloatArray

    @property
    def mean_square(self) -> float:
        """On the stretch that was not fitted."""
        return float(self.squares.mean())


def squares_in_blocks(error: FloatArray) -> FloatArray:
    """Mean square in each of `BLOCKS` blocks."""
    blocks = even_blocks(error.size, BLOCKS)
    with np.errstate(over="ignore"):
        total = block_sums(np.clip(error, -1e9, 1e9) ** 2, blocks, BLOCKS)
    return np.asarray(total / np.maximum(np.bincount(blocks, minlength=BLOCKS), 1))


def score_nats(before: FloatArray, after: FloatArray) -> tuple[float, float]:
    """Predictive log score of `after` over `before` and its standard error: one Gaussian draw a block, so cautious."""
    each = 0.5 * np.log(np.maximum(before, 1e-300) / np.maximum(after, 1e-300))
    return float(each.sum()), float(each.std(ddof=1) * math.sqrt(each.size))


def leads(before: FloatArray, after: FloatArray) -> bool:
    """Whether `after` scores two standard errors above `before` (squares in blocks): one odd block cannot decide."""
    score, error = score_nats(before, after)
    return score > LEAD * error


def trial(base: Model, laws: Sequence[Law], run: Run, other: Run, start: Sequence[float] | None = None) -> Trial:
    """Fit with these laws from the base's linear part."""
    first = tuple(start) if start is not None else (0.0,) * len(laws)
    fitted = fit(base.with_laws(laws, first), run)
    return Trial(laws=tuple(laws), fitted=fitted, squares=squares_in_blocks(errors(fitted.model, other)))


def shortlist(found: SearchResult) -> tuple[Law, ...]:
    """The most telling candidates by their share of the latent force, one gap or speed of a kind each."""
    kept: dict[str, Law] = {}
    for law, _, _ in found.ranked:
        kept.setdefault(law.key, law)
    return tuple(kept.values())[:MOST_TRIED]


@dataclass(frozen=True, kw_only=True)
class Nominated:
    """Single laws in order of merit, and the combination that was reached stepwise (empty laws: linear)."""

    linear: Trial
    singles: tuple[Trial, ...]
    chosen: Trial


def _earns(before: Trial, after: Trial) -> bool:
    return leads(before.squares, after.squares) and after.mean_square < (1.0 - LEAST_GAIN) * before.mean_square


def nominate(linear: Fitted, found: SearchResult, run: Run, other: Run) -> Nominated:
    """Try the short list one by one, then add to the best while an addition earns its place (2 standard errors)."""
    none = Trial(laws=(), fitted=linear, squares=squares_in_blocks(errors(linear.model, other)))
    laws = shortlist(found)
    singles = sorted((trial(linear.model, (law,), run, other) for law in laws), key=lambda t: t.mean_square)
    chosen = none
    pool: list[Trial] = list(singles)
    while pool and len(chosen.laws) < MOST_LAWS and _earns(chosen, pool[0]):
        chosen = pool[0]
        rest = [law for law in laws if all(law.key != other_law.key for other_law in chosen.laws)]
        model = chosen.fitted.model
        start = (*model.coefficients, 0.0)
        pool = sorted(
            (trial(model, (*chosen.laws, law), run, other, start) for law in rest), key=lambda t: t.mean_square
        )
    return Nominated(linear=none, singles=tuple(singles), chosen=chosen)


@dataclass(frozen=True, kw_only=True)
class PowerFit:
    """Exponent of the odd law by free-run error, with a 90 % interval (curvature, block-robust scale)."""

    value: float
    low: float
    high: float


def free_power(base: Model, laws: Sequence[Law], run: Run) -> PowerFit | None:
    """Replace the odd law among `laws` by sgn z |z|^p and fit p with everything else; None without an odd law."""
    odd = [law for law in laws if law.key in ("cubic", "quintic", "odd_square")]
    if len(odd) != 1:
        return None
    others = [law for law in laws if law is not odd[0]]
    grid = odd[0].power + np.array([-0.3, -0.15, 0.0, 0.15, 0.3])
    linear = base.with_laws((), ())
    sums = []
    for p in grid:
        law = replace(FREE_POWER, shape=float(p))
        fitted = fit(linear.with_laws((*others, law), (0.0,) * (len(others) + 1)), run)
        sums.append(squares_in_blocks(fitted.error))
    # Each block has its own parabola over p: their sum gives the exponent, their scatter its error.
    curves = np.stack([np.polyfit(grid, [s[k] for s in sums], 2) for k in range(BLOCKS)])
    total = curves.sum(axis=0)
    if total[0] <= 0:
        return None
    value = -0.5 * float(total[1] / total[0])
    slopes = 2.0 * curves[:, 0] * value + curves[:, 1]
    half = 1.645 * math.sqrt(float(np.sum(slopes**2))) / (2.0 * float(total[0]))
    return PowerFit(value=value, low=value - half, high=value + half)
