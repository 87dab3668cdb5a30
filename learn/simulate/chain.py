"""A chain for one channel of a gear case: the ranges of `sideband_datasets.recipe.chains`, drawn for each hearing."""

from __future__ import annotations

import math

import numpy as np

from learn.simulate.background import log_uniform
from sideband_datasets.recipe.chains import CHANNEL, LOWEST_MODE_HZ
from signals.recording import Recording
from signals.sensors.motion import Motion
from signals.sensors.spec import SensorChain
from signals.series import FloatArray
from sim.core.response import Channel

RMS_RANGE_V = 12.0
"""Range of the converter over the RMS of the signal, so that impacts fit."""


def _path(rng: np.random.Generator, top_hz: float) -> dict[str, object]:
    modes = [
        {
            "frequency_hz": log_uniform(rng, LOWEST_MODE_HZ, top_hz),
            "damping_ratio": log_uniform(rng, 0.008, 0.08),
            "gain": float(rng.choice([-1.0, 1.0])) * log_uniform(rng, 0.01, 0.5),
        }
        for _ in range(int(rng.integers(2, 8)))
    ]
    return {"kind": "modes", "direct": log_uniform(rng, 0.03, 1.0), "modes": modes}


def drawn_chain(rng: np.random.Generator, rms: float, rate_hz: float) -> SensorChain:
    """A chain for motion of about that RMS (m/s^2), recorded at `rate_hz`."""
    top = 0.42 * rate_hz
    noise_rms = rms * log_uniform(rng, 0.01, 20.0)
    full = RMS_RANGE_V * (rms + noise_rms) * 8.0
    direction = math.radians(rng.uniform(30.0, 150.0))
    channel = {
        "kind": "accelerometer",
        "name": CHANNEL,
        "place": {
            "mix": [
                {"channel": "ring.x.acceleration", "factor": math.cos(direction)},
                {"channel": "ring.y.acceleration", "factor": math.sin(direction)},
            ]
        },
        "path": _path(rng, top),
        "mounting": {"frequency_hz": log_uniform(rng, 4e3, 30e3), "damping_ratio": log_uniform(rng, 0.03, 0.15)},
        "noise": {
            "density_per_sqrt_hz": noise_rms / math.sqrt(rate_hz / 2),
            "corner_hz": log_uniform(rng, 1.0, 3e3),
            "exponent": float(rng.uniform(0.5, 1.5)),
        },
        "hum": {
            "mains_hz": float(rng.choice([50.0, 60.0])),
            "amplitude": rms * log_uniform(rng, 1e-3, 1.0),
            "harmonics": [1.0, float(rng.uniform(0, 1)), float(rng.uniform(0, 1)), float(rng.uniform(0, 0.5))],
        },
        "anti_alias": {"cutoff_hz": float(rng.uniform(0.35, 0.45)) * rate_hz, "order": int(rng.integers(4, 9))},
        "converter": {"bits": int(rng.choice([12, 16, 24])), "range_v": full},
    }
    return SensorChain.model_validate(
        {"clock": {"sampling_rate_hz": rate_hz}, "seed": int(rng.integers(2**31)), "channels": [channel]}
    )


def motion_of_ring(samples: FloatArray, rate_hz: float) -> Motion:
    """Accelerations (2, n) of a ring in x and y, as a measurement chain takes them."""
    channels = tuple(
        Channel(name=f"ring.{axis}.acceleration", quantity="acceleration", unit="m/s^2", location="ring", axis=axis)
        for axis in ("x", "y")
    )
    return Motion(recording=Recording(sampling_rate_hz=rate_hz, channels=channels, samples=samples, origin="simulated"))
