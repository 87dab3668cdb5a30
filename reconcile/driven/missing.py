"""Is anything missing? A score test on the linear model's error with a parametric bootstrap.

Each smooth law gives a signal: what the linear model would answer to that force along its own motion. The statistic is
the share of the whitened error that all of them explain together, once everything a retuning of the linear model could
explain has been taken out (of error and signals alike). Its null distribution comes from errors with the same spectrum
and random phases, put through the same steps.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import scipy
from scipy import fft

from reconcile.driven.channels import FloatArray
from reconcile.driven.model import Model, Run, answer_to, simulated
from reconcile.force_law.library import SMOOTH

RESAMPLES = 399
SMOOTHING = 33
"""Lines over which the error's spectrum is averaged for whitening."""
FLOOR = 1e-3
"""Smallest spectrum over the median one: whitening must not blow up lines where nothing was measured."""
TAPERED = 0.5
"""Share of a stretch over which it fades in and out: made linear oscillators whose force is noisy leave an error that
is a hundred times as strong at the resonance as elsewhere, and without it 11 of 40 alarmed at p < 0.01."""


@dataclass(frozen=True, kw_only=True)
class Missing:
    """`statistic`: share of the error explained; `null_95`: what 95 % of errors without a cause stay below."""

    statistic: float
    null_95: float
    p_value: float


def displaced(model: Model, run: Run) -> FloatArray:
    """Displacement of the linear model along the measured input, (n,), whatever derivative the output is."""
    if run.data.order == 0:
        return np.asarray(simulated(model, run) - model.output_offset)
    return answer_to(model, model.gain * run.data.drive + model.offset, run.data.step_s, 0)


def sensitivities(model: Model, run: Run, x: FloatArray) -> FloatArray:
    """What changes of the linear parameters do to the output, (n - skip, 5), along a displacement x (n,)."""
    causes = (x, np.gradient(x, run.data.step_s), run.data.drive, np.ones(x.size))
    found = [answer_to(model, c, run.data.step_s, run.data.order)[run.skip :] for c in causes]
    return _counted_columns(np.column_stack([*found, np.ones(x.size - run.skip)]), run)


def _signals(model: Model, run: Run, x: FloatArray) -> FloatArray:
    v = np.gradient(x, run.data.step_s)
    found = [answer_to(model, law.values(x, v), run.data.step_s, run.data.order)[run.skip :] for law in SMOOTH]
    return _counted_columns(np.column_stack(found), run)


def _counted_columns(columns: FloatArray, run: Run) -> FloatArray:
    """Signals (n - skip, k) as the error has them: 0 where a channel was spoiled."""
    return columns if run.kept is None else columns * run.kept[:, None]


def _smooth(power: FloatArray) -> FloatArray:
    """Mean over `SMOOTHING` lines."""
    return np.convolve(np.pad(power, SMOOTHING // 2, mode="edge"), np.ones(SMOOTHING) / SMOOTHING, mode="valid")


@lru_cache(maxsize=4)
def _taper(n: int) -> FloatArray:
    """Weights (n,) that fade in and out: an end cut off sharply leaks from strong lines into weak ones, of error and
    signals alike, and what both have in common then looks like a cause."""
    weights = np.asarray(scipy.signal.windows.tukey(n, TAPERED), dtype=np.float64)
    weights.flags.writeable = False
    return weights


def _lines(error: FloatArray) -> FloatArray:
    """Amplitudes of an error's lines, (n // 2 + 1,), of what goes on without its ends."""
    fade = _taper(error.size)
    return np.asarray(np.abs(fft.rfft(error * fade)) / np.sqrt(np.mean(fade**2)))


def _whitener(error: FloatArray) -> FloatArray:
    """Amplitude factors by line, (n // 2 + 1,)."""
    smooth = _smooth(_lines(error) ** 2)
    return np.asarray(1.0 / np.sqrt(np.maximum(smooth, FLOOR * float(np.median(smooth)) + 1e-300)))


def _white(columns: FloatArray, factors: FloatArray) -> FloatArray:
    n = columns.shape[0]
    faded = columns * _taper(n)[:, None]
    return np.asarray(fft.irfft(fft.rfft(faded, axis=0) * factors[:, None], n, axis=0))


def _frame(columns: FloatArray) -> FloatArray:
    size = np.linalg.norm(columns, axis=0)
    left, sizes, _ = np.linalg.svd(columns / np.where(size > 0, size, 1.0), full_matrices=False)
    return np.asarray(left[:, sizes > 1e-9 * sizes[0]])


def score_test(
    error: FloatArray,
    retuning: FloatArray,
    causes: FloatArray,
    rng: np.random.Generator,
    kept: FloatArray | None = None,
) -> Missing:
    """Test an error (n,) against signals of candidate causes (n, k), free of what retuning explains (n, m).

    `kept` (n,): 0 where error and signals were set to 0.
    """
    factors = _whitener(error)
    held = _frame(_white(retuning, factors))
    signals = _white(causes, factors)
    frame = _frame(signals - held @ (held.T @ signals))

    def share(candidate: FloatArray) -> float:
        white = _white(candidate[:, None], factors)[:, 0]
        rest = white - held @ (held.T @ white)
        return float(np.sum((frame.T @ rest) ** 2) / max(float(rest @ rest), 1e-300))

    lines, seen = _lines(error), 1.0 if kept is None else kept
    found = share(error)
    null = []
    for _ in range(RESAMPLES):
        turned = lines * np.exp(2j * np.pi * rng.uniform(size=lines.size))
        null.append(share(seen * fft.irfft(turned, error.size)))
    p = (1 + sum(value >= found for value in null)) / (RESAMPLES + 1)
    return Missing(statistic=found, null_95=float(np.quantile(null, 0.95)), p_value=float(p))


def anything_missing(model: Model, run: Run, error: FloatArray, rng: np.random.Generator) -> Missing:
    """Test the error (n - skip,) that a fitted model left on a stretch."""
    x = displaced(model, run)
    return score_test(error, sensitivities(model, run, x), _signals(model, run, x), rng, run.kept)
