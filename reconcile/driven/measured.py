"""Units and channels held against other recordings and the machine file: by the linear model that each one fits.

A unit scales force or motion and leaves frequency and damping as they are, and no machine does that: another mass or
spring moves the frequency. Force and motion exchanged make an answer that comes before its cause: a mass on a spring
cannot give it, and gives it well the other way round.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from reconcile.driven.channels import FORCES, Driven
from reconcile.driven.forced import calibrate
from reconcile.driven.judge import UNRELATED
from reconcile.driven.machine import Site, weighed
from reconcile.driven.model import Model, nrmse, share_kept
from reconcile.driven.split import Part
from reconcile.shares import two_digits
from reconcile.verdict import SensorFault

FORCE_RATIOS = {"kN against N": 1000.0, "kgf against N": 9.80665, "lbf against N": 4.44822}
MOTION_RATIOS = {
    "displacement": {"mm against m": 1000.0, "µm against m": 1e6, "inch against m": 39.3701, "inch against mm": 25.4},
    "velocity": {"mm/s against m/s": 1000.0, "inch/s against m/s": 39.3701, "inch/s against mm/s": 25.4},
    "acceleration": {"g against m/s^2": 9.80665, "mm/s^2 against m/s^2": 1000.0},
}
OTHER_RATIOS = {"V against mV": 1000.0}
NEAR_UNIT = 0.08
"""By which a ratio of units may be missed."""
SAME_FREQUENCY, SAME_FREQUENCY_FILE = 0.05, 0.1
"""Within which two recordings, or a recording and the machine file, are of one oscillator."""
OTHER_GAIN = 1.3
"""Ratio of two recordings' gains from which on one of them is wrong: the fit of one is good to some per cent."""
SPRING_APART = 1.5
"""Ratio of frequencies within which another mass or spring is no answer to a mass that is off by a unit: both would
have to be off by that unit."""
FAR = 20.0
"""Least ratio of units that is told of a machine file's mass where the frequency is another: files are rough."""
LAWFUL, LAWFUL_OFF = 100.0, 3.0
"""Least ratio of units that is told where a linear model does not carry a recording, and by how much gains and levels
may then miss it."""
LEVEL_SHARE = 0.35
"""Of the change, in logarithms, that a channel's own level may have changed by to be the one that is right."""
CLOCKS = (2.0, 0.5)
"""Factors by which a sampling rate is mistaken (one of two channels counted twice, every other sample dropped)."""
CLOCK_OFF, CLOCK_GAIN, CLOCK_DAMPING = 0.02, 0.1, 0.25
"""In logarithms, what frequency, gain and damping may then miss by: fits of one oscillator are within some per cent, of
its damping within 15 %."""
OPPOSITE = (
    "The mass moves against its force, as if it were negative: the polarity of force or motion is reversed, and mass, "
    "stiffness and laws have the sizes of the machine file's mass."
)
FITS = 0.5
"""Share of the output that a linear model may leave to be held against another."""
REVERSED, REVERSED_UNRELATED = 0.6, 0.85
"""Error the other way round, over the error as described, below which the channels are exchanged; the second where the
motion does not follow the force at all."""
LEAST_KEPT = 0.3
"""Share of the samples that must be sound for a fit to be held against another."""
MOST_M_PER_S2 = 1e4
"""A thousand g: no vibration of a part that is meant to stay whole."""
FILE_OFF = 1.3
"""Ratio of mass or frequency to the machine file's that is worth a remark."""


@dataclass(frozen=True, kw_only=True)
class Look:
    """A recording with the linear model that it fits, and the share of the output that this leaves."""

    data: Driven
    model: Model
    left: float

    @property
    def frequency_hz(self) -> float:
        """Of the fitted oscillator."""
        return math.sqrt(self.model.stiffness) / (2.0 * math.pi)


@dataclass(frozen=True, kw_only=True)
class Scaled:
    """A channel whose numbers are `factor` times too large; `drives` None: force or motion, which is not known."""

    factor: float
    drives: bool | None
    words: str
    unit: bool
    """Whether the factor is a ratio of units."""

    def fault(self, data: Driven, recording: str, against: str) -> SensorFault:
        """For the report; `against`: what it was held against."""
        names = (data.drive_channel.name, data.answer_channel.name)
        channel = "" if self.drives is None else names[0 if self.drives else 1]
        whose = f"{channel} is" if channel else f"{names[1]} over {names[0]} is"
        detail = f"{recording}: by {against} {whose} {self.factor:.4g} times too large ({self.words})"
        kind = "unit_mismatch" if self.unit else "gain_change"
        return SensorFault(kind=kind, channel=channel, detail=detail, recordings=(recording,))

    def undone(self, data: Driven) -> Driven:
        """The recording with the numbers put right."""
        if self.drives is None:
            return data
        return (
            replace(data, drive=data.drive / self.factor)
            if self.drives
            else replace(data, answer=data.answer / self.factor)
        )


