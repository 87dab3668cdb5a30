"""The simplest law that a force follows, or none: stepwise selection with false-discovery control.

A constant, z and v are always in (a linear retuning explains them, and is no discovery). A candidate may enter if its
t value with block-robust errors (Liang & Zeger 1986, Biometrika 73, 13-22; G - 1 degrees of freedom) survives Benjamini
& Hochberg's step-up procedure (1995, J. R. Stat. Soc. B 57, 289-300) at rate `q` over the library, and if the error on
left-out blocks falls by more than its standard error. The best of those by left-out error enters.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy

from reconcile.force_law.library import Law, library
from reconcile.force_law.samples import FloatArray, ForceSamples, block_sums

FALSE_DISCOVERY_RATE = 0.05
MOST_LAWS = 3
FOLDS = 8
LEAST_SHARE = 0.01
"""Share of the force beyond a linear law, on left-out blocks, that a law must explain to be worth a name."""


@dataclass(frozen=True, kw_only=True)
class Chosen:
    """A law with its coefficient, standard error and p value (before correction for the library)."""

    law: Law
    coefficient: float
    standard_error: float
    p_value: float


@dataclass(frozen=True, kw_only=True)
class SearchResult:
    """What survived (nothing: no stable law); `share` of the force beyond linear, explained on left-out blocks."""

    chosen: tuple[Chosen, ...]
    linear: tuple[float, float, float]
    """Constant N, stiffness N/m, damping N s/m that go with it."""
    share: float
    tried: int
    ranked: tuple[tuple[Law, float, float], ...]
    """First step: law, p value, share of the force beyond linear; the most telling first."""

    @property
    def text(self) -> str:
        """The law for a reader."""
        if not self.chosen:
            return "no stable law"
        return " + ".join(f"{c.coefficient:.4g} {c.law.shown()}" for c in self.chosen)


def _robust(column: FloatArray, force: FloatArray, samples: ForceSamples, fitted: int) -> tuple[float, float, float]:
    """Coefficient, block-robust standard error and p value of one column; both are free of what is already in."""
    size = float(column @ column)
    if size <= 0.0:
        return 0.0, math.inf, 1.0
    coefficient = float(column @ force) / size
    scores = block_sums(column * (force - coefficient * column), samples.blocks, samples.count)
    free = max(samples.count - 1 - fitted, 1)
    error = math.sqrt(float(scores @ scores) * samples.count / free) / size
    p = 2.0 * float(scipy.stats.t.sf(abs(coefficient) / max(error, 1e-300), free))
    return coefficient, error, p


def discoveries(p_values: Sequence[float], q: float) -> list[bool]:
    """Benjamini & Hochberg's step-up procedure."""
    p = np.asarray(p_values)
    order = np.argsort(p)
    passing = np.nonzero(p[order] <= q * (np.arange(p.size) + 1) / max(p.size, 1))[0]
    if passing.size == 0:
        return [False] * p.size
    return [bool(value <= p[order][passing[-1]]) for value in p]


def _basis(samples: ForceSamples) -> FloatArray:
    z, v = samples.displacement_m, samples.velocity_m_per_s
    return np.column_stack([np.ones(z.size), z, v])


def _orthogonal(columns: FloatArray) -> FloatArray:
    scale = np.linalg.norm(columns, axis=0)
    return np.asarray(np.linalg.qr(columns / np.where(scale > 0, scale, 1.0))[0])


def _left_out(columns: FloatArray, samples: ForceSamples) -> FloatArray:
    """Squared error on each fold of blocks when fitted on the others, (folds,)."""
    fold = samples.blocks * FOLDS // samples.count
    scale = np.linalg.norm(columns, axis=0)
    scaled = columns / np.where(scale > 0, scale, 1.0)
    parts = [(scaled[fold == k], samples.force_n[fold == k]) for k in range(FOLDS)]
    grams = [a.T @ a for a, _ in parts]
    sides = [a.T @ f for a, f in parts]
    found = []
    for k, (a, f) in enumerate(parts):
        gram, side = sum(grams) - grams[k], sum(sides) - sides[k]
        solution = np.linalg.lstsq(gram, side, rcond=1e-12)[0]
        found.append(float(np.sum((f - a @ solution) ** 2)))
    return np.array(found)


