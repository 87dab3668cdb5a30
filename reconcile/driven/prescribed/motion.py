"""The motion that was prescribed, from a displacement measured with noise: kept is the band in which it stands out."""

from __future__ import annotations

import numpy as np
from scipy import fft

from reconcile.driven.channels import Driven, FloatArray
from reconcile.driven.prescribed.resistance import Motion

OVER_FLOOR = 20.0
"""Power of a line (mean of `SMOOTHING`) over the floor from which the motion stands out of its noise: 9 lines of noise
reach 4 times their mean in one of 1e6 draws."""
SMOOTHING = 9
FLOOR_FROM = 0.5
"""Share of the band above which lines are the floor, by their median: a commanded motion does not reach there."""
MARGIN = 1.5
"""Over the highest line that stands out the band goes on by this factor, and fades out over as much again."""
MEDIAN = 0.69
"""Of lines of noise, over their mean."""


def _mirrored(values: FloatArray) -> FloatArray:
    """Three times as long, continued at both ends as if turned about them, which keeps value and slope."""
    return np.concatenate([2.0 * values[0] - values[:0:-1], values, 2.0 * values[-1] - values[-2::-1]])


def highest_hz(displacement: FloatArray, step_s: float) -> float:
    """Frequency up to which the motion stands out of its noise; infinite where it does all over."""
    n = displacement.size
    power = np.abs(fft.rfft((displacement - displacement.mean()) * np.blackman(n))) ** 2
    power = np.convolve(power, np.ones(SMOOTHING) / SMOOTHING, mode="same")
    floor = float(np.median(power[int(FLOOR_FROM * power.size) :]))
    above = np.nonzero(power > OVER_FLOOR * floor)[0]
    if above.size == 0 or above[-1] > FLOOR_FROM * power.size:
        return float("inf")
    return float(above[-1] / (n * step_s))


def smooth(displacement: FloatArray, step_s: float) -> FloatArray:
    """The displacement (n,) without what is beyond its band."""
    last = MARGIN * highest_hz(displacement, step_s)
    if MARGIN * last > 0.5 / step_s:
        return displacement
    longer = _mirrored(displacement)
    hz = np.fft.rfftfreq(longer.size, step_s)
    fade = 0.5 + 0.5 * np.cos(np.pi * np.clip((hz - last) / ((MARGIN - 1.0) * last), 0.0, 1.0))
    first = displacement.size - 1
    kept = fft.irfft(fft.rfft(longer) * fade, longer.size)
    return np.asarray(kept[first : first + displacement.size])


def motion_of(data: Driven, zero: float) -> Motion:
    """Displacement from `zero`, which is that of all runs: stops stand where they are; its rate by central differences.

    Noise on the displacement is left out where the motion has no part: 10 um of it on a sine of 1 Hz was a velocity of
    7 mm/s, and a plain spring and damper then looked like backlash.
    """
    x = smooth(data.drive - zero, data.step_s)
    return Motion(displacement=x, velocity=np.gradient(x, data.step_s), step_s=data.step_s)
