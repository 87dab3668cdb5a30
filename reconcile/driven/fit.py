"""Fit a model to a stretch by its free-run error, with block-robust intervals."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import scipy
from scipy.optimize import least_squares
from scipy.special import stdtrit

from reconcile.driven.channels import Driven, FloatArray
from reconcile.driven.model import LINEAR, Model, Run, errors, errors_together
from reconcile.driven.motion import moved
from reconcile.force_law.library import FRICTION, GAPPED, PUSHING, UNANCHORED, Law, mirrored
from reconcile.force_law.samples import even_blocks

BLOCKS = 24
INTERVAL = float(stdtrit(BLOCKS - 1, 0.95))
"""Standard errors of a 90 % interval, their size known from as many blocks."""
GAIN, OFFSET, OUTPUT_OFFSET = 2, 3, 4
"""Indices of the gain, and of the offsets of force and output, among the parameters."""
SPEEDS = 3.0
"""Factor by which the speed at which friction is full may differ from where it starts: it is not seen well."""
LED = 0.1
"""Rate of the observer over the natural angular frequency before the run is free.

It forgets over two periods, in which errors of a motion hardly grow, and follows no noise. On a spring that doubles its
stiffness over the motion the true law was reached from each of 1, 0.3, 0.1 and 0.03 within 0.1 %; by free runs alone
it was missed by 7 % (the nearest minimum), with an interval of 0.04 %.
"""


@dataclass(frozen=True, kw_only=True)
class Doubts:
    """What `reconcile.driven.doubt` found: moves of all parameters, and those to another part with its covariance."""

    moved: tuple[FloatArray, ...] = ()
    apart: tuple[FloatArray, FloatArray] | None = None

    def variance(self, slope: FloatArray, scatter: float) -> float:
        """Of a number with this slope over the parameters, whose scatter is known."""
        found = sum(float(slope @ move) ** 2 for move in self.moved)
        if self.apart is not None:
            move, covariance = self.apart
            found += max(float(slope @ move) ** 2 - scatter - float(slope @ covariance @ slope), 0.0) / 2.0
        return found


@dataclass(frozen=True, kw_only=True)
class Fitted:
    """A fitted model, its covariance (block-robust), and the error left on the stretch."""

    model: Model
    covariance: FloatArray
    error: FloatArray
    doubts: Doubts = Doubts()

    def interval(self, index: int, *, per_gain: bool = False) -> tuple[float, float, float]:
        """Value and 90 % interval of a parameter, or of what it is per unit of gain: times the mass, that is."""
        vector = self.model.vector()
        slope, value = np.eye(vector.size)[index], float(vector[index])
        if per_gain:
            gain = self.model.gain
            value /= gain
            slope = (slope - value * np.eye(vector.size)[GAIN]) / gain
        scatter = max(float(slope @ self.covariance @ slope), 0.0)
        half = INTERVAL * math.sqrt(scatter + self.doubts.variance(slope, scatter))
        return value, value - half, value + half


def first_guess(data: Driven) -> Model:
    """Linear model from the frequency response: 1/H is linear in its parameters (weights: coherent, strong lines)."""
    n = min(4096, data.answer.size // 4)
    rate = 1.0 / data.step_s
    frequency, cross = scipy.signal.csd(data.drive, data.answer, rate, nperseg=n)
    power_in = scipy.signal.welch(data.drive, rate, nperseg=n)[1]
    power_out = scipy.signal.welch(data.answer, rate, nperseg=n)[1]
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


def _scales(model: Model, run: Run, x: FloatArray, v: FloatArray) -> FloatArray:
    """Steps of the parameters that move the output by about its own size; the motion (n,) is `x` with its rate `v`."""
    size, omega = float(x.std()) or 1.0, math.sqrt(abs(model.stiffness)) or 1.0
    force = model.stiffness * size
    laws = [0.1 * force / (float(np.std(law.values(x - x.mean(), v))) or 1.0) for law in model.laws]
    return np.array([0.01 * model.stiffness, 0.01 * omega, 0.1 * abs(model.gain), 0.1 * force, 0.1 * run.spread, *laws])


def _shaped(start: Model) -> list[int]:
    """Laws whose gap, or speed at which friction is full, is fitted with the rest."""
    return [k for k, law in enumerate(start.laws) if law.key in GAPPED or law.key == FRICTION.key]


def _free(start: Model, order: int) -> list[int]:
    """Parameters that data decide. Without a law that knows where zero is, a displacement does not tell the two offsets
    apart, and its derivatives do not tell the force's: left free it wanders by many times the motion."""
    anchored = any(law.key not in UNANCHORED for law in start.laws)
    untold = OUTPUT_OFFSET if order == 0 else OFFSET
    return [i for i in range(start.vector().size) if anchored or i != untold]


def _ends(law: Law, low: float, high: float) -> tuple[float, float]:
    """Of a shape: gaps within the motion, from `low` to `high`; a speed near where it starts."""
    if law.key == FRICTION.key:
        return law.shape / SPEEDS, law.shape * SPEEDS
    if law.key == "stops":
        return 0.0, max(high, -low)
    return (-high, -low) if law.key.endswith("below") else (low, high)


