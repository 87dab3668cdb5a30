"""Candidate laws tried by free-running simulation: fitted on one stretch, scored on another that the fit never saw."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from reconcile.driven.channels import FloatArray
from reconcile.driven.fit import INTERVAL, LED, Fitted, best_fit, descend, fit
from reconcile.driven.model import Model, Run, errors, held_linear
from reconcile.driven.motion import moved
from reconcile.force_law.library import FREE_POWER, Law, mirrored
from reconcile.force_law.samples import ForceSamples, block_sums, even_blocks
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

    fitted: Fitted
    squares: FloatArray
    led: FloatArray
    """The same of a run that is led by the measured output."""

    @property
    def laws(self) -> tuple[Law, ...]:
        """As fitted, gaps included."""
        return self.fitted.model.laws

    @property
    def mean_square(self) -> float:
        """On the stretch that was not fitted."""
        return float(self.squares.mean())


def squares_in_blocks(error: FloatArray) -> FloatArray:
    """Mean square in each of `BLOCKS` blocks."""
    blocks = even_blocks(error.size, BLOCKS)
    total = block_sums(error**2, blocks, BLOCKS)
    return np.asarray(total / np.maximum(np.bincount(blocks, minlength=BLOCKS), 1))


def score_nats(before: FloatArray, after: FloatArray) -> tuple[float, float]:
    """Predictive log score of `after` over `before` and its standard error: one Gaussian draw a block, so cautious."""
    each = 0.5 * np.log(np.maximum(before, 1e-300) / np.maximum(after, 1e-300))
    return float(each.sum()), float(each.std(ddof=1) * math.sqrt(each.size))


def leads(before: FloatArray, after: FloatArray) -> bool:
    """Whether `after` scores two standard errors above `before` (squares in blocks): one odd block cannot decide."""
    score, error = score_nats(before, after)
    return score > LEAD * error


def trial(
    base: Model,
    laws: Sequence[Law],
    run: Run,
    other: Run,
    start: Sequence[float] | None = None,
    latent: ForceSamples | None = None,
) -> Trial:
    """Fit with these laws from the base's linear part.

    A run that no output can lead (of an acceleration) starts from what the latent force tells too: by free runs from a
    linear start a cubic spring was missed altogether, with an error of 18 % where it leaves 0.5 %.
    """
    first = base.with_laws(laws, tuple(start) if start is not None else (0.0,) * len(laws))
    told = [regressed(first, latent)] if latent is not None and run.data.order > 1 else []
    return _scored(best_fit([first, *told], run), other)


def regressed(model: Model, latent: ForceSamples) -> Model:
    """The model with the part of the latent force, beyond its other laws, that its last law and a linear one tell."""
    z, v = latent.displacement_m, latent.velocity_m_per_s
    columns = np.column_stack([np.ones(z.size), z, v, *(law.values(z, v) for law in model.laws)])
    size = np.linalg.norm(columns, axis=0)
    size = np.where(size > 0.0, size, 1.0)
    found = np.linalg.lstsq(columns / size, latent.force_n, rcond=1e-9)[0] / size
    return replace(
        model,
        stiffness=max(model.stiffness + float(found[1]), 0.1 * model.stiffness),
        damping=max(model.damping + float(found[2]), 0.0),
        offset=model.offset - float(found[0]),
        coefficients=tuple(float(c) for c in found[3:]),
    )


def _scored(fitted: Fitted, other: Run) -> Trial:
    led = replace(other, led=LED)
    squares = [squares_in_blocks(errors(fitted.model, r)) for r in (other, led)]
    return Trial(fitted=fitted, squares=squares[0], led=squares[1])


def shortlist(found: SearchResult) -> tuple[Law, ...]:
    """The most telling candidates by their share of the latent force, one gap or speed of a kind each."""
    kept: dict[str, Law] = {}
    for law, _, _ in found.ranked:
        kept.setdefault(law.key, law)
    return tuple(kept.values())[:MOST_TRIED]


def _different(laws: Sequence[Law]) -> list[Law]:
    """Without the second of two laws that are the same beside a linear one: a fit turns it to where it pushes."""
    kept: list[Law] = []
    for law in laws:
        twin = mirrored(law)
        if twin is None or all(twin.key != other.key for other in kept):
            kept.append(law)
    return kept


@dataclass(frozen=True, kw_only=True)
class Nominated:
    """Single laws in order of merit, and the combination that was reached stepwise (empty laws: linear)."""

    linear: Trial
    singles: tuple[Trial, ...]
    chosen: Trial

    def merit(self, tried: Trial) -> float:
        """What trials are ranked by, the best first."""
        return -score_nats(self.linear.squares, tried.squares)[0]


def better(before: FloatArray, after: FloatArray) -> bool:
    """Whether `after` leads, and by enough to be worth another law."""
    return leads(before, after) and float(after.mean()) < (1.0 - LEAST_GAIN) * float(before.mean())


def _earns(before: Trial, after: Trial) -> bool:
    """Whether the last law is worth its name; a further one in a led run too.

    A free run of a sensitive motion is at the mercy of the last digits, and any law can mend its course by chance; what
    is missing of a force is missing at each step.
    """
    return better(before.squares, after.squares) and (not before.laws or better(before.led, after.led))


def nominate(linear: Fitted, found: SearchResult, latent: ForceSamples, run: Run, other: Run) -> Nominated:
    """Try the short list one by one, then add to the best while an addition earns its place (2 standard errors).

    The best has the highest score, by which causes are ranked: one block that a run lost cannot decide.
    """
    none = _scored(linear, other)
    laws = shortlist(found)

    def merit(t: Trial) -> float:
        return -score_nats(none.squares, t.squares)[0]

    singles = sorted((trial(linear.model, (law,), run, other, latent=latent) for law in _different(laws)), key=merit)
    chosen = none
    pool: list[Trial] = list(singles)
    while pool and len(chosen.laws) < MOST_LAWS and _earns(chosen, pool[0]):
        chosen = pool[0]
        rest = [law for law in laws if all(law.key != other_law.key for other_law in chosen.laws)]
        model = chosen.fitted.model
        start = (*model.coefficients, 0.0)
        pool = sorted((trial(model, (*chosen.laws, law), run, other, start) for law in rest), key=merit)
    return Nominated(linear=none, singles=tuple(singles), chosen=chosen)


WIDEST_POWER = 1.0
"""Width of an exponent's interval from which on it is not told: odd laws are tried at 2, 3 and 5, and a wider interval
parts no two of them. Of 36 that were told of made and real recordings 32 are at most 0.54 wide (half of them under 0.1;
a cubic spring heard as a velocity 0.82), the others 1.3 (2.24 to 3.52), 5.9, 37 and 148 (of cubic springs on stretches
that hardly tell it)."""


@dataclass(frozen=True, kw_only=True)
class PowerFit:
    """Exponent of the odd law by free-run error, with a 90 % interval (scatter of blocks; what a led run says)."""

    value: float
    low: float
    high: float


def free_power(base: Model, final: Model, run: Run, other: Run) -> PowerFit | None:
    """Replace the odd law of `final` by sgn z |z|^p and fit p with everything else; None without an odd law,
    and where another restoring law shares the force: what the one lacks of it the other takes, and any exponent fits.

    From the linear `base`; from `final` itself where no output can lead the run. The interval holds the scatter of
    blocks and what the exponent moves by where a true one would stay (`reconcile.driven.doubt`): led, with straight
    lines between the samples of the input, on the `other` stretch, and by the middle of the parabola
    alone. None too where it is wider than `WIDEST_POWER`.
    """
    laws = final.laws
    odd = [law for law in laws if law.key in ("cubic", "quintic", "odd_square")]
    if len(odd) != 1 or sum(not law.rate for law in laws) > 1:
        return None
    others = [law for law in laws if law is not odd[0]]
    grid = odd[0].power + np.array([-0.3, -0.15, 0.0, 0.15, 0.3])
    tried = [(*others, replace(FREE_POWER, shape=float(p))) for p in grid]
    free = [fit(_start(base, final, odd[0], these, run), run) for these in tried]
    found = _lowest(grid, [squares_in_blocks(f.error) for f in free])
    if found is None:
        return None
    value, error = found
    for at in ([held_linear(run)], [other], *([[replace(run, led=LED)]] if run.data.order < 2 else [])):
        again = _lowest(grid, [squares_in_blocks(descend(f.model, at).error) for f in free])
        error = math.hypot(error, again[0] - value if again is not None else 0.0)
    middle = slice(1, grid.size - 1)
    narrow = _lowest(grid[middle], [squares_in_blocks(f.error) for f in free[middle]])
    error = math.hypot(error, narrow[0] - value if narrow is not None else 0.0)
    if 2.0 * INTERVAL * error > WIDEST_POWER:
        return None
    return PowerFit(value=value, low=value - INTERVAL * error, high=value + INTERVAL * error)


def _start(base: Model, final: Model, odd: Law, laws: tuple[Law, ...], run: Run) -> Model:
    """Where a fit with these laws begins, of which the last takes the odd one's place."""
    if run.data.order < 2:
        return base.with_laws(laws, (0.0,) * len(laws))
    sizes = dict(zip(final.laws, final.coefficients, strict=True))
    far = 2.0 * float(moved(final, run)[0].std())
    last = sizes[odd] * far ** (odd.power - laws[-1].shape)
    return final.with_laws(laws, (*(sizes[law] for law in laws[:-1]), last))


def _lowest(grid: FloatArray, sums: Sequence[FloatArray]) -> tuple[float, float] | None:
    """Exponent and its standard error: each block has a parabola over it, their sum the lowest point, they scatter."""
    curves = np.stack([np.polyfit(grid, [s[k] for s in sums], 2) for k in range(BLOCKS)])
    total = curves.sum(axis=0)
    if total[0] <= 0:
        return None
    value = -0.5 * float(total[1] / total[0])
    slopes = 2.0 * curves[:, 0] * value + curves[:, 1]
    return value, math.sqrt(float(np.sum(slopes**2))) / (2.0 * float(total[0]))
