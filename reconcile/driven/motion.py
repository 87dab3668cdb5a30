"""Displacement and velocity along a recording, whatever derivative of the displacement was measured."""

from __future__ import annotations

import math

import numpy as np
from scipy import fft

from reconcile.driven.channels import FloatArray
from reconcile.driven.model import Model, Run, answer_to, simulated

LOWEST = 0.5
"""Of the natural frequency: below it an error of the output is not integrated, for noise would grow without end."""
EDGE = 0.02
"""Share at either end over which that error fades, so that the transform does not wrap it around."""


def moved(model: Model, run: Run) -> tuple[FloatArray, FloatArray]:
    """Displacement and velocity, (n,) each.

    A measured displacement is taken as it is. Of another output the linear part of the model gives the displacement,
    and what the output is off by is integrated and added.
    """
    data = run.data
    if data.order == 0:
        x = data.answer - model.output_offset
        return x, np.gradient(x, data.step_s)
    linear, n = model.with_laws((), ()), data.answer.size
    x = answer_to(linear, linear.gain * data.drive + linear.offset, data.step_s, 0)
    error = data.answer - simulated(linear, run)
    fade = np.clip(np.minimum(np.arange(n), np.arange(n)[::-1]) / max(EDGE * n, 1.0), 0.0, 1.0)
    omega = 2.0 * np.pi * np.fft.rfftfreq(n, data.step_s)
    high = omega > LOWEST * math.sqrt(max(linear.stiffness, 0.0))
    off = fft.rfft(error * fade) / (1j * np.where(high, omega, 1.0)) ** data.order
    x = x + fft.irfft(np.where(high, off, 0.0), n)
    return np.asarray(x), np.gradient(x, data.step_s)
