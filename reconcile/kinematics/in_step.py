"""Impacts several times a turn, in step with a shaft: pistons, vanes, blades, the jaws of a coupling. No bearing.

Balls slip, so a defect's lines drift against a multiple of the turn; what the shaft drives keeps to it. Where the speed
wanders, lines at high orders smear beyond the bins that are taken for the shaft's, and look like a part's. So the phase
of the envelope's line is held against that of the shaft's own line (or its pulses) all along the recording.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import fft

from reconcile.kinematics.candidate import Candidate
from reconcile.kinematics.contrast import band_turns, contrast
from reconcile.kinematics.envelopes import order_depth, squared_envelope
from reconcile.kinematics.evidence import Evidence
from reconcile.kinematics.families import Family, Ties
from reconcile.kinematics.observe import Observation
from reconcile.speed.excess import EXPONENTIAL_MEDIAN, running_median
from signals.series import ComplexArray, FloatArray

WANDER = 0.02
"""Share of its frequency by which a line may wander."""
LEAST_BINS = 4
"""Half the width of the band around a line, at least."""
SHAFT_LINES = (1, 2, 3, 4)
"""Of which the clearest is followed."""
LEAST_SHARE = 0.5
"""Of the power about a line, that lies in the main lobe once the shaft's turning is taken out. Slip alone of 0.5 % a
blow leaves a race less in a hundred turns."""
MAIN_LOBE = 2
MOST_PHASE = 0.5
"""Variance of the shaft's phase by the noise about its line, at the order asked for, rad^2."""
NEAR = 0.01
"""Share of an order by which smeared lines may miss a multiple of a shaft."""
OWN_SHARE = 0.8
"""Of the power at all multiples of a shaft, that lies at those of the number of blows: a piston or a blade that differs
a little leaves some at the others, a blow once a turn most."""
MOST = 24
LEAST_KURTOSIS = 0.5
"""Excess of the complex envelope of a band in which something strikes: 0 for noise, below it for steady tones."""
LEAST_DEPTH, GROWTH_DB = 0.3, 10.0
"""Of what is told as new: as of impacts at an order of no part (`reconcile.kinematics.foreign`)."""


@dataclass(frozen=True, kw_only=True)
class InStep:
    """`number` blows a turn of `shaft`, in step with it; heard best in a band of a channel."""

    shaft: str
    number: int
    order: float
    channel: str
    band_hz: tuple[float, float]


def blows(test: Observation, ties: Ties, channel: str, band_hz: tuple[float, float]) -> InStep | None:
    """What strikes twice a turn of a shaft or more often, equally and in step, in a band; else None.

    A number of teeth is none: the mesh is known.
    """
    for shaft, ratio in ties.shafts.items():
        number = _number(test, channel, band_hz, ratio)
        if number is None or any(abs(number * ratio - order) < 1e-6 for order in ties.mesh_orders):
            continue
        if keeps_step(test, channel, band_hz, number * ratio):
            order = number * ratio
            return InStep(shaft=shaft, number=number, order=order, channel=channel, band_hz=band_hz)
    return None


def of_blows(one: Candidate, tests: Sequence[Observation], ties: Ties) -> InStep | None:
    """What strikes in step with a shaft, where that makes the lines of a family, in most of the tests: of a bearing's
    the own line, or the second where the first is not there, stands at a multiple of the number of blows; of a shaft's
    turn all lines are there."""
    found = []
    for e, test in zip(one.evidence, tests, strict=True):
        struck = blows(test, ties, e.channel, e.band_hz)
        found.append(struck if struck is not None and _makes(struck, one.family, e.order) else None)
    return _of_most(found)


def new_blows(
    tests: Sequence[Observation], baselines: Sequence[Observation], ties: Ties
) -> tuple[InStep, float | None] | None:
    """Blows in step with a shaft in the most impulsive band of most of the tests, and their growth over the baseline,
    dB (None without one); None where the baseline has them too, or they are shallow."""
    heard = [_most_impulsive(test, ties) for test in tests]
    found = _of_most(heard)
    if found is None:
        return None
    test = tests[next(i for i, one in enumerate(heard) if one is found)]
    family = Family(kind="outer", site="", order=found.order, spacing=0.0, sidebands=0, slip=0.0)
    evidence = Evidence(
        family=family,
        z=0.0,
        chance=1.0,
        slip=0.0,
        order=found.order,
        channel=found.channel,
        band_hz=found.band_hz,
        depth=0.0,
        channel_z={},
    )
    change = contrast(evidence, test, baselines, ties)
    if change.depth < LEAST_DEPTH or (change.growth_db is not None and change.growth_db < GROWTH_DB):
        return None
    return found, change.growth_db


def _most_impulsive(test: Observation, ties: Ties) -> InStep | None:
    e = max(test.channels, key=lambda one: float(np.max(one.kurtosis)))
    band = int(np.argmax(e.kurtosis))
    return blows(test, ties, e.channel, e.band(band)) if e.kurtosis[band] >= LEAST_KURTOSIS else None


