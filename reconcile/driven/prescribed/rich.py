"""Is anything missing? What many signals of the motion together foretell of the force, on a stretch they never saw.

No law: a linear combination of powers, stops, drag, dry friction and paths with memory of many stretches. It says what
a law could reach at most (`left`), and thereby what the noise is at most.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from reconcile.driven.channels import FloatArray
from reconcile.driven.nominate import LEAST_GAIN, leads, squares_in_blocks
from reconcile.driven.prescribed.resistance import Motion, path_force

STRETCHES = (0.01, 0.03, 0.08, 0.2, 0.4, 0.7, 1.0, 1.5)
"""Of the paths with memory, over the amplitude."""
SPEEDS = (0.02, 0.1, 0.3)
"""At which dry friction is developed, over the fastest."""
STOPS = (0.2, 0.4, 0.6, 0.8)
"""Gaps over the amplitude."""
SURE = 0.3
"""Share of the linear error's power that is foretold beyond chance, even if a few blocks go wrong: of spring and damper
under noise it was at most 0.001, of all else at least 0.6."""
RIDGE = 1e-3
"""Size of coefficients that costs as much as an error as large as the spread; columns have spread 1."""
FOLDS = 8
"""Stretches of a run, of which every other one is fitted and the rest foretold, and the other way round."""
DRIFT_SHARE = 0.3
"""Of the power that the signals leave, which a zero that wanders must hold to be told."""


def signals(motion: Motion, size: float, fastest: float) -> FloatArray:
    """Columns (n, k), the first three linear; `size` m and `fastest` m/s scale them alike on every run."""
    x, v = motion.displacement / size, motion.velocity / fastest
    scaled = Motion(displacement=x, velocity=v, step_s=motion.step_s)
    columns = [np.ones(x.size), x, v, x**2, x**3, x**5, x * v, x**2 * v, v * np.abs(v), v**3]
    columns += [np.maximum(s * x - gap, 0.0) for gap in STOPS for s in (1.0, -1.0)]
    columns += [np.clip(v / speed, -1.0, 1.0) for speed in SPEEDS]
    base = {"friction": 1.0, "asymmetry": 0.0}
    columns += [path_force(base | {"elastic": 1.0 / stretch}, scaled) for stretch in STRETCHES]
    return np.column_stack(columns)


@dataclass(frozen=True, kw_only=True)
class Rich:
    """Mean squares of the force's error in blocks of the stretch that was not fitted: linear, and by all signals."""

    linear: FloatArray
    all: FloatArray

    @property
    def gain(self) -> float:
        """Share of the linear error's power that the signals foretell."""
        return 1.0 - float(self.all.mean() / max(float(self.linear.mean()), 1e-300))

    @property
    def foretells(self) -> bool:
        """Whether that is sure, and worth a law."""
        return self.gain > SURE or (leads(self.linear, self.all) and self.gain > LEAST_GAIN)

    @property
    def left(self) -> float:
        """Root mean square that nothing foretells, N."""
        return float(np.sqrt(min(self.all.mean(), self.linear.mean())))


def _solved(columns: FloatArray, force: FloatArray, plain: int) -> FloatArray:
    """Least squares, with a ridge on all but the `plain` first columns."""
    spread = columns.std(axis=0)
    scale = np.where(spread > 1e-12 * np.abs(columns).max(axis=0), spread, 1.0)
    ridge = np.diag(np.where(np.arange(scale.size) < plain, 0.0, RIDGE * np.sqrt(force.size)))
    padded = np.vstack([columns / scale, ridge])
    found = np.linalg.lstsq(padded, np.concatenate([force, np.zeros(scale.size)]), rcond=1e-9)[0]
    return np.asarray(found / scale)


def rich(motion: Motion, force: FloatArray, skip: int, cut: int) -> Rich:
    """Fitted on samples skip to cut, scored from there on."""
    size = float(np.max(np.abs(motion.displacement))) or 1.0
    fastest = float(np.max(np.abs(motion.velocity))) or 1.0
    columns = signals(motion, size, fastest)
    errors = []
    for k in (3, columns.shape[1]):
        solution = _solved(columns[skip:cut, :k], force[skip:cut], 3)
        errors.append(squares_in_blocks(force[cut:] - columns[cut:, :k] @ solution))
    return Rich(linear=errors[0], all=errors[1])


@dataclass(frozen=True, kw_only=True)
class Beside:
    """What the signals foretell of the force that a law leaves, beyond another spring and damper."""

    share: float
    """Of that force's power."""
    size: float
    """Over the spread of the whole force."""


def beside_law(motion: Motion, force: FloatArray, told: FloatArray, skip: int) -> Beside:
    """Of a run and the force that a law tells, each fold by what was fitted to the others.

    The law is held against signals that saw the run itself: what they foretold of other stretches or runs they did
    badly under motions that do not repeat, and a law was then named that left 25 % of the force.
    """
    size = float(np.max(np.abs(motion.displacement))) or 1.0
    fastest = float(np.max(np.abs(motion.velocity))) or 1.0
    columns, left = signals(motion, size, fastest)[skip:], (force - told)[skip:]
    odd = np.arange(left.size) * FOLDS // left.size % 2 == 1
    power = []
    for k in (3, columns.shape[1]):
        rest = left.copy()
        for fold in (odd, ~odd):
            rest[fold] -= columns[fold, :k] @ _solved(columns[~fold, :k], left[~fold], 3)
        power.append(float(np.mean(rest**2)))
    gone = max(power[0] - power[1], 0.0)
    return Beside(share=gone / max(power[0], 1e-300), size=float(np.sqrt(gone)) / (float(force[skip:].std()) or 1.0))


def drift(motion: Motion, force: FloatArray, skip: int) -> FloatArray | None:
    """Course of a zero that wanders, N, (n,), from 0 at its middle; None where it holds less than `DRIFT_SHARE`."""
    size = float(np.max(np.abs(motion.displacement))) or 1.0
    fastest = float(np.max(np.abs(motion.velocity))) or 1.0
    columns = signals(motion, size, fastest)
    t = np.linspace(-1.0, 1.0, force.size)
    course = np.column_stack([t, t**2 - 1.0 / 3.0])
    both = np.column_stack([columns[:, :3], course, columns[:, 3:]])
    without = force - columns @ _solved(columns[skip:], force[skip:], 3)
    solution = _solved(both[skip:], force[skip:], 5)
    left = force - both @ solution
    if np.mean(left[skip:] ** 2) > (1.0 - DRIFT_SHARE) * np.mean(without[skip:] ** 2):
        return None
    return np.asarray(course @ solution[3:5])
