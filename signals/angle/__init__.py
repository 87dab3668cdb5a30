"""The angle of a shaft: from the pulses of a tacho channel, or from the vibration alone.

`signals.spectra.angle` resamples a series at equal steps of any of them.
"""

from signals.angle.pulses import pulse_times
from signals.angle.tacholess import AngleTrack, tacholess_angle
from signals.angle.tracking import SpeedTrack, track_speed

__all__ = ["AngleTrack", "SpeedTrack", "pulse_times", "tacholess_angle", "track_speed"]
