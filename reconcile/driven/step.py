"""Force and motion out of step, or a motion that is another than is described: told by the phase at all frequencies.

The linear model is held against the frequency response with a delay, and as every other derivative of the motion. What
fits best there is fitted again to the recording itself.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy
from scipy import fft

from reconcile.driven.channels import MOTIONS, BoolArray, Driven, FloatArray
from reconcile.driven.measured import Look, look
from reconcile.driven.missing import displaced, sensitivities
from reconcile.driven.model import counted, errors, ready, simulated
from reconcile.shares import two_digits
from reconcile.verdict import SensorFault

LEAST_LEFT = 0.1
"""Share of the output that the model must leave to look for a delay: within a period a delay of a sixtieth leaves as
much."""
BETTER = 0.5
"""Error with the delay, or as another motion, over that as described, from which it is believed."""
BESIDE_A_LAW = 0.05
"""Power that an averaged response leaves with the delay, over that without, from which a delay is believed though a
linear model leaves as much as ever: beside a law, which hardly turns that response. Made oscillators with laws and a
delay of 2 or 4 samples had at most 0.001, without a delay at least 0.2."""
FOLLOWS = 0.25
"""Share of the motion that must follow the force for that: of noise alone 0.13 at most did, with a cubic
spring 0.49."""
PERIODS, A_PERIOD = 2.0, 24
"""Longest delay in natural periods, and delays that are tried in one."""
DAMPED = 0.002
"""Least share of critical damping of a fit: a motion that comes before its force would have it negative."""
LONGEST, SEGMENTS = 4096, 8
EDGE = 24
"""Samples at the ends that a shift by a part of a sample spoils."""
UNITS = {"displacement": "m", "velocity": "m/s", "acceleration": "m/s^2"}


@dataclass(frozen=True, kw_only=True)
class Responded:
    """Lines of a frequency response: angular frequency, motion over force, its weight, power of the force; share of the
    motion's power that follows the force at these lines."""

    omega: FloatArray
    ratio: np.ndarray[tuple[int], np.dtype[np.complex128]]
    weight: FloatArray
    pushed: FloatArray
    follows: float

    def left(self, order: int, delay_s: float) -> float:
        """Power of the motion that a mass on a spring leaves if the motion is of this order and comes so much late."""
        turned = (1j * self.omega) ** order * np.exp(-1j * self.omega * delay_s)
        inverse = turned / np.where(self.ratio == 0, 1e-300, self.ratio)
        weight = self.weight / np.abs(inverse)
        # 1/H = (stiffness - omega^2 + i omega damping) / gain
        real = np.stack([weight, -(self.omega**2) * weight], axis=1)
        size = np.asarray(np.linalg.norm(real, axis=0), dtype=np.float64)
        a, b = (float(x) for x in np.linalg.lstsq(real / size, inverse.real * weight, rcond=None)[0] / size)
        slope = self.omega * weight
        c = float(slope @ (inverse.imag * weight)) / max(float(slope @ slope), 1e-300)
        if a * b <= 0.0:
            return math.inf
        least = 2.0 * DAMPED * math.sqrt(a * b) * math.copysign(1.0, b)
        c = math.copysign(max(c * math.copysign(1.0, b), abs(least)), b)
        model = turned / (a - b * self.omega**2 + 1j * self.omega * c)
        return float(np.sum(self.pushed * np.abs(self.ratio - model) ** 2))


