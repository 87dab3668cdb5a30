"""Is anything missing? A score test on the linear model's error with a parametric bootstrap.

Each smooth law gives a signal: what the linear model would answer to that force along its own motion. The statistic is
the share of the whitened error that all of them explain together, once everything a retuning of the linear model could
explain has been taken out (of error and signals alike). Its null distribution comes from errors with the same spectrum
and random phases, put through the same steps.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from reconcile.driven.channels import FloatArray
from reconcile.driven.model import Model, Run, answer_to, simulated
from reconcile.force_law.library import SMOOTH

RESAMPLES = 399
SMOOTHING = 33
"""Lines over which the error's spectrum is averaged for whitening."""
FLOOR = 1e-3
"""Smallest spectrum over the median one: whitening must not blow up lines where nothing was measured."""


@dataclass(frozen=True, kw_only=True)
class Missing:
    """`statistic`: share of the error explained; `null_95`: what 95 % of errors without a cause stay below."""

    statistic: float
    null_95: float
    p_value: float


def sensitivities(model: Model, run: Run) -> FloatArray:
    """What changes of the linear parameters do to the output, (n - skip, 5)."""
    x = simulated(model, run) - model.output_offset
    v = np.gradient(x, run.data.step_s)
    causes = (x, v, run.data.drive, np.ones(x.size))
    found = [answer_to(model, c, run.data.step_s, run.data.order)[run.skip :] for c in causes]
    return np.column_stack([*found, np.ones(x.size - run.skip)])


def _signals(model: Model, run: Run) -> FloatArray:
    x = simulated(model, run) - model.output_offset
    v = np.gradient(x, run.data.step_s)
    return np.column_stack(
        [answer_to(model, law.values(x, v), run.data.step_s, run.data.order)[run.skip :] for law in SMOOTH]
    )


def _whitener(error: FloatArray) -> FloatArray:
    """Amplitude factors by line, (n // 2 + 1,)."""
    power = np.abs(np.fft.rfft(error)) ** 2
    smooth = np.convolve(np.pad(power, SMOOTHING // 2, mode="edge"), np.ones(SMOOTHING) / SMOOTHING, mode="valid")
    return np.asarray(1.0 / np.sqrt(np.maximum(smooth, FLOOR * float(np.median(smooth)) + 1e-300)))


def _white(columns: FloatArray, factors: FloatArray) -> FloatArray:
    n = columns.shape[0]
    return np.asarray(np.fft.irfft(np.fft.rfft(columns, axis=0) * factors[:, None], n, axis=0))


def _frame(columns: FloatArray) -> FloatArray:
    size = np.linalg.norm(columns, axis=0)
    left, sizes, _ = np.linalg.svd(columns / np.where(size > 0, size, 1.0), full_matrices=False)
    return np.asarray(left[:, sizes > 1e-9 * sizes[0]])


def score_test(error: FloatArray, retuning: FloatArray, causes: FloatArray, rng: np.random.Generator) -> Missing:
    """Test an error (n,) against signals of candidate causes (n, k), free of what retuning explains (n, m)."""
    factors = _whitener(error)
    held = _frame(_white(retuning, factors))
    signals = _white(causes, factors)
    frame = _frame(signals - held @ (held.T @ signals))

    def share(candidate: FloatArray) -> float:
        white = _white(candidate[:, None], factors)[:, 0]
        rest = white - held @ (held.T @ white)
        return float(np.sum((frame.T @ rest) ** 2) / max(float(rest @ rest), 1e-300))

    lines = np.abs(np.fft.rfft(error))
    found = share(error)
    null = []
    for _ in range(RESAMPLES):
        turned = lines * np.exp(2j * np.pi * rng.uniform(size=lines.size))
        null.append(share(np.fft.irfft(turned, error.size)))
    p = (1 + sum(value >= found for value in null)) / (RESAMPLES + 1)
    return Missing(statistic=found, null_95=float(np.quantile(null, 0.95)), p_value=float(p))


def anything_missing(model: Model, run: Run, error: FloatArray, rng: np.random.Generator) -> Missing:
    """Test the error (n - skip,) that a fitted model left on a stretch."""
    return score_test(error, sensitivities(model, run), _signals(model, run), rng)
