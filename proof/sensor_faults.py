"""What goes wrong between accelerometer and file: each fault changes one channel of the test recordings (swap: two)."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from scipy.signal import sosfilt

from proof.chain import Path, peak_section
from proof.machine import FloatArray
from proof.run_up import RATE_HZ

ALIASED_ORDER = 560
"""Above half the sampling rate from 18 Hz on."""


@dataclass(frozen=True, kw_only=True)
class Place:
    """Where a fault acts: channel, another one, and the shaft's angle at every sample, rad."""

    channel: int
    other: int
    phi: FloatArray


Fault = Callable[[FloatArray, Place, np.random.Generator], None]


def _clipping(x: FloatArray, at: Place, _rng: np.random.Generator) -> None:
    row = x[at.channel]
    limit = float(np.quantile(np.abs(row), 0.9))
    np.clip(row, -limit, limit, out=row)


def _dropouts(x: FloatArray, at: Place, rng: np.random.Generator) -> None:
    n = x.shape[1]
    for start in rng.integers(0, n - 400, 9):
        x[at.channel, start : start + int(rng.integers(60, 400))] = 0.0


def _hum(x: FloatArray, at: Place, rng: np.random.Generator) -> None:
    t = np.arange(x.shape[1]) / RATE_HZ
    size = 0.8 * float(np.std(x[at.channel]))
    for k, share in ((1, 1.0), (2, 0.25), (3, 0.5), (5, 0.2)):
        x[at.channel] += size * share * np.sin(2.0 * math.pi * 50.0 * k * t + rng.uniform(0.0, 6.0))


def _loose_sensor(x: FloatArray, at: Place, rng: np.random.Generator) -> None:
    centre = rng.uniform(2500.0, 5000.0)
    x[at.channel] = sosfilt(
        Path(gain=1.0, sections=np.array([peak_section(centre, 22.0, 9.0)])).sections, x[at.channel]
    )


def _stuck(x: FloatArray, at: Place, _rng: np.random.Generator) -> None:
    x[at.channel] = float(x[at.channel, 0])


def _swapped(x: FloatArray, at: Place, _rng: np.random.Generator) -> None:
    x[[at.channel, at.other]] = x[[at.other, at.channel]]


def _gain(x: FloatArray, at: Place, rng: np.random.Generator) -> None:
    x[at.channel] *= 0.5 if rng.random() < 0.5 else 2.0


def _aliasing(x: FloatArray, at: Place, _rng: np.random.Generator) -> None:
    # a line above half the sampling rate that no filter removed: its image falls as the speed rises
    x[at.channel] += 1.2 * float(np.std(x[at.channel])) * np.sin(ALIASED_ORDER * at.phi + 1.0)


FAULTS: Mapping[str, Fault] = {
    "clipping": _clipping,
    "dropouts": _dropouts,
    "mains_hum": _hum,
    "loose_sensor": _loose_sensor,
    "stuck": _stuck,
    "swapped": _swapped,
    "gain_change": _gain,
    "aliasing": _aliasing,
}


def spoil(samples: FloatArray, fault: str, place: Place, rng: np.random.Generator) -> None:
    """Change the samples (channels, n) in place."""
    FAULTS[fault](samples, place, rng)
