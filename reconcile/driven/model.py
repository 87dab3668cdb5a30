"""One mass on a spring and damper with further laws, run freely on a measured input.

x'' + damping x' + stiffness x + sum of coefficient * law(x, x') = gain * input + offset, per unit of mass; the output
is x (or its derivative) plus `output_offset`. Between samples the input is band-limited.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy
from scipy import fft

from reconcile.driven.channels import Driven, FloatArray
from reconcile.force_law.kernels import ALONE, free_run, free_runs
from reconcile.force_law.library import Law
from sim.core.lanes import WIDTH

FINE = 8
"""Steps of the integrator's grid per sample: Runge-Kutta steps of 2 of them, 4 a sample."""
HALF_TAPS = 24
WINDOW_BETA = 9.0
WARM_UP = 0.3
"""Share of the natural angular frequency at which the state is led to the measured output before the comparison.

A stiffening mass has several answers to one input (Nayfeh & Mook 1979, Nonlinear Oscillations, section 4.1); a run from
rest into the middle of a record may take another one for ever. Luenberger's observer: poles below the frequency itself
average noise over periods, and settle within few of them.
"""
RUNAWAY = 1e3
"""Standard deviations of the measured output at which a run has flown off; errors count no higher."""
LINEAR = 5
"""Parameters of the linear model: stiffness, damping, gain, offset of force and of output."""


@dataclass(frozen=True, kw_only=True)
class Model:
    """See the module; per unit mass, in units of the channels and seconds."""

    stiffness: float
    damping: float
    gain: float
    offset: float = 0.0
    output_offset: float = 0.0
    laws: tuple[Law, ...] = ()
    coefficients: tuple[float, ...] = ()

    def vector(self) -> FloatArray:
        """All parameters, (5 + laws,)."""
        return np.array([self.stiffness, self.damping, self.gain, self.offset, self.output_offset, *self.coefficients])

    def of(self, vector: FloatArray) -> Model:
        """The same structure with other parameters."""
        linear = [float(x) for x in vector[:LINEAR]]
        return replace(
            self,
            stiffness=linear[0],
            damping=linear[1],
            gain=linear[2],
            offset=linear[3],
            output_offset=linear[4],
            coefficients=tuple(float(x) for x in vector[LINEAR:]),
        )

    def with_laws(self, laws: Sequence[Law], coefficients: Sequence[float]) -> Model:
        """The same linear part with these laws."""
        return replace(self, laws=tuple(laws), coefficients=tuple(coefficients))

    @property
    def memory_s(self) -> float:
        """Time in which a start is forgotten to 0.1 %."""
        return 14.0 / max(self.damping, 1e-9)


def refined(samples: FloatArray) -> FloatArray:
    """Band-limited interpolation of (n,) to (n - 1) * FINE + 1 values: a sinc under a Kaiser window."""
    taps = scipy.signal.firwin(2 * HALF_TAPS * FINE + 1, 1.0 / FINE, window=("kaiser", WINDOW_BETA)) * FINE
    held = np.concatenate([np.full(HALF_TAPS, samples[0]), samples, np.full(HALF_TAPS, samples[-1])])
    first = 2 * HALF_TAPS * FINE
    return np.ascontiguousarray(scipy.signal.upfirdn(taps, held, FINE)[first : first + (samples.size - 1) * FINE + 1])


@dataclass(frozen=True, kw_only=True)
class Run:
    """A stretch made ready: refined input, and where the comparison starts."""

    data: Driven
    fine: FloatArray
    skip: int
    led: float = 0.0
    """Share of the natural angular frequency at which the whole run is led to what was measured; 0: a free run."""
    kept: FloatArray | None = None
    """(n - skip,): 0 where a channel was spoiled and errors do not count, else 1; None: all of them count."""

    @cached_property
    def spread(self) -> float:
        """Standard deviation of the output; 1 where it stands still."""
        return float(self.data.answer.std()) or 1.0

    @property
    def compared(self) -> FloatArray:
        """Output that counts, (n - skip,)."""
        return self.data.answer[self.skip :]


def held_linear(run: Run) -> Run:
    """The same stretch with straight lines between the samples of the input."""
    n = run.data.drive.size
    at = np.arange((n - 1) * FINE + 1) / FINE
    return replace(run, fine=np.interp(at, np.arange(n), run.data.drive))


