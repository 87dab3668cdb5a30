"""Whether a recording holds any line at all: a sensor that hears noise alone cannot call a machine sound."""

from __future__ import annotations

import numpy as np

from reconcile.kinematics.envelopes import squared_envelope, whitened
from reconcile.speed.excess import line_excess, mains_bins, power_over_floor
from signals.checks import Finding, Place
from signals.recording import Recording
from signals.series import FloatArray, Series

CHANCE = 1e-4
"""Of a line that stands out of noise alone somewhere in a spectrum, about."""
SPREAD = 1.4
"""By which bins stand out further than exponential ones: the floor is estimated, and neighbours share a window."""
BAND = (0.01, 0.485)
"""Of the sampling rate: the envelope's."""
ENVELOPE_SHARE = 0.05
"""Of the sampling rate: up to where lines of the envelope are looked for."""
LOWEST_BIN, HIGHEST_BINS = 10, 50
"""Left out: there the floor is that of few neighbours."""


def of_noise(recording: Recording) -> tuple[Finding, ...]:
    """A finding for each channel where none of them holds a line, of the spectrum or of the envelope, that is not one
    of the mains: a sensor that hears the machine beside them says that these are its noise."""
    if any(_has_line(values, recording.sampling_rate_hz) for values in recording.samples):
        return ()
    count = recording.samples.shape[1]
    place = Place(first=0, stop=count, start_s=recording.start_s, stop_s=recording.start_s + recording.duration_s)
    message = "nothing stands out of noise: whether the sensor heard the machine cannot be told, so 'healthy' is empty"
    return tuple(
        Finding(channel=channel.name, kind="noise", message=message, count=1, samples=count, places=(place,))
        for channel in recording.channels
    )


def _has_line(values: FloatArray, rate_hz: float) -> bool:
    series = Series(samples=values, sampling_rate_hz=rate_hz, unit="", name="")
    excess, step_hz = line_excess(series)
    if _stands(excess, step_hz):
        return True
    square, rate, _ = squared_envelope(whitened(values), BAND[0] * rate_hz, BAND[1] * rate_hz, rate_hz)
    centred = (square - np.mean(square)) * np.hanning(square.size)
    power = np.abs(np.fft.rfft(centred)) ** 2
    step_hz = rate / square.size
    return _stands(power_over_floor(power)[: int(ENVELOPE_SHARE * rate_hz / step_hz)], step_hz)


def _stands(excess: FloatArray, step_hz: float) -> bool:
    """Whether any bin away from the mains is higher than the highest of noise."""
    part = slice(LOWEST_BIN, max(LOWEST_BIN, excess.size - HIGHEST_BINS))
    inside = excess[part][~mains_bins(excess.size, step_hz)[part]]
    return bool(inside.size) and float(np.max(inside)) > SPREAD * float(np.log(inside.size / CHANCE))