def _improves(before: FloatArray, after: FloatArray) -> bool:
    """Whether the left-out error falls by more than its standard error."""
    drop = before - after
    return float(drop.mean()) > float(drop.std(ddof=1)) / math.sqrt(drop.size)


def _entering(
    laws: Sequence[Law], values: FloatArray, columns: FloatArray, samples: ForceSamples, q: float
) -> tuple[int | None, list[tuple[int, float, float]]]:
    """The candidate that enters next, and p value and in-sample share of each."""
    frame = _orthogonal(columns)
    force = samples.force_n - frame @ (frame.T @ samples.force_n)
    free = values - frame @ (frame.T @ values)
    told = [_robust(free[:, j], force, samples, columns.shape[1]) for j in range(len(laws))]
    total = float(force @ force) or 1.0
    shares = [b * float(free[:, j] @ force) / total for j, (b, _, _) in enumerate(told)]
    found = [(j, told[j][2], shares[j]) for j in range(len(laws))]
    passing = [j for j, keep in enumerate(discoveries([p for _, _, p in told], q)) if keep]
    best = sorted(passing, key=lambda j: -shares[j])[:4]
    before = _left_out(columns, samples)
    errors = {j: _left_out(np.column_stack([columns, values[:, j]]), samples) for j in best}
    better = [j for j in best if _improves(before, errors[j])]
    return (min(better, key=lambda j: float(errors[j].sum())) if better else None), found


def search(
    samples: ForceSamples, laws: Sequence[Law] | None = None, *, q: float = FALSE_DISCOVERY_RATE
) -> SearchResult:
    """Select laws stepwise; at most `MOST_LAWS`, fewer when the next one does not earn its place."""
    known = tuple(laws) if laws is not None else library(samples.displacement_m, samples.velocity_m_per_s)
    values = np.column_stack([law.values(samples.displacement_m, samples.velocity_m_per_s) for law in known])
    columns = _basis(samples)
    linear_error = float(_left_out(columns, samples).sum())
    picked: list[int] = []
    ranked: tuple[tuple[Law, float, float], ...] = ()
    while len(picked) < MOST_LAWS:
        entering, told = _entering(known, values, columns, samples, q)
        if not picked:
            ranked = tuple((known[j], p, share) for j, p, share in sorted(told, key=lambda item: -item[2]))
        if entering is None or entering in picked:
            break
        trial = np.column_stack([columns, values[:, entering]])
        gain = float(_left_out(columns, samples).sum() - _left_out(trial, samples).sum()) / linear_error
        if gain < LEAST_SHARE:
            break
        picked.append(entering)
        columns = trial
    share = 1.0 - float(_left_out(columns, samples).sum()) / linear_error if picked else 0.0
    return SearchResult(
        chosen=_joint([known[j] for j in picked], columns, samples),
        linear=_linear(columns, samples),
        share=share,
        tried=len(known),
        ranked=ranked,
    )


def _linear(columns: FloatArray, samples: ForceSamples) -> tuple[float, float, float]:
    scale = np.linalg.norm(columns, axis=0)
    solution = np.linalg.lstsq(columns / np.where(scale > 0, scale, 1.0), samples.force_n, rcond=None)[0]
    constant, stiffness, damping = (solution / np.where(scale > 0, scale, 1.0))[:3]
    return float(constant), float(stiffness), float(damping)


def _joint(laws: Sequence[Law], columns: FloatArray, samples: ForceSamples) -> tuple[Chosen, ...]:
    """Coefficients of all that is in, each against all others."""
    found = []
    for k, law in enumerate(laws):
        others = _orthogonal(np.delete(columns, 3 + k, axis=1))
        column = columns[:, 3 + k] - others @ (others.T @ columns[:, 3 + k])
        force = samples.force_n - others @ (others.T @ samples.force_n)
        b, error, p = _robust(column, force, samples, columns.shape[1] - 1)
        found.append(Chosen(law=law, coefficient=b, standard_error=error, p_value=p))
    return tuple(found)