def _makes(struck: InStep, family: Family, order: float) -> bool:
    if family.kind == "turn":
        return struck.shaft == family.site
    numbers = [k * order / struck.order for k in (1, 2)]
    return any(round(n) >= 1 and abs(n / round(n) - 1.0) < NEAR for n in numbers)


def _of_most(found: Sequence[InStep | None]) -> InStep | None:
    first = next((f for f in found if f is not None), None)
    return first if 2 * sum(f is not None for f in found) > len(found) else None


def _number(test: Observation, channel: str, band_hz: tuple[float, float], ratio: float) -> int | None:
    """The largest number of equal blows a turn that has nearly all of the power at a shaft's multiples."""
    depth, step = order_depth(*band_turns(test, channel, band_hz))
    power = depth**2
    over = np.maximum(power - 2.0 * running_median(power) / EXPONENTIAL_MEDIAN, 0.0)
    top = int((power.size - 1) * step / ratio)
    level = np.zeros(top + 1)
    for j in range(1, top + 1):
        reach = min(MAIN_LOBE * step + 0.4 * NEAR * j * ratio, 0.3 * ratio)
        low, high = (round((j * ratio + s * reach) / step) for s in (-1, 1))
        level[j] = float(np.sum(over[max(low, 1) : high + 1]))
    total = float(np.sum(level))
    if total <= 0.0:
        return None
    shares = [(k, float(np.sum(level[k::k])) / total) for k in range(2, min(top, MOST) + 1)]
    return max((k for k, share in shares if share >= OWN_SHARE), default=None)


def keeps_step(test: Observation, channel: str, band_hz: tuple[float, float], order: float) -> bool:
    """Whether the envelope of a band has a line at `order` of the reference shaft that keeps to its phase all along."""
    rate = test.recording.sampling_rate_hz
    square, envelope_rate, _ = squared_envelope(test.white(channel), band_hz[0], band_hz[1], rate)
    seconds = square.size / envelope_rate
    hz = order * test.speed.speed_hz
    width = _width(hz, seconds)
    count = 4 * width
    line = _about(fft.rfft(square), round(hz * seconds), width, count)
    turned = _turning(test, seconds, order, count)
    if turned is None:
        return False
    time = np.arange(count) / count
    still = line * np.exp(2j * np.pi * round(hz * seconds) * time - 1j * order * turned)
    power = np.abs(fft.fft(still * np.hanning(count))) ** 2
    near = np.concatenate((power[-width:], power[: width + 1]))
    peak = abs(int(np.argmax(near)) - width)
    share = float(np.sum(near[width - MAIN_LOBE : width + MAIN_LOBE + 1]) / max(float(np.sum(near)), 1e-300))
    return peak == 0 and share >= LEAST_SHARE


def _width(hz: float, seconds: float) -> int:
    return max(LEAST_BINS, int(np.ceil(WANDER * hz * seconds)))


def _about(transform: ComplexArray, middle: int, width: int, count: int) -> ComplexArray:
    """A line moved to 0 Hz, (count,) over the recording: the bins up to `width` from its `middle`."""
    bins = np.arange(-width, width + 1)
    inside = (middle + bins > 0) & (middle + bins < transform.size)
    moved = np.zeros(count, dtype=np.complex128)
    moved[bins[inside] % count] = transform[middle + bins[inside]]
    return np.asarray(fft.ifft(moved), dtype=np.complex128)


def _turning(test: Observation, seconds: float, order: float, count: int) -> FloatArray | None:
    """Angle of the reference shaft, rad, (count,) over the recording; None where nothing says it well enough for a
    line at `order`."""
    if test.speed.method == "tacho":
        angle = test.channels[0].angle_rad
        known = np.flatnonzero(np.isfinite(angle))
        place = np.arange(count) / count * angle.size
        return np.asarray(np.interp(place, known, angle[known]), dtype=np.float64)
    if test.speed.method != "harmonics":
        return None
    best: tuple[float, FloatArray] | None = None
    time = np.arange(count) / count
    for samples in test.recording.samples:
        transform = fft.rfft(samples - np.mean(samples))
        for k in SHAFT_LINES:
            middle = round(k * test.speed.speed_hz * seconds)
            width = min(_width(k * test.speed.speed_hz, seconds), count // 4)
            line = _about(transform, middle, width, count)
            error = (order / k) ** 2 * _noise(transform, middle, width) * (2 * width + 1) / _power(line, count)
            if best is None or error < best[0]:
                best = error, (np.unwrap(np.angle(line)) + 2 * np.pi * middle * time) / k
    return None if best is None or best[0] > MOST_PHASE else best[1]


def _noise(transform: ComplexArray, middle: int, width: int) -> float:
    """Mean power of a bin beside a line, three to five of its widths away."""
    away = np.concatenate((np.arange(-5 * width, -3 * width), np.arange(3 * width, 5 * width))) + middle
    away = away[(away > 0) & (away < transform.size)]
    return float(np.median(np.abs(transform[away]) ** 2) / EXPONENTIAL_MEDIAN) if away.size else float("inf")


def _power(line: ComplexArray, count: int) -> float:
    return max(float(np.mean(np.abs(line) ** 2)) * count**2, 1e-300)
