"""One mass on a spring and damper with further laws, run freely on a measured input.

x'' + damping x' + stiffness x + sum of coefficient * law(x, x') = gain * input + offset, per unit of mass; the output
is x (or its derivative) plus `output_offset`. Between samples the input is band-limited.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.signal import firwin, upfirdn

from reconcile.driven.channels import Driven, FloatArray
from reconcile.force_law.kernels import free_run
from reconcile.force_law.library import Law

FINE = 8
"""Steps of the integrator's grid per sample: Runge-Kutta steps of 2 of them, 4 a sample."""
HALF_TAPS = 24
WINDOW_BETA = 9.0
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
    taps = firwin(2 * HALF_TAPS * FINE + 1, 1.0 / FINE, window=("kaiser", WINDOW_BETA)) * FINE
    held = np.concatenate([np.full(HALF_TAPS, samples[0]), samples, np.full(HALF_TAPS, samples[-1])])
    first = 2 * HALF_TAPS * FINE
    return np.ascontiguousarray(upfirdn(taps, held, FINE)[first : first + (samples.size - 1) * FINE + 1])


@dataclass(frozen=True, kw_only=True)
class Run:
    """A stretch made ready: refined input, and where the comparison starts."""

    data: Driven
    fine: FloatArray
    skip: int

    @property
    def compared(self) -> FloatArray:
        """Output that counts, (n - skip,)."""
        return self.data.answer[self.skip :]


def ready(data: Driven, memory_s: float) -> Run:
    """A stretch whose first samples, at most a third of it, are left for the start to be forgotten."""
    skip = min(int(memory_s / data.step_s), data.answer.size // 3)
    return Run(data=data, fine=refined(data.drive), skip=skip)


def simulated(model: Model, run: Run) -> FloatArray:
    """Free run from rest, (n,)."""
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
        out,
    )
    return out + model.output_offset


def answer_to(model: Model, values: FloatArray, step_s: float, order: int) -> FloatArray:
    """Answer of the linear model to a force per unit mass, (n,)."""
    n = values.size
    padded = 2 * n
    omega = 2.0 * np.pi * np.fft.rfftfreq(padded, step_s)
    response = (1j * omega) ** order / (model.stiffness - omega**2 + 1j * omega * model.damping)
    return np.asarray(np.fft.irfft(np.fft.rfft(values, padded) * response, padded)[:n])


def errors(model: Model, run: Run) -> FloatArray:
    """Measured less simulated where it counts, (n - skip,)."""
    return np.asarray(run.compared - simulated(model, run)[run.skip :])


def nrmse(error: FloatArray, measured: FloatArray) -> float:
    """Root mean square error over the standard deviation of what was measured."""
    return float(np.sqrt(np.mean(error**2)) / measured.std())