def look(data: Driven) -> Look:
    """Fit the linear model to the liveliest stretch."""
    found = calibrate(Part(name="", data=data))
    kept = share_kept(found.run)
    left = nrmse(found.linear.error, found.run.compared) / math.sqrt(kept) if kept > LEAST_KEPT else 1.0
    return Look(data=data, model=found.linear.model, left=left)


def exchanged(one: Look) -> Look | None:
    """The recording with its channels exchanged, where a mass on a spring fits only then."""
    if one.left < FITS or one.data.prescribed:
        return None
    data = one.data
    turned = replace(data, drive=data.answer, answer=data.drive, bad_drive=data.bad_answer, bad_answer=data.bad_drive)
    other = look(turned)
    least = REVERSED_UNRELATED if one.left > UNRELATED else REVERSED
    return other if other.left < least * one.left else None


def swap_fault(one: Look, other: Look, recording: str) -> SensorFault:
    """For the report."""
    drive, answer = one.data.drive_channel.name, one.data.answer_channel.name
    detail = (
        f"{recording}: {answer} comes before {drive}; a linear model leaves {two_digits(one.left)} as described, "
        f"{two_digits(other.left)} with {drive} and {answer} exchanged"
    )
    return SensorFault(kind="swapped_channels", channel=drive, detail=detail, recordings=(recording,))


def scaled(one: Look, reference: Look) -> Scaled | None:
    """What the numbers of a recording are wrong by against another of the same oscillator, or None."""
    apart = one.frequency_hz / reference.frequency_hz
    gain = abs(one.model.gain / reference.model.gain) if reference.model.gain else 1.0
    if gain == 0.0 or abs(math.log(gain)) < math.log(OTHER_GAIN):
        return None
    pushed = math.log(float(one.data.drive.std()) / float(reference.data.drive.std()))
    moved = math.log(float(one.data.answer.std()) / float(reference.data.answer.std()))
    drives = None if min(abs(pushed), abs(moved)) > LEVEL_SHARE * abs(math.log(gain)) else abs(moved) < abs(pushed)
    if max(one.left, reference.left) > FITS:
        return _by_level(one.data, math.log(gain), pushed, moved)
    found = by_factor(one.data, gain, drives)
    if abs(apart - 1.0) <= SAME_FREQUENCY:
        return found
    return found if found.unit and abs(math.log(apart)) < math.log(SPRING_APART) else None


def _by_level(data: Driven, gain: float, pushed: float, moved: float) -> Scaled | None:
    """A large ratio of units that gains and levels agree about, in logarithms, where a linear model fits neither of
    them well."""
    near, drives = math.log(LAWFUL_OFF), abs(moved) < abs(pushed)
    if min(abs(pushed), abs(moved)) > near or abs(gain - (moved - pushed)) > near:
        return None
    for words, ratio in _ratios(data, drives).items():
        if ratio >= LAWFUL and abs(abs(moved - pushed) - math.log(ratio)) < near:
            larger = ratio if (pushed if drives else moved) > 0.0 else 1.0 / ratio
            return Scaled(factor=larger, drives=drives, words=words, unit=True)
    return None


def _ratios(data: Driven, drives: bool | None) -> dict[str, float]:
    """Ratios of units by their words; `drives` None: of both channels."""
    drive, answer = (_units(c.quantity) for c in (data.drive_channel, data.answer_channel))
    return {**(drive if drives is not False else {}), **(answer if drives is not True else {})}


def _units(quantity: str) -> dict[str, float]:
    return FORCE_RATIOS if quantity in FORCES else MOTION_RATIOS.get(quantity, OTHER_RATIOS)


def by_factor(data: Driven, gain: float, drives: bool | None, off: float = NEAR_UNIT) -> Scaled:
    """From a ratio of gains, output over input, missed by at most `off` in logarithms. Which channel is not known: the
    factor of the output is told."""
    far = {words: abs(abs(math.log(gain)) - math.log(ratio)) for words, ratio in _ratios(data, drives).items()}
    least = min(far.values())
    if least >= off:
        return Scaled(factor=1.0 / gain if drives else gain, drives=drives, words="no ratio of units", unit=False)
    near = [words for words, x in far.items() if x < NEAR_UNIT or x == least]
    exact = _ratios(data, drives)[near[0]]
    larger = exact if (gain > 1.0) != bool(drives) else 1.0 / exact
    return Scaled(factor=larger, drives=drives, words=" or ".join(near), unit=True)