def ready(data: Driven, memory_s: float) -> Run:
    """A stretch whose first samples, at most a third of it, are left for the start to be forgotten."""
    skip = min(int(memory_s / data.step_s), data.answer.size // 3)
    return Run(data=data, fine=refined(data.drive), skip=skip, kept=_kept(data, skip))


def _kept(data: Driven, skip: int) -> FloatArray | None:
    """Where errors count: not where the output was spoiled, nor, for the memory, after the input was, or after an
    output that should have led the run."""
    if data.bad_drive is None and data.bad_answer is None:
        return None
    none = np.zeros(data.answer.size, dtype=np.bool_)
    drive = none if data.bad_drive is None else data.bad_drive
    answer = none if data.bad_answer is None else data.bad_answer
    start = drive | (answer & (np.arange(answer.size) < skip))
    since = np.cumsum(start.astype(np.int64))
    before = np.concatenate([np.zeros(min(skip + 1, since.size), dtype=np.int64), since[: -(skip + 1)]])
    return np.where((since > before) | answer, 0.0, 1.0)[skip:]


def _pull(model: Model, run: Run) -> FloatArray:
    """Corrections of x and v a sample: both poles of the observer's error at its rate, where x was measured."""
    rate = (run.led or WARM_UP) * math.sqrt(max(model.stiffness, 0.0))
    held = math.exp(-rate * run.data.step_s)
    if run.data.order == 0:
        return np.array([1.0 - held**2, (1.0 - held) ** 2 / run.data.step_s])
    return np.array([0.0, 1.0 - held if run.data.order == 1 else 0.0])


def simulated(model: Model, run: Run) -> FloatArray:
    """Free run, (n,); over the samples before `skip` (everywhere, if the run is led) an observer of the output."""
    out = np.empty(run.data.answer.size)
    free_run(
        model.gain * run.fine + model.offset,
        FINE,
        run.data.step_s / FINE,
        np.zeros(2),
        model.stiffness,
        model.damping,
        np.array([law.code for law in model.laws], dtype=np.int64),
        np.array([law.shape for law in model.laws], dtype=np.float64),
        np.array(model.coefficients, dtype=np.float64),
        run.data.order,
        run.data.answer - model.output_offset,
        _pull(model, run),
        run.data.answer.size if run.led else run.skip,
        out,
    )
    return out + model.output_offset


def simulated_together(models: Sequence[Model], run: Run) -> FloatArray:
    """Free runs of models with the same kinds of laws, (models, n): as `simulated`, but for rounding, eight at once."""
    first = models[0]
    if len(models) == 1 or any(law.code in ALONE for law in first.laws):
        return np.stack([simulated(model, run) for model in models])
    codes = np.array([law.code for law in first.laws], dtype=np.int64)
    n = run.data.answer.size
    found = np.empty((len(models), n))
    for at in range(0, len(models), WIDTH):
        part = [*models[at : at + WIDTH]]
        count = len(part)
        part += [part[-1]] * (WIDTH - count)
        out = np.empty((n, WIDTH))
        free_runs(
            run.fine,
            FINE,
            run.data.step_s / FINE,
            np.stack([model.vector()[:LINEAR] for model in part], axis=1),
            codes,
            np.array([[law.shape for law in model.laws] for model in part], dtype=np.float64).T.copy(),
            np.array([model.coefficients for model in part], dtype=np.float64).T.copy(),
            run.data.order,
            run.data.answer,
            np.stack([_pull(model, run) for model in part], axis=1),
            n if run.led else run.skip,
            out,
        )
        found[at : at + count] = out.T[:count]
    return found


def answer_to(model: Model, values: FloatArray, step_s: float, order: int) -> FloatArray:
    """Answer of the linear model to a force per unit mass, (n,)."""
    n = values.size
    padded = 2 * n
    omega = 2.0 * np.pi * np.fft.rfftfreq(padded, step_s)
    response = (1j * omega) ** order / (model.stiffness - omega**2 + 1j * omega * model.damping)
    return np.asarray(fft.irfft(fft.rfft(values, padded) * response, padded)[:n])


def bounded(values: FloatArray, run: Run) -> FloatArray:
    """Values with those that flew off held at `RUNAWAY`."""
    limit = RUNAWAY * run.spread
    if np.all(np.abs(values) <= limit):
        return values
    return np.asarray(np.clip(np.nan_to_num(values, nan=limit), -limit, limit))


def errors(model: Model, run: Run) -> FloatArray:
    """Measured less simulated where it counts, (n - skip,), bounded; 0 where a channel was spoiled."""
    return counted(bounded(run.compared - simulated(model, run)[run.skip :], run), run)


def errors_together(models: Sequence[Model], run: Run) -> FloatArray:
    """As `errors`, of models with the same kinds of laws, (models, n - skip)."""
    return counted(bounded(run.compared - simulated_together(models, run)[:, run.skip :], run), run)


def counted(error: FloatArray, run: Run) -> FloatArray:
    """An error (n - skip,) with 0 where a channel was spoiled."""
    return error if run.kept is None else error * run.kept


def diverges(model: Model, run: Run) -> bool:
    """Whether the free run flies off."""
    return bool(np.abs(errors(model, run)).max() >= RUNAWAY * float(run.data.answer.std()))


def share_kept(run: Run) -> float:
    """Share of the compared samples that count."""
    return 1.0 if run.kept is None else float(np.mean(run.kept))


def nrmse(error: FloatArray, measured: FloatArray) -> float:
    """Root mean square error over the standard deviation of what was measured."""
    return float(np.sqrt(np.mean(error**2)) / measured.std())
