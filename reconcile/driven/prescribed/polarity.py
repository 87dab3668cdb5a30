"""Whether the force of a prescribed motion has its sign: what resists takes power from the motion on the average.

That holds of springs, masses, dampers and friction alike. The sign of the fitted spring is no such rule: what a mass
takes of its own is against the displacement, so that k - m omega^2 may have either sign, and a damper alone has none.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy import fft

from reconcile.driven.channels import Driven, FloatArray
from reconcile.driven.prescribed.fitting import Resisting, in_standard_errors
from reconcile.driven.prescribed.resistance import Motion
from reconcile.verdict import SensorFault

STRETCHES, LEAST_ERRORS = 10, 5.0
"""Stretches by which the power's error is told, and how many such errors are clear."""
LEAST_POWER = 0.05
"""Mean of force times velocity, over both their standard deviations, from which it has a sign. Springs moved at 0.3 to
30 Hz, with 1 and 10 % of noise, had 0.002 at most; one with a damper of a tenth of its force 0.12, a mass far above its
spring 0.06, dampers and friction 0.9 and more."""
SAMPLES_LATE = 2.0
"""And a spring's force that comes so many samples late, as by a filter, must not have as much."""
LEAST_SPRING = 0.3
"""Least share of the force, by standard deviations, that goes with the displacement if its sign is asked instead."""
SHARES, SAME_BAND = (0.1, 0.5, 0.9), 0.1
"""Shares of the motion's power, and by how much the frequencies may differ below which two recordings have them: then
k - m omega^2 is the same in both."""


@dataclass(frozen=True, kw_only=True)
class Signs:
    """What tells a recording's sign: -1, 0 (not told) or 1 by its power and by its spring."""

    power: int
    spring: int
    band_hz: tuple[float, ...]

    def turned(self, other: Signs | None = None) -> bool:
        """Whether the force is turned round: by its own power, else against another recording whose sign is known."""
        if other is not None and self.spring * other.spring != 0 and self._as_fast(other):
            # A force that comes late gives power back too, and its spring has the right sign.
            return self.spring != other.spring and self.power <= 0
        return self.power < 0

    def undone(self) -> Signs:
        """Of the force turned round."""
        return Signs(power=-self.power, spring=-self.spring, band_hz=self.band_hz)

    def _as_fast(self, other: Signs) -> bool:
        return all(abs(math.log(a / b)) < SAME_BAND for a, b in zip(self.band_hz, other.band_hz, strict=True))


def _band_hz(motion: Motion) -> tuple[float, ...]:
    x = motion.displacement - motion.displacement.mean()
    power = np.cumsum(np.abs(fft.rfft(x * np.hanning(x.size))) ** 2)
    lines = np.searchsorted(power, np.array(SHARES) * power[-1])
    return tuple(max(int(k), 1) / (x.size * motion.step_s) for k in lines)


def power(motion: Motion, force: FloatArray) -> tuple[float, float]:
    """Mean of force times velocity over their standard deviations, and its standard error.

    What a spring and a mass take goes to and fro, and is taken off before: it would be the error of a stretch.
    """
    v = motion.velocity - motion.velocity.mean()
    kept = np.column_stack([motion.displacement, np.gradient(v, motion.step_s), np.ones(v.size), v])
    size = np.maximum(np.asarray(np.linalg.norm(kept, axis=0)), 1e-300)
    share = np.linalg.lstsq(kept / size, force, rcond=None)[0]
    dissipated = force - (kept / size)[:, :3] @ share[:3]
    taken = dissipated * v / max(float(force.std() * v.std()), 1e-300)
    parts = [float(p.mean()) for p in np.array_split(taken, STRETCHES)]
    return float(taken.mean()), float(np.std(parts)) / math.sqrt(STRETCHES - 1)


def signs(motion: Motion, force: FloatArray, found: Resisting) -> Signs:
    """`found`: the spring and damper that fit."""
    mean, error = power(motion, force)
    x, v = float(motion.displacement.std()), float(motion.velocity.std())
    late = SAMPLES_LATE * motion.step_s * v / max(x, 1e-300)
    clear = abs(mean) > max(LEAST_POWER, late, LEAST_ERRORS * error)
    stiffness = found.values["stiffness"]
    sprung = abs(stiffness) * x > LEAST_SPRING * float(force.std())
    sprung &= abs(in_standard_errors(found, "stiffness")) > LEAST_ERRORS
    return Signs(
        power=int(math.copysign(1, mean)) if clear else 0,
        spring=int(math.copysign(1, stiffness)) if sprung else 0,
        band_hz=_band_hz(motion),
    )


def feeding_fault(data: Driven, recording: str) -> SensorFault:
    """A force that feeds the motion: for the report."""
    drive, answer = data.drive_channel.name, data.answer_channel.name
    told = f"{answer} would feed the motion, which nothing that resists does"
    detail = f"{recording}: {told}: {answer} or {drive} has the opposite sign"
    return SensorFault(kind="polarity", channel="", detail=detail, recordings=(recording,))