def turned_against(one: Look, reference: Look) -> bool:
    """Whether force and motion have one sign in one recording, and opposite ones in the other."""
    apart = abs(one.frequency_hz / reference.frequency_hz - 1.0)
    turned = one.model.gain * reference.model.gain < 0.0
    return turned and apart < SAME_FREQUENCY_FILE and max(one.left, reference.left) < FITS


def turned_fault(data: Driven, recording: str, against: str) -> SensorFault:
    """For the report: which of both channels is turned round no recording tells."""
    drive, answer = data.drive_channel.name, data.answer_channel.name
    detail = f"{recording}: by {against} {answer} or {drive} has the opposite sign"
    return SensorFault(kind="polarity", channel="", detail=detail, recordings=(recording,))


def clocked(one: Look, reference: Look) -> float | None:
    """By how much too high the stated sampling rate is, against a recording of the same oscillator; None: it is not.

    A rate wrong by r scales frequency and damping rate by r and the gain by r^(2 - order), which keeps stiffness (of a
    displacement), damping (of a velocity) or mass (of an acceleration). Only an oscillator of which the two other
    numbers have changed by just these powers of two does the same; the fault says so.
    """
    if max(one.left, reference.left) > FITS or one.model.gain * reference.model.gain == 0.0:
        return None
    apart = one.frequency_hz / reference.frequency_hz
    near = [r for r in CLOCKS if abs(math.log(apart / r)) < CLOCK_OFF]
    if not near:
        return None
    damped = one.model.damping / max(reference.model.damping, 1e-300) / apart
    gained = abs(one.model.gain / reference.model.gain) / apart ** (2 - one.data.order)
    alike = abs(math.log(max(damped, 1e-300))) < CLOCK_DAMPING and abs(math.log(gained)) < CLOCK_GAIN
    return near[0] if alike else None


def clock_fault(data: Driven, factor: float, recording: str, against: str) -> SensorFault:
    """For the report."""
    stated = 1.0 / data.step_s
    detail = (
        f"{recording}: all frequencies and the damping rate are {factor:.4g} times those of {against}: the sampling "
        f"rate is {stated / factor:g} Hz, not {stated:g} Hz, or {against} is in error (mass, damping and stiffness "
        "changed by just such powers of two would look alike)"
    )
    return SensorFault(kind="sampling_rate", channel="", detail=detail, recordings=(recording,))


def against_file(one: Look, site: Site) -> Scaled | None:
    """A ratio of units between the mass that a recording tells and the machine file's, their frequencies being one."""
    mass, frequency = of_file(site)
    if not weighed(one.model, one.data) or one.left > FITS or frequency is None:
        return None
    gain, apart = one.model.gain * mass, one.frequency_hz / frequency
    far = abs(math.log(gain)) > math.log(FAR) and abs(math.log(apart)) < math.log(SPRING_APART)
    if abs(apart - 1.0) > SAME_FREQUENCY_FILE and not far:
        return None
    pushed = float(one.data.drive.std()) / mass
    moved = float(one.data.answer.std()) * (2.0 * math.pi * one.frequency_hz) ** (2 - one.data.order)
    too_much = [pushed > MOST_M_PER_S2, moved > MOST_M_PER_S2]
    drives = too_much[0] if sum(too_much) == 1 else None
    found = by_factor(one.data, gain, drives) if abs(math.log(gain)) > math.log(OTHER_GAIN) else None
    return found if found is not None and found.unit else None


def of_file(site: Site) -> tuple[float, float | None]:
    """Mass, kg, and natural frequency, Hz, of the machine file (None: it has no spring)."""
    body = site.body
    stiffness = body.stiffness_x_n_per_m if site.axis == "x" else body.stiffness_y_n_per_m
    return body.mass_kg, math.sqrt(stiffness / body.mass_kg) / (2.0 * math.pi) if stiffness > 0 else None


def remarks(several: Sequence[Look], site: Site) -> tuple[str, ...]:
    """Where the recordings tell another oscillator than the machine file has."""
    mass, frequency = of_file(site)
    one = several[0]
    if one.data.calibrated and one.model.gain < 0.0 and one.left < FITS:
        return (OPPOSITE,)
    if not weighed(one.model, one.data) or one.left > FITS or frequency is None:
        return ()
    here = (1.0 / one.model.gain, one.frequency_hz)
    if all(abs(math.log(a / b)) < math.log(FILE_OFF) for a, b in zip(here, (mass, frequency), strict=True)):
        return ()
    told = (
        f"The recordings tell {here[0]:.3g} kg at {here[1]:.4g} Hz, the machine file {mass:.3g} kg at "
        f"{frequency:.4g} Hz: if that is this machine, look at the units of force and motion."
    )
    return (told,)
