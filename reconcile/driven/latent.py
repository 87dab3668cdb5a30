"""The force a linear model lacks, from its error: Wiener deconvolution through the linear model.

error = -H r, so R = -H* E S_r / (|H|^2 S_r + S_n): lines where the error stands above its floor are inverted, others
fade (Wiener 1949). The motion is the measured one, its rate by the same weighting.
"""

from __future__ import annotations

import numpy as np
from scipy import fft

from reconcile.driven.channels import FloatArray
from reconcile.driven.model import Model, Run
from reconcile.driven.motion import LOWEST
from reconcile.force_law.samples import ForceSamples, even_blocks

FLOOR_QUANTILE = 0.1
SMOOTHING = 65
EDGE = 0.02
"""Share at either end that the transform's wrap-around spoils."""
LEAST_BLOCKS, MOST_BLOCKS = 12, 60
MEMORIES_PER_BLOCK = 3.0


def _smooth(power: FloatArray) -> FloatArray:
    padded = np.pad(power, SMOOTHING // 2, mode="edge")
    return np.convolve(padded, np.ones(SMOOTHING) / SMOOTHING, mode="valid")


def latent_force(model: Model, run: Run, error: FloatArray) -> ForceSamples:
    """Force per unit mass as a resistance, with displacement and velocity, away from the ends of the stretch.

    `error`: measured less simulated, (n - skip,). Lines below half of the resonance of a velocity or acceleration
    output cannot be integrated and are left out.
    """
    n, step = error.size, run.data.step_s
    omega = 2.0 * np.pi * np.fft.rfftfreq(n, step)
    order = run.data.order
    turned = (1j * omega) ** order
    response = turned / (model.stiffness - omega**2 + 1j * omega * model.damping)
    taper = np.hanning(max(int(2 * EDGE * n), 4))
    window = np.ones(n)
    half = taper.size // 2
    window[:half], window[-half:] = taper[:half], taper[-half:]
    spectrum = fft.rfft(error * window)
    power = _smooth(np.abs(spectrum) ** 2)
    noise = float(np.quantile(power, FLOOR_QUANTILE))
    size = np.abs(response) ** 2
    low = (omega < LOWEST * np.sqrt(model.stiffness)) & (order > 0)
    strong = (power > 10.0 * noise) & ~low
    level = float(np.max((power[strong] - noise) / np.maximum(size[strong], 1e-300))) if np.any(strong) else noise
    force = fft.irfft(-np.conj(response) * spectrum * level / np.maximum(size * level + noise, 1e-300), n)
    measured = (run.compared - model.output_offset) * window
    answer = fft.rfft(measured)
    kept = _smooth(np.abs(answer) ** 2)
    weight = np.clip(1.0 - noise / np.maximum(kept, 1e-300), 0.0, 1.0)
    if order:
        turned = np.where(low, 1.0, turned)
        weight = np.where(low, 0.0, weight)
    x = answer / turned * weight
    edge = int(2 * EDGE * n)
    inside = slice(edge, n - edge)
    memory = MEMORIES_PER_BLOCK / max(model.damping, 1e-9)
    count = int(np.clip((n - 2 * edge) * step / memory, LEAST_BLOCKS, MOST_BLOCKS))
    return ForceSamples(
        force_n=force[inside],
        displacement_m=fft.irfft(x, n)[inside],
        velocity_m_per_s=fft.irfft(1j * omega * x, n)[inside],
        blocks=even_blocks(n - 2 * edge, count),
        step_s=step,
    )