def responded(data: Driven) -> Responded:
    """By averaged cross spectra."""
    n, rate = min(LONGEST, data.answer.size // SEGMENTS), 1.0 / data.step_s
    frequency, cross = scipy.signal.csd(data.drive, data.answer, rate, nperseg=n)
    pushed = scipy.signal.welch(data.drive, rate, nperseg=n)[1][1:]
    moved = scipy.signal.welch(data.answer, rate, nperseg=n)[1][1:]
    coherence = np.abs(cross[1:]) ** 2 / np.maximum(pushed * moved, 1e-300)
    ratio = cross[1:] / np.maximum(pushed, 1e-300)
    weight = np.where(np.abs(cross[1:]) > 1e-3 * np.abs(cross[1:]).max(), coherence**2, 0.0)
    follows = float(np.sum(coherence * moved) / max(float(moved.sum()), 1e-300))
    omega = 2.0 * math.pi * frequency[1:]
    return Responded(omega=omega, ratio=ratio, weight=weight, pushed=pushed * coherence, follows=follows)


def _delay(seen: Responded, one: Look) -> float:
    """The delay that leaves least, s."""
    period = 2.0 * math.pi / math.sqrt(max(one.model.stiffness, 1e-300))
    strongest = 2.0 * math.pi / float(seen.omega[np.argmax(np.abs(seen.ratio) * np.sqrt(seen.pushed))])
    order, step = one.data.order, min(period, strongest) / A_PERIOD
    found = 0.0
    tried = np.asarray(np.arange(-PERIODS * A_PERIOD, PERIODS * A_PERIOD + 1) * step, dtype=np.float64)
    for width in (step, step / 8.0, step / 64.0):
        found = float(min(tried, key=lambda x: seen.left(order, float(x))))
        tried = np.asarray(found + width * np.arange(-8, 9) / 8.0)
    return found


def in_step(data: Driven, delay_s: float) -> Driven:
    """The recording with its motion that much earlier, without the ends that have no partner."""
    samples = delay_s / data.step_s
    whole = round(samples)
    count = data.answer.size - abs(whole)
    first, moved = (0, whole) if whole >= 0 else (-whole, 0)
    answer = data.answer[moved : moved + count]
    turned = np.exp(2j * np.pi * np.fft.rfftfreq(count) * (samples - whole))
    line = np.linspace(answer[0], answer[-1], count)
    shifted = fft.irfft(fft.rfft(answer - line) * turned, count) + line

    def cut(bad: BoolArray | None, start: int) -> BoolArray | None:
        return None if bad is None else bad[start : start + count][EDGE:-EDGE]

    return replace(
        data,
        drive=np.ascontiguousarray(data.drive[first : first + count][EDGE:-EDGE]),
        answer=np.ascontiguousarray(shifted[EDGE:-EDGE]),
        bad_drive=cut(data.bad_drive, first),
        bad_answer=cut(data.bad_answer, moved),
    )


def closer(near: Look) -> float:
    """What is left of a delay, s, by one step of least squares on the free run (a long delay leaks out of segments)."""
    run = ready(near.data, near.model.memory_s)
    answered = simulated(near.model, run)
    late = counted(-np.gradient(answered, near.data.step_s)[run.skip :], run)
    columns = np.column_stack([late, sensitivities(near.model, run, displaced(near.model, run))])
    size = np.asarray(np.linalg.norm(columns, axis=0), dtype=np.float64)
    size = np.where(size > 0.0, size, 1.0)
    return float(np.linalg.lstsq(columns / size, errors(near.model, run), rcond=None)[0][0] / size[0])


def _other_motions(data: Driven) -> Sequence[Driven]:
    """The recording with its motion described as every other one."""
    channel = data.answer_channel
    if channel.quantity not in MOTIONS:
        return ()
    return [
        replace(data, answer_channel=replace(channel, quantity=quantity, unit=UNITS[quantity]))
        for quantity in MOTIONS
        if quantity != channel.quantity
    ]


def stepped(one: Look, recording: str) -> tuple[Look, SensorFault] | None:
    """The recording in step, or with its motion as what it is, where the model then leaves clearly less."""
    if one.left < LEAST_LEFT or one.data.prescribed:
        return None
    seen = responded(one.data)
    least = BETTER**2 * seen.left(one.data.order, 0.0)
    others = [d for d in _other_motions(one.data) if seen.left(d.order, 0.0) < least]
    delay = _delay(seen, one)
    late, exact = abs(delay) >= one.data.step_s and seen.left(one.data.order, delay) < least, delay
    if late:
        exact += closer(look(in_step(one.data, delay)))
        others.append(in_step(one.data, exact))
    looks = [look(d) for d in others]
    best = min(looks, key=lambda x: x.left, default=one)
    if best.left <= BETTER * one.left:
        return best, _fault(one, best, exact, recording)
    least = BESIDE_A_LAW * seen.left(one.data.order, 0.0)
    if late and seen.follows > FOLLOWS and seen.left(one.data.order, delay) < least:
        straight = look(in_step(one.data, delay))
        return straight, late_fault(straight.data, delay, recording)
    return None


def _fault(one: Look, best: Look, delay_s: float, recording: str) -> SensorFault:
    name, drive = one.data.answer_channel.name, one.data.drive_channel.name
    left = f"a linear model leaves {two_digits(one.left)} as described, {two_digits(best.left)}"
    was, now = one.data.answer_channel.quantity, best.data.answer_channel.quantity
    if was != now:
        detail = f"{recording}: {name} is {_article(now)}, not {_article(was)}; {left} as {_article(now)}"
        return SensorFault(kind="other_motion", channel=name, detail=detail, recordings=(recording,))
    detail = f"{recording}: {name} comes {_when(delay_s)} for {drive}, at all frequencies; {left} in step"
    return SensorFault(kind="out_of_step", channel=name, detail=detail, recordings=(recording,))


def late_fault(data: Driven, delay_s: float, recording: str) -> SensorFault:
    """Beside a law, which turns the averaged response a little itself: for the report."""
    name = data.answer_channel.name
    detail = f"{recording}: {name} comes about {_when(delay_s, 2)} for {data.drive_channel.name}, at all frequencies"
    return SensorFault(kind="out_of_step", channel=name, detail=detail, recordings=(recording,))


def _when(delay_s: float, digits: int = 3) -> str:
    return f"{1e3 * abs(delay_s):.{digits}g} ms too {'late' if delay_s > 0 else 'early'}"


def _article(quantity: str) -> str:
    return f"{'an' if quantity[0] == 'a' else 'a'} {quantity}"