def _bounds(start: Model, x: FloatArray, free: Sequence[int], shaped: Sequence[int]) -> tuple[FloatArray, FloatArray]:
    """Damping and stiffness stay positive, contacts push, shapes keep within their ends along the motion `x`."""
    size = len(free) + len(shaped)
    least, most = np.full(size, -np.inf), np.full(size, np.inf)
    least[:2] = 0.0
    for j, i in enumerate(free):
        if i >= LINEAR and start.laws[i - LINEAR].key in PUSHING:
            least[j] = 0.0
    for j, k in enumerate(shaped, start=len(free)):
        least[j], most[j] = _ends(start.laws[k], float(x.min()), float(x.max()))
    return least, most


def _shape_step(law: Law, size: float) -> float:
    return law.shape if law.key == FRICTION.key else 0.1 * size


def descend(start: Model, runs: Sequence[Run]) -> Fitted:
    """Least squares on the error of one or several stretches, from a start; gaps of laws are free like their sizes."""
    run, first = runs[0], start.vector()
    free, shaped = _free(start, run.data.order), _shaped(start)
    x, v = moved(start, run)
    gap = float(x.std()) or 1.0
    steps = np.concatenate([_scales(start, run, x, v)[free], [_shape_step(start.laws[k], gap) for k in shaped]])

    def model_of(values: FloatArray) -> Model:
        vector, laws = first.copy(), list(start.laws)
        vector[free] = (values * steps)[: len(free)]
        for j, k in enumerate(shaped, start=len(free)):
            laws[k] = replace(laws[k], shape=float(values[j] * steps[j]))
        return replace(start.of(vector), laws=tuple(laws))

    def residual(values: FloatArray) -> FloatArray:
        model = model_of(values)
        return np.concatenate([errors(model, r) for r in runs]) / run.spread

    def together(_: object, points: Iterable[FloatArray]) -> list[FloatArray]:
        models = [model_of(values) for values in points]
        return list(np.concatenate([errors_together(models, r) for r in runs], axis=1) / run.spread)

    least, most = _bounds(start, x[run.skip :], free, shaped)
    begin = np.concatenate([first[free], [start.laws[k].shape for k in shaped]]) / steps
    begin = np.clip(begin, least / steps + 1e-9, most / steps - 1e-9)
    bounds = (least / steps, most / steps)
    columns: Any = together  # of the Jacobian; scipy would have a map of any function
    solution = least_squares(
        residual, begin, bounds=bounds, x_scale="jac", max_nfev=40, xtol=1e-10, ftol=1e-10, workers=columns
    )
    found = model_of(solution.x)
    covariance = np.zeros((first.size, first.size))
    inner = block_covariance(np.asarray(solution.jac), solution.fun) * np.outer(steps, steps)
    covariance[np.ix_(free, free)] = inner[: len(free), : len(free)]
    return Fitted(model=found, covariance=covariance, error=errors(found, run))


def fit(start: Model, run: Run, *, stretches: Sequence[Run] = ()) -> Fitted:
    """Least squares on the free-run error of one or several stretches, from a start.

    With laws the error has many minima: where the motion is sensitive to its numbers, a long run is right at one value
    and lost beside it. So the run is first led by what was measured, then free.
    """
    runs = (run, *stretches)
    if not start.laws or run.data.order > 1:
        return _from_rest(_pushing(descend(start, runs), runs), run.data.order)
    led = descend(start, [replace(r, led=LED) for r in runs])
    return _from_rest(_pushing(descend(led.model, runs), runs), run.data.order)


def total_square(model: Model, runs: Sequence[Run]) -> float:
    """Sum of the squared errors."""
    return sum(float(np.sum(errors(model, r) ** 2)) for r in runs)


def _pushing(found: Fitted, runs: Sequence[Run]) -> Fitted:
    """One-sided springs with negative stiffness written as their twins, which have it positive: the same motion."""
    model = found.model
    for k, law in enumerate(model.laws):
        c, twin = model.coefficients[k], mirrored(law)
        if twin is None or c >= 0.0 or model.stiffness + c <= 0.0 or any(twin.key == x.key for x in model.laws):
            continue
        turn = law.shape if law.key == "contact_above" else -law.shape
        laws = (*model.laws[:k], twin, *model.laws[k + 1 :])
        sizes = (*model.coefficients[:k], -c, *model.coefficients[k + 1 :])
        model = replace(
            model, stiffness=model.stiffness + c, offset=model.offset + c * turn, laws=laws, coefficients=sizes
        )
    return found if model is found.model else descend(model, runs)


def _from_rest(found: Fitted, order: int) -> Fitted:
    """The same motion with gaps counted from where the mass rests, where only a derivative of it was measured: there a
    constant force and a gap of one side go into one another, and the force is taken to be none."""
    model = found.model
    sided = {"above": -1.0, "below": 1.0}
    ways = [sided.get(law.key.rpartition("_")[2], 0.0) if law.key in GAPPED else 0.0 for law in model.laws]
    if order == 0 or not any(ways) or model.stiffness <= 0.0 or any(law.key not in UNANCHORED for law in model.laws):
        return found
    if any(law.key in GAPPED and way == 0.0 for law, way in zip(model.laws, ways, strict=True)):
        return found  # stops on both sides know their middle
    aside = model.offset / model.stiffness
    laws = tuple(
        replace(law, shape=law.shape + way * aside) if way else law for law, way in zip(model.laws, ways, strict=True)
    )
    return replace(found, model=replace(model, offset=0.0, laws=laws))


def best_fit(starts: Sequence[Model], run: Run, *, stretches: Sequence[Run] = ()) -> Fitted:
    """The fit with the least error on all stretches, from several starts."""
    found = [fit(start, run, stretches=stretches) for start in starts]
    return min(found, key=lambda f: total_square(f.model, (run, *stretches)))


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
