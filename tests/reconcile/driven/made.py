"""Recordings of made-up oscillators under a measured force, by SciPy's integrator (not the engine's own)."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from scipy.integrate import ode
from scipy.signal import cont2discrete, lfilter

from reconcile.driven.model import FINE, refined
from signals.recording import Recording
from sim.core.response import Channel

RATE = 500.0
MASS, FREQUENCY, DAMPING = 2.0, 40.0, 0.05
STIFFNESS = MASS * (2 * math.pi * FREQUENCY) ** 2


def multisine(rng: np.random.Generator, n: int, size: float, highest: float = 120.0) -> np.ndarray:
    """Random phases up to `highest` Hz, RMS `size`, fading in over the first samples."""
    frequency = np.fft.rfftfreq(n, 1 / RATE)
    spectrum = np.where(
        (frequency > 1) & (frequency < highest), np.exp(2j * math.pi * rng.uniform(size=frequency.size)), 0
    )
    u = np.fft.irfft(spectrum, n)
    return np.asarray(size * u / u.std() * np.clip(np.arange(n) / 50, 0, 1))


def recording(
    extra: Callable[[float, float], float] | None, *, seed: int, n: int = 3900, size: float = 1.0, noise: float = 0.01
) -> Recording:
    """Force N and displacement m of mass x'' + c x' + k x + extra(x, v) = u, with coloured noise on the displacement.

    The force's size makes the displacement about 1 mm at `size` 1.
    """
    rng = np.random.default_rng(seed)
    w = 2 * math.pi * FREQUENCY
    u = multisine(rng, n, size * MASS * w * w * 4e-4)
    fine = refined(u)
    step = 1 / RATE / FINE

    forces, end = fine.tolist(), fine.size - 1.001

    def slope(t: float, s: np.ndarray) -> list[float]:
        at = min(t / step, end)
        k = int(at)
        force = forces[k] + (at - k) * (forces[k + 1] - forces[k])
        x, v = s.tolist()
        assert extra is not None
        return [v, force / MASS - 2 * DAMPING * w * v - w * w * x - extra(x, v) / MASS]

    t = np.arange(n) / RATE
    if extra is None:
        rows, poles, _ = cont2discrete(([1 / MASS], [1.0, 2 * DAMPING * w, w * w]), step, method="foh")
        x = lfilter(rows[0], poles, fine)[::FINE]
    else:
        run = ode(slope).set_integrator("dopri5", rtol=1e-6, atol=1e-9, first_step=2 * step, max_step=2 * step)
        run.set_initial_value([0.0, 0.0], 0.0)
        x = np.array([0.0, *(run.integrate(at)[0] for at in t[1:])])
    dirt = np.convolve(rng.normal(size=n + 4), [0.4, 0.3, 0.2, 0.1, 0.1], mode="valid")
    x = x + noise * x.std() * dirt / dirt.std()
    channels = (
        Channel(name="force", quantity="force", unit="N", location="mass", axis="y"),
        Channel(name="displacement", quantity="displacement", unit="m", location="mass", axis="y"),
    )
    return Recording(sampling_rate_hz=RATE, channels=channels, samples=np.vstack([u, x]))


def hysteretic(*, seed: int, share: float = 0.4, n: int = 9000, noise: float = 0.002) -> Recording:
    """Bouc-Wen hysteresis that carries `share` of the stiffness (Y.-K. Wen, J. Eng. Mech. Div. ASCE 102 (1976) 249-263,
    exponent 1), yielding at 0.3 mm: no law of displacement and rate. White noise on the displacement."""
    linear = recording(None, seed=seed, n=n, noise=0.0)
    u = linear.samples[0]
    forces = u.tolist()
    w, inner, yields = 2 * math.pi * FREQUENCY, 8, 3e-4
    stiffness, h = MASS * w * w, 1 / RATE / inner
    x = v = z = 0.0
    out = np.empty(n)
    for i in range(n):
        out[i] = x
        last, following = forces[i], forces[min(i + 1, n - 1)]
        for j in range(inner):
            force = last + (following - last) * j / inner
            carried = stiffness * ((1 - share) * x + share * z)
            v += h * (force - 2 * DAMPING * w * MASS * v - carried) / MASS
            x += h * v
            z += h * (v - 0.5 * (abs(v) * z + v * abs(z)) / yields)
    out += noise * out.std() * np.random.default_rng(seed).normal(size=n)
    return replace(linear, samples=np.vstack([u, out]))
