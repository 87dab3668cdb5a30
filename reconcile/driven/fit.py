"""Fit a model to a stretch by its free-run error, with block-robust intervals."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import signal
from scipy.optimize import least_squares

from reconcile.driven.channels import Driven, FloatArray
from reconcile.driven.model import Model, Run, errors
from reconcile.force_law.samples import even_blocks

BLOCKS = 24
INTERVAL = 1.645
"""Standard errors of a 90 % interval."""
OUTPUT_OFFSET = 4
"""Index of the output's offset among the parameters."""
HUGE = 1e6
"""Errors of a run that flew off, in standard deviations of the output."""


@dataclass(frozen=True, kw_only=True)
class Fitted:
    """A fitted model, its covariance (block-robust), and the error left on the stretch."""

    model: Model
    covariance: FloatArray
    error: FloatArray

    def interval(self, index: int) -> tuple[float, float, float]:
        """Value and 90 % interval of a parameter."""
        value = float(self.model.vector()[index])
        half = INTERVAL * math.sqrt(max(float(self.covariance[index, index]), 0.0))
        return value, value - half, value + half


def first_guess(data: Driven) -> Model:
    """Linear model from the frequency response: 1/H is linear in its parameters (weights: coherent, strong lines)."""
    n = min(4096, data.answer.size // 4)
    rate = 1.0 / data.step_s
    frequency, cross = signal.csd(data.drive, data.answer, rate, nperseg=n)
    power_in = signal.welch(data.drive, rate, nperseg=n)[1]
    power_out = signal.welch(data.answer, rate, nperseg=n)[1]
    omega = 2.0 * math.pi * frequency[1:]
    response = cross[1:] / np.maximum(power_in[1:], 1e-300) / (1j * omega) ** data.order
    coherence = np.abs(cross[1:]) ** 2 / np.maximum(power_in[1:] * power_out[1:], 1e-300)
    strong = np.abs(cross[1:]) > 1e-3 * np.abs(cross[1:]).max()
    inverse = 1.0 / np.where(response == 0, 1e-300, response)
    weight = np.where(strong, coherence**2 * np.abs(response), 0.0)
    # 1/H = (stiffness - omega^2 + i omega damping) / gain
    rows = np.block(
        [
            [np.ones((omega.size, 1)), -(omega**2)[:, None], np.zeros((omega.size, 1))],
            [np.zeros((omega.size, 2)), omega[:, None]],
        ]
    )
    side = np.concatenate([inverse.real, inverse.imag])
    scale = np.concatenate([weight, weight])
    columns = rows * scale[:, None]
    size = np.linalg.norm(columns, axis=0)
    a, b, c = np.linalg.lstsq(columns / size, side * scale, rcond=None)[0] / size
    gain = 1.0 / b if b != 0 else 1.0
    stiffness = abs(a * gain)
    damping = min(max(c * gain, 0.002 * math.sqrt(stiffness)), 8.0 * math.sqrt(stiffness))
    return Model(stiffness=stiffness, damping=damping, gain=gain)


def _scales(model: Model, run: Run) -> FloatArray:
    """Steps of the parameters that move the output by about its own size."""
    size = float(run.data.answer.std()) or 1.0
    omega = math.sqrt(abs(model.stiffness)) or 1.0
    force = model.stiffness * size
    z = run.data.answer - run.data.answer.mean()
    v = np.gradient(z, run.data.step_s)
    laws = [0.1 * force / (float(np.std(law.values(z, v))) or 1.0) for law in model.laws]
    return np.array([0.01 * model.stiffness, 0.01 * omega, 0.1 * abs(model.gain), 0.1 * force, 0.1 * size, *laws])


def fit(start: Model, run: Run, *, stretches: Sequence[Run] = ()) -> Fitted:
    """Least squares on the free-run error of one or several stretches, from a start; damping stays positive.

    Without laws the offsets of force and output cannot be told apart: the one of the output then stays.
    """
    runs = (run, *stretches)
    first = start.vector()
    free = np.array([i for i in range(first.size) if start.laws or i != OUTPUT_OFFSET])
    scale = _scales(start, run)
    size = float(run.data.answer.std()) or 1.0

    def model_of(x: FloatArray) -> Model:
        vector = first.copy()
        vector[free] = x * scale[free]
        return start.of(vector)

    def residual(x: FloatArray) -> FloatArray:
        model = model_of(x)
        found = np.concatenate([errors(model, r) for r in runs]) / size
        return np.asarray(np.clip(np.nan_to_num(found, nan=HUGE), -HUGE, HUGE))

    least = np.full(free.size, -np.inf)
    least[:2] = 0.0
    x0 = np.maximum(first[free] / scale[free], least + 1e-9)
    solution = least_squares(residual, x0, bounds=(least, np.inf), x_scale="jac", max_nfev=40, xtol=1e-10, ftol=1e-10)
    found = model_of(solution.x)
    covariance = np.zeros((first.size, first.size))
    inner = block_covariance(np.asarray(solution.jac), solution.fun) * np.outer(scale[free], scale[free])
    covariance[np.ix_(free, free)] = inner
    return Fitted(model=found, covariance=covariance, error=errors(found, run))


def best_fit(starts: Sequence[Model], run: Run, *, stretches: Sequence[Run] = ()) -> Fitted:
    """The fit with the least error on all stretches, from several starts."""
    found = [fit(start, run, stretches=stretches) for start in starts]
    totals = [sum(float(np.sum(errors(f.model, r) ** 2)) for r in (run, *stretches)) for f in found]
    return found[int(np.argmin(totals))]


def block_covariance(jacobian: FloatArray, residual: FloatArray) -> FloatArray:
    """(J'J)^-1 (sum of block scores) (J'J)^-1: errors may be coloured within a block."""
    size = np.linalg.norm(jacobian, axis=0)
    size = np.where(size > 0, size, 1.0)
    columns = jacobian / size
    inverse = np.linalg.pinv(columns.T @ columns, rcond=1e-12)
    blocks = even_blocks(residual.size, BLOCKS)
    scores = np.stack([columns[blocks == k].T @ residual[blocks == k] for k in range(BLOCKS)])
    spread = scores.T @ scores * BLOCKS / (BLOCKS - 1)
    return np.asarray(inverse @ spread @ inverse / np.outer(size, size))
