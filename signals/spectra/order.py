"""Order spectrum: lines that keep their place when the speed changes."""

from __future__ import annotations

import numpy as np

from signals.recording import Tacho
from signals.series import FloatArray, Series
from signals.spectra.amplitude import amplitude_spectrum
from signals.spectra.angle import constant_speed_angle, resample_in_angle, tacho_angle
from signals.spectra.types import AmplitudeKind, OrderSpectrum
from sim.core.errors import Problem, SpecError


def order_spectrum(
    series: Series,
    *,
    shaft: str,
    rotation: float | Tacho | FloatArray,
    window_name: str = "hann",
    amplitude: AmplitudeKind = "peak",
) -> OrderSpectrum:
    """Amplitudes over orders (cycles per revolution) of `shaft`.

    `rotation`: constant speed (revolutions per second, Hz), a tacho, or the shaft angle at each sample
    (shape (n,), rad, NaN where unknown).
    The step in angle is chosen at the slowest speed so that nothing aliases; orders are reported up to
    the one that reaches Nyquist in time at the fastest speed. Whole revolutions only.
    """
    angle_rad = shaft_angle(series, rotation)
    speed_hz = _speed_hz(series, angle_rad)
    per_revolution = max(4, int(np.ceil(series.sampling_rate_hz / float(np.min(speed_hz)) * (1 - 1e-9))))
    samples = resample_in_angle(series, angle_rad, per_revolution)
    # A "second" of this series is one revolution, so its frequencies are orders.
    turned = Series(samples=samples, sampling_rate_hz=float(per_revolution), unit=series.unit, name=series.name)
    spectrum = amplitude_spectrum(turned, window_name=window_name, amplitude=amplitude)
    keep = spectrum.frequency_hz <= series.sampling_rate_hz / (2 * float(np.max(speed_hz))) * (1 + 1e-9)
    return OrderSpectrum(
        order=spectrum.frequency_hz[keep],
        values=spectrum.values[keep],
        unit=series.unit,
        scaling=amplitude,
        window=window_name,
        resolution_order=spectrum.resolution_hz,
        noise_bandwidth_order=spectrum.noise_bandwidth_hz,
        shaft=shaft,
        mean_speed_hz=float(np.mean(speed_hz)),
        samples_per_revolution=per_revolution,
        revolutions=samples.size / per_revolution,
        channel=series.name,
    )


def _speed_hz(series: Series, angle_rad: FloatArray) -> FloatArray:
    """Speed between the samples where the angle is known, Hz; a shaft that stands or turns back has no orders."""
    speed = np.diff(angle_rad[np.isfinite(angle_rad)]) * (series.sampling_rate_hz / (2 * np.pi))
    if not speed.size or float(np.min(speed)) <= 0:
        slowest = float(np.min(speed)) if speed.size else None
        message = "the shaft must turn forwards all the time"
        raise SpecError(Problem(field="rotation", message=message, given=slowest, allowed="above 0", unit="Hz"))
    return np.asarray(speed, dtype=np.float64)


def shaft_angle(series: Series, rotation: float | Tacho | FloatArray) -> FloatArray:
    """Angle at each sample (n,), rad: of a constant speed (Hz), a tacho, or as given."""
    if isinstance(rotation, Tacho):
        return tacho_angle(series, rotation)
    if isinstance(rotation, np.ndarray):
        return np.asarray(rotation, dtype=np.float64)
    return constant_speed_angle(series, rotation)
