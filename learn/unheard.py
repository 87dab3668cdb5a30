"""Whether a recording holds any line at all: a sensor that hears noise alone cannot call a machine sound."""

from __future__ import annotations

from reconcile.kinematics.unheard import line_strength
from signals.checks import Finding, Place
from signals.recording import Recording


def of_noise(recording: Recording) -> tuple[Finding, ...]:
    """A finding for each channel where none of them holds a line, of the spectrum or of the envelope, that is not one
    of the mains: a sensor that hears the machine beside them says that these are its noise."""
    if any(line_strength(values, recording.sampling_rate_hz) >= 1.0 for values in recording.samples):
        return ()
    count = recording.samples.shape[1]
    place = Place(first=0, stop=count, start_s=recording.start_s, stop_s=recording.start_s + recording.duration_s)
    message = "nothing stands out of noise: whether the sensor heard the machine cannot be told, so 'healthy' is empty"
    return tuple(
        Finding(channel=channel.name, kind="noise", message=message, count=1, samples=count, places=(place,))
        for channel in recording.channels
    )
