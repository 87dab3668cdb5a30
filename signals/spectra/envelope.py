"""Envelope of a band and its spectrum: where repeated impacts show their rate.

P. D. McFadden and J. D. Smith, "Vibration monitoring of rolling element bearings by the high-frequency
resonance technique - a review", Tribology International 17 (1984) 3-10; the squared form as in
R. B. Randall and J. Antoni, "Rolling element bearing diagnostics - a tutorial", Mech. Syst. Signal Process. 25
(2011) 485-520, section 3.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy import fft

from signals.series import FloatArray, Series
from signals.spectra.amplitude import amplitude_spectrum
from signals.spectra.band import choose_band
from signals.spectra.types import AmplitudeKind, Band, Spectrum
from sim.core.errors import Problem, SpecError

MIN_BAND_BINS = 8


def given_band(low_hz: float, high_hz: float) -> Band:
    """A band the caller asks for."""
    return Band(low_hz=low_hz, high_hz=high_hz, rule="given")


def envelope(series: Series, band: Band) -> FloatArray:
    """Magnitude of the analytic signal of the band, shape (n,), in the unit of the series.

    The band is cut ideally in the frequency domain over the whole series (zero phase); the first and last
    few 1/bandwidth seconds feel the wrap-around of the transform.
    """
    n = series.samples.size
    nyquist, df = series.sampling_rate_hz / 2, series.sampling_rate_hz / n
    inside = 0 <= band.low_hz < band.high_hz <= nyquist * (1 + 1e-9)
    if not (inside and (band.high_hz - band.low_hz) / df >= MIN_BAND_BINS):
        raise SpecError(
            Problem(
                field="band_hz",
                message="is not a band of this signal",
                given=(band.low_hz, band.high_hz),
                allowed=f"0 <= low < high <= {nyquist:g}, at least {MIN_BAND_BINS * df:.3g} wide",
                unit="Hz",
            )
        )
    transform = fft.rfft(series.samples - np.mean(series.samples))
    first, last = int(np.ceil(band.low_hz / df)), min(int(np.floor(band.high_hz / df)), (n - 1) // 2)
    analytic = np.zeros(n, dtype=np.complex128)
    analytic[first : last + 1] = 2 * transform[first : last + 1]
    return np.asarray(np.abs(fft.ifft(analytic)), dtype=np.float64)


def envelope_spectrum(
    series: Series,
    *,
    band: Band | tuple[float, float] | None = None,
    min_bandwidth_hz: float | None = None,
    squared: bool = False,
    window_name: str = "hann",
    amplitude: AmplitudeKind = "peak",
    resolution_hz: float | None = None,
) -> Spectrum:
    """Amplitude spectrum of the (squared) envelope of a band, from 0 to the width of the band.

    `band`: the edges in Hz, a `Band`, or None to let `choose_band` decide; the result carries the band used.
    """
    if band is None:
        chosen = choose_band(series, min_bandwidth_hz=min_bandwidth_hz)
    else:
        chosen = band if isinstance(band, Band) else given_band(*band)
    values = envelope(series, chosen)
    if squared:
        values = values**2
    unit = f"({series.unit})^2" if squared else series.unit
    demodulated = replace(series, samples=values, unit=unit)
    spectrum = amplitude_spectrum(
        demodulated, window_name=window_name, amplitude=amplitude, resolution_hz=resolution_hz
    )
    # A band of width B has no beats above B.
    keep = spectrum.frequency_hz <= chosen.high_hz - chosen.low_hz
    return replace(
        spectrum,
        kind="squared_envelope" if squared else "envelope",
        frequency_hz=spectrum.frequency_hz[keep],
        values=spectrum.values[keep],
        band=chosen,
    )
