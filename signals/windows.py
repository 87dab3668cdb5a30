"""Windows with the two numbers every spectrum needs: coherent gain and noise bandwidth.

Definitions after F. J. Harris, "On the use of windows for harmonic analysis with the discrete Fourier
transform", Proc. IEEE 66 (1978), section IV (coherent gain; equivalent noise bandwidth, eq. 11).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.signal import get_window

from signals.series import FloatArray
from sim.core.errors import UnknownName

MAIN_LOBE_BINS = {"boxcar": 1.0, "hann": 2.0, "hamming": 2.0, "blackman": 3.0, "blackmanharris": 4.0, "flattop": 5.0}
"""Half width of the main lobe to its first zero, in bins of 1/T."""


@dataclass(frozen=True, kw_only=True)
class Window:
    """A periodic window: `values` shape (n,), dimensionless."""

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
    values = np.asarray(get_window(name, n, fftbins=True), dtype=np.float64)
    gain = float(np.mean(values))
    return Window(
        name=name,
        values=values,
        coherent_gain=gain,
        noise_bandwidth_bins=float(np.mean(values**2)) / gain**2,
    )
