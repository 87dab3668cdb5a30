"""The measuring chain: anti-alias filter, transfer path and gain of each sensor, noise with a colour of its own."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.signal import firwin, sosfilt, upfirdn

from proof.machine import FloatArray
from proof.run_up import RATE_HZ

PASS_HZ = 8_600.0
LOWEST_PEAK_HZ, HIGHEST_PEAK_HZ = 250.0, 8_000.0


@dataclass(frozen=True, kw_only=True)
class Path:
    """One sensor: gain and second-order sections (n, 6) from its place to its plug."""

    gain: float
    sections: FloatArray


def random_path(rng: np.random.Generator) -> Path:
    """Three to six resonances or notches of up to 6 dB, damped enough to be smooth, and a gain within about 20 %."""
    n = int(rng.integers(3, 7))
    peaks = np.exp(rng.uniform(math.log(LOWEST_PEAK_HZ), math.log(HIGHEST_PEAK_HZ), n))
    sections = [peak_section(f, rng.uniform(-6.0, 6.0), rng.uniform(0.8, 4.0)) for f in peaks]
    return Path(gain=float(np.exp(0.2 * rng.standard_normal())), sections=np.array(sections))


def peak_section(centre_hz: float, gain_db: float, quality: float) -> FloatArray:
    """Peaking section (bilinear transform of (s^2 + s A/Q + 1)/(s^2 + s/(A Q) + 1), A^2 the gain)."""
    a = 10.0 ** (gain_db / 40.0)
    w = 2.0 * math.pi * centre_hz / RATE_HZ
    alpha = math.sin(w) / (2.0 * quality)
    b = np.array([1.0 + alpha * a, -2.0 * math.cos(w), 1.0 - alpha * a])
    d = np.array([1.0 + alpha / a, -2.0 * math.cos(w), 1.0 - alpha / a])
    found: FloatArray = np.concatenate([b, d]) / d[0]
    return found


def sampled(fine: FloatArray, oversampling: int) -> FloatArray:
    """Signals at `RATE_HZ` behind a linear-phase low-pass, shape (channels, n), from (channels, n * oversampling)."""
    taps = firwin(40 * oversampling + 1, PASS_HZ, fs=RATE_HZ * oversampling)
    n = fine.shape[1] // oversampling
    delay = 20
    rows = [upfirdn(taps, row, 1, oversampling)[delay : delay + n] for row in fine]
    return np.array(rows)


def through(path: Path, signal: FloatArray) -> FloatArray:
    """What comes out of the plug."""
    found: FloatArray = path.gain * sosfilt(path.sections, signal)
    return found


@dataclass(frozen=True, kw_only=True)
class Noise:
    """RMS in m/s^2 and the slope of its power over frequency: power ~ 1 / (1 + (corner / f)^slope)."""

    rms: float
    slope: float
    corner_hz: float
    reddened: bool

    def draw(self, n: int, rng: np.random.Generator) -> FloatArray:
        """n samples."""
        spectrum = np.fft.rfft(rng.standard_normal(n))
        f = np.fft.rfftfreq(n, 1.0 / RATE_HZ)
        f[0] = f[1]
        tilt = (
            (1.0 + (self.corner_hz / f) ** self.slope) if self.reddened else (1.0 + (f / self.corner_hz) ** self.slope)
        )
        weight = np.sqrt(np.minimum(tilt, 30.0))
        weight[0] = 0.0
        shaped = np.fft.irfft(spectrum * weight, n)
        found: FloatArray = shaped * (self.rms / float(np.std(shaped)))
        return found


def random_noise(rms: float, rng: np.random.Generator) -> Noise:
    """A colour: falling from low frequencies, or rising to high ones."""
    return Noise(
        rms=rms,
        slope=float(rng.uniform(0.5, 1.5)),
        corner_hz=float(rng.uniform(300.0, 3_000.0)),
        reddened=bool(rng.random() < 0.7),
    )
