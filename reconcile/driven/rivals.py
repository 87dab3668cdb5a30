"""Rivals of a named law: a black box with as many parameters, and placebos."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations_with_replacement

import numpy as np

from reconcile.driven.channels import Driven, FloatArray
from reconcile.driven.fit import fit
from reconcile.driven.model import Model, Run, answer_to, counted, errors
from reconcile.driven.motion import moved
from reconcile.force_law.library import CUBIC_DRAG, DRAG, Law
from reconcile.force_law.samples import IntArray
from sim.core.compiled import jit

LAGS = 2
VARIABLES = 2 * LAGS + 1
"""y[k-1], y[k-2], u[k], u[k-1], u[k-2]."""


@dataclass(frozen=True, kw_only=True)
class BlackBox:
    """Polynomial NARX: y[k] = sum of coefficient * product of variables; (terms, 3) indices, VARIABLES is the 1."""

    products: IntArray
    coefficients: FloatArray
    scale: tuple[float, float]


def _variables(data: Driven, scale: tuple[float, float]) -> FloatArray:
    y, u = data.answer / scale[1], data.drive / scale[0]
    rows = [y[1:-1], y[:-2], u[2:], u[1:-1], u[:-2], np.ones(y.size - 2)]
    return np.column_stack(rows)


def black_box(data: Driven, parameters: int) -> BlackBox:
    """Forward selection of `parameters` products up to degree 3 by orthogonal least squares on the next sample.

    Chen, Billings & Luo 1989, Int. J. Control 50, 1873-1896 (error reduction ratio).
    """
    scale = (float(data.drive.std()) or 1.0, float(data.answer.std()) or 1.0)
    variables = _variables(data, scale)
    products = np.array(list(combinations_with_replacement(range(VARIABLES + 1), 3)), dtype=np.int64)
    columns = np.prod(variables[:, products], axis=2)
    target = data.answer[2:] / scale[1]
    rest, free, kept = target.copy(), columns.copy(), list[int]()
    for _ in range(parameters):
        size = np.sum(free**2, axis=0)
        merit = np.where(size > 1e-9 * np.sum(columns**2, axis=0), (free.T @ rest) ** 2 / np.maximum(size, 1e-300), 0.0)
        merit[kept] = -1.0
        best = int(np.argmax(merit))
        kept.append(best)
        unit = free[:, best] / np.sqrt(max(size[best], 1e-300))
        rest = rest - unit * (unit @ rest)
        free = free - np.outer(unit, unit @ free)
    solution = np.linalg.lstsq(columns[:, kept], target, rcond=None)[0]
    return BlackBox(products=products[kept], coefficients=np.asarray(solution), scale=scale)


@jit
def _run_box(products, coefficients, u, first, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN202
    state = [0.0, 0.0, 0.0, 0.0, 0.0, 1.0]
    for k in range(first, u.size):
        state[0], state[1] = out[k - 1], out[k - 2]
        state[2], state[3], state[4] = u[k], u[k - 1], u[k - 2]
        total = 0.0
        for j in range(coefficients.size):
            total += coefficients[j] * state[products[j, 0]] * state[products[j, 1]] * state[products[j, 2]]
        out[k] = min(max(total, -1e3), 1e3)


def black_box_error(box: BlackBox, run: Run) -> FloatArray:
    """Free-run error where it counts, (n - skip,), from the measured start; limited where the box runs away."""
    out, first = np.zeros(run.data.answer.size), max(run.skip, LAGS)
    out[:first] = run.data.answer[:first] / box.scale[1]
    _run_box(box.products, box.coefficients, run.data.drive / box.scale[0], first, out)
    return counted(np.asarray(run.compared - box.scale[1] * out[run.skip :]), run)


def placebo_errors(
    linear: Model, laws: Sequence[Law], run: Run, other: Run, rng: np.random.Generator
) -> tuple[FloatArray, FloatArray]:
    """Errors on `other` of a wrong law at the right place, and of the laws' force shifted in time at random.

    The wrong law is quadratic damping, fitted as the right one was (cubic damping where drag is the right one). The
    shifted force enters as an input whose size is fitted on the first half of `other`: more than a fit would be given.
    """
    wrong = CUBIC_DRAG if any(law.key == DRAG.key for law in laws) else DRAG
    fitted = fit(linear.with_laws((wrong,), (0.0,)), run)
    x, v = moved(linear, other)
    base = errors(linear, other)
    force = np.sum([law.values(x, v) / (float(np.std(law.values(x, v))) or 1.0) for law in laws], axis=0)
    shifted = np.roll(force, int(rng.integers(x.size // 4, 3 * x.size // 4)))
    answer = answer_to(linear, shifted, other.data.step_s, other.data.order)[other.skip :]
    half = answer.size // 2
    size = float(answer[:half] @ base[:half]) / max(float(answer[:half] @ answer[:half]), 1e-300)
    return errors(fitted.model, other), counted(np.asarray(base - size * answer), other)
