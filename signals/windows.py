"""Windows with the two numbers every spectrum needs: coherent gain and noise bandwidth.

Definitions after F. J. Harris, "On the use of windows for harmonic analysis with the discrete Fourier
transform", Proc. IEEE 66 (1978), section IV (coherent gain; equivalent noise bandwidth, eq. 11).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import scipy

from signals.series import FloatArray
from sim.core.errors import UnknownName

MAIN_LOBE_BINS = {"boxcar": 1.0, "hann": 2.0, "hamming": 2.0, "blackman": 3.0, "blackmanharris": 4.0, "flattop": 5.0}
"""Half width of the main lobe to its first zero, in bins of 1/T."""
COSINES = {
    "boxcar": (1.0,),
    "hann": (0.5, 0.5),
    "hamming": (0.54, 0.46),
    "blackman": (0.42, 0.5, 0.08),
    "blackmanharris": (0.35875, 0.48829, 0.14128, 0.01168),
    "flattop": (0.21557895, 0.41663158, 0.277263158, 0.083578947, 0.006947368),
}
"""Coefficients a_k of the windows, sums of a_k cos(2 pi k t / T) t from -T/2 to T/2, as in scipy.signal.windows."""


KEPT, KEPT_SAMPLES = 8, 500_000
"""Windows that a process keeps, and the longest of them: the spectra of a task's channels are of one length."""


@dataclass(frozen=True, kw_only=True)
class Window:
    """A periodic window: `values` shape (n,), dimensionless, read-only."""

    name: str
    values: FloatArray
    coherent_gain: float
    """Mean of the window: what a line's amplitude must be divided by."""
    noise_bandwidth_bins: float
    """Equivalent noise bandwidth, bins of 1/T (1.5 for Hann)."""

    @property
    def main_lobe_bins(self) -> float:
        """Half width of the main lobe, bins."""
        return MAIN_LOBE_BINS[self.name]


def window(name: str, n: int) -> Window:
    """The named window over `n` samples; UnknownName lists the names."""
    if name not in MAIN_LOBE_BINS:
        raise UnknownName("window", name, tuple(MAIN_LOBE_BINS))
    return _kept(name, n) if n <= KEPT_SAMPLES else _made(name, n)


def _made(name: str, n: int) -> Window:
    values = np.asarray(scipy.signal.get_window(name, n, fftbins=True), dtype=np.float64)
    values.flags.writeable = False
    gain = float(np.mean(values))
    return Window(
        name=name,
        values=values,
        coherent_gain=gain,
        noise_bandwidth_bins=float(np.mean(values**2)) / gain**2,
    )


_kept = lru_cache(maxsize=KEPT)(_made)


def transform(name: str, distance_bins: FloatArray) -> FloatArray:
    """Transform of a long window over its value at 0, at distances in bins; real, same shape.

    A window of cosines has the transform a_0 sinc(x) + sum a_k / 2 (sinc(x - k) + sinc(x + k)) (Harris 1978, eq. 29).
    """
    first, *others = COSINES[name]
    total = first * np.sinc(distance_bins)
    for k, a in enumerate(others, start=1):
        total = total + a / 2 * (np.sinc(distance_bins - k) + np.sinc(distance_bins + k))
    return np.asarray(total / first, dtype=np.float64)
