"""What was added to a motion and is no answer to the measured force: lines fixed in Hz, and a zero that wanders."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy

from reconcile.driven.channels import Driven, FloatArray
from reconcile.driven.machine import weighed
from reconcile.driven.measured import Look, look
from reconcile.driven.model import Model, errors, ready
from reconcile.driven.noise import power_lines, response
from reconcile.gate.mains import MAINS_HZ, SUPPLY
from reconcile.shares import two_digits
from reconcile.verdict import SensorFault

LEAST_LEFT = 0.015
"""Share of the output that the model must leave: less is not looked through for lines."""
STANDS, BESIDE = 100.0, 32
"""Power of a line over the median of so many on either side: of noise one line in 1e30 does."""
DRIVEN = 10.0
"""Power of the force's line over its median beside it, from which the force drives there itself."""
MOST_LINES = 6
"""More are the answer to a periodic force, not of another machine."""
LEAST_SHARE = 0.2
"""Of the error's power, that lines must hold to be told."""
ONE_TONE, HARMONIC = 0.5, 3
"""Share of the force's power in a line and `HARMONIC` beside it from which it is a sine; harmonics are its own then."""
LEAKS = 1e-4
"""Power of a line over the strongest below which it may be that one's leakage."""
NARROW = 4.0
"""Lines a resonance must be wide: a narrower one is a line itself."""
LEAST_TURNS = 8
"""Of a line within the stretch: slower ones are a zero that wanders."""
LEAST_OF_ALL = 0.1
"""Amplitude over the strongest line's from which a line is told."""
MULTIPLES = range(1, 8)
DRIFT_BLOCKS, DRIFT_SHARE, DRIFT_POWER = 20, 0.8, 0.3
"""Blocks whose means a parabola in time must explain to this share, and what it must hold of the error's power: of
noise it explains a tenth, of 1e5 draws none a half."""
ROUNDS = 2
SAME_PLACE = 0.03
"""Over the frequency: lines nearer than that are told as one."""


@dataclass(frozen=True, kw_only=True)
class Tone:
    """A line of the motion that the measured force does not make."""

    hz: float
    motion: float
    """Amplitude."""
    share: float
    """Of the output's standard deviation."""
    force_n: float | None
    """Amplitude of a force on the mass that makes it, where that is known."""


@dataclass(frozen=True, kw_only=True)
class Added:
    """A recording without what was added to its motion."""

    look: Look
    tones: tuple[Tone, ...] = ()
    hum: tuple[Tone, ...] = ()
    drift: float = 0.0
    """Way of the zero over the recording, over the motion's standard deviation."""


def _beside(power: FloatArray) -> FloatArray:
    return np.asarray(scipy.ndimage.median_filter(power, 2 * BESIDE + 1, mode="nearest"))


def _harmonics(driven: FloatArray) -> FloatArray:
    """Whether a line (n,) is a harmonic of a force that is one sine."""
    peak = int(np.argmax(driven[1:])) + 1
    near = driven[max(peak - HARMONIC, 0) : peak + HARMONIC + 1]
    order = np.arange(driven.size) / peak
    if float(near.sum()) < ONE_TONE * float(driven.sum()):
        return np.zeros(driven.size)
    return np.asarray(1.0 * (np.abs(2.0 * order - np.round(2.0 * order)) * peak <= 2 * HARMONIC))


def _places(error: FloatArray, drive: FloatArray, model: Model, step_s: float) -> list[int]:
    """Lines that stand out of the error where the force has none."""
    power, driven = power_lines(error), power_lines(drive)
    out = power > STANDS * _beside(power)
    out &= (driven < DRIVEN * _beside(driven)) & (_harmonics(driven) == 0.0)
    out[:LEAST_TURNS] = False
    width = model.damping / (2.0 * math.pi) * error.size * step_s
    if width < NARROW:
        own = math.sqrt(model.stiffness) / (2.0 * math.pi) * error.size * step_s
        out &= np.abs(np.arange(out.size) - own) > NARROW
    order = [int(k) for k in np.argsort(-power) if out[k]]
    kept: list[int] = []
    for k in order:
        if power[k] > LEAKS * power[order[0]] and all(abs(k - other) > HARMONIC for other in kept):
            kept.append(k)
    return kept


def _columns(hz: list[float], t: FloatArray) -> FloatArray:
    waves = [f(2.0 * math.pi * x * t) for x in hz for f in (np.cos, np.sin)]
    return np.asarray(np.column_stack([np.ones(t.size), *waves]), dtype=np.float64)


def _exact(error: FloatArray, place: int, t: FloatArray) -> float:
    """Frequency of a line to a small part of the spacing."""
    spacing = 1.0 / (error.size * (t[1] - t[0]))
    window = np.hanning(error.size) * (error - error.mean())

    def power(hz: float) -> float:
        return -abs(complex(np.sum(window * np.exp(-2j * math.pi * hz * t))))

    ends = ((place - 1) * spacing, (place + 1) * spacing)
    return float(scipy.optimize.minimize_scalar(power, bounds=ends, method="bounded", options={"xatol": 1e-4}).x)


def _lines(one: Look, error: FloatArray, first: int) -> tuple[list[Tone], FloatArray]:
    """Lines of an error whose first sample is that of the recording, and their course over the recording, (n,)."""
    data = one.data
    t = np.asarray((np.arange(data.answer.size) - first) * data.step_s, dtype=np.float64)
    there = t[first : first + error.size]
    places = _places(error, data.drive[first : first + error.size], one.model, data.step_s)
    nothing = np.zeros(data.answer.size)
    if not places or len(places) > MOST_LINES:
        return [], nothing
    hz = [_exact(error, k, there) for k in places]
    sizes = np.asarray(np.linalg.lstsq(_columns(hz, there), np.asarray(error), rcond=None)[0], dtype=np.float64)
    sizes[0] = 0.0
    if np.var(np.asarray(error - _columns(hz, there) @ sizes)) > (1.0 - LEAST_SHARE) * np.var(error):
        return [], nothing
    tones = []
    for k, f in enumerate(hz):
        size = math.hypot(*sizes[1 + 2 * k : 3 + 2 * k])
        answered = abs(complex(response(one.model, np.array([2.0 * math.pi * f]), data.order)[0]))
        force = size / answered if weighed(one.model, data) else None
        share = size / math.sqrt(2.0) / float(data.answer.std())
        tones.append(Tone(hz=f, motion=size, share=share, force_n=force))
    return tones, np.asarray(_columns(hz, t) @ sizes)


def _drift(error: FloatArray, first: int, n: int) -> FloatArray | None:
    """Course of a zero that wanders, (n,), by an error that begins at `first`; None: it does not."""
    t = (np.arange(n) - first) / error.size * 2.0 - 1.0
    there = t[first : first + error.size]
    blocks = np.array_split(np.arange(error.size), DRIFT_BLOCKS)
    means, when = (np.array([float(np.mean(x[b])) for b in blocks]) for x in (error, there))
    smooth = np.polyval(np.polyfit(when, means, 2), when)
    if np.var(means) == 0.0 or np.var(means - smooth) > (1.0 - DRIFT_SHARE) * np.var(means):
        return None
    course = np.polyval(np.polyfit(there, error, 2), t)
    if np.var(error - course[first : first + error.size]) > (1.0 - DRIFT_POWER) * np.var(error):
        return None
    return np.asarray(course - course[first : first + error.size].mean())


def without_added(one: Look) -> Added:
    """Lines and drift found, and taken off; fitted anew each time."""
    found = Added(look=one)
    for _ in range(ROUNDS):
        now = found.look
        if now.left < LEAST_LEFT or now.data.prescribed or now.data.bad_answer is not None:
            break
        run = ready(now.data, now.model.memory_s)
        error = errors(now.model, run)
        if not np.any(error):
            break
        wandered = _drift(error, run.skip, now.data.answer.size)
        course = wandered if wandered is not None else np.zeros(now.data.answer.size)
        tones, sung = _lines(now, error - course[run.skip :], run.skip)
        if wandered is None and not tones:
            break
        after = look(replace(now.data, answer=now.data.answer - course - sung))
        hum = is_hum(tones, error.size * now.data.step_s)
        found = Added(
            look=after,
            tones=(*found.tones, *(() if hum else tones)),
            hum=(*found.hum, *(tones if hum else ())),
            drift=found.drift + float(np.ptp(course)) / (float(after.data.answer.std()) or 1.0),
        )
    return replace(found, tones=distinct(found.tones), hum=distinct(found.hum))


def distinct(tones: Sequence[Tone]) -> tuple[Tone, ...]:
    """Lines that are told: the strongest at a place, and none that another's removal may have left."""
    found: list[Tone] = []
    for tone in sorted(tones, key=lambda t: -t.motion):
        apart = all(abs(tone.hz / other.hz - 1.0) > SAME_PLACE for other in found)
        if not found or (apart and tone.motion > LEAST_OF_ALL * found[0].motion):
            found.append(tone)
    return tuple(found)


def is_hum(tones: Sequence[Tone], duration_s: float) -> bool:
    """Whether all lines are multiples of one supply's frequency, an odd one among them: a motor pulls at even ones."""
    for supply in MAINS_HZ:
        near = [round(tone.hz / supply) for tone in tones]
        off = [abs(tone.hz - m * supply) for tone, m in zip(tones, near, strict=True)]
        if tones and all(
            m in MULTIPLES and x < max(SUPPLY * m * supply, 0.5 / duration_s) for m, x in zip(near, off, strict=True)
        ):
            return any(m % 2 for m in near)
    return False


def faults(found: Added, data: Driven, recording: str) -> list[SensorFault]:
    """Hum and drift, for the report."""
    said, channel = [], data.answer_channel
    if found.drift > 0.0:
        detail = (
            f"{recording}: its zero wanders by {found.drift:.2g} of the motion's size, which no measured force does"
        )
        said.append(SensorFault(kind="drift", channel=channel.name, detail=detail, recordings=(recording,)))
    if found.hum:
        places = ", ".join(f"{tone.hz:.5g} Hz ({two_digits(tone.share)})" for tone in found.hum)
        detail = f"{recording}: lines at {places} of the output, where the force has none"
        said.append(SensorFault(kind="mains_hum", channel=channel.name, detail=detail, recordings=(recording,)))
    return said


def tone_words(tone: Tone, unit: str) -> str:
    """`31.3 Hz (0.12 mm, 46 % of the output; by a force of 20 N)`."""
    force = "" if tone.force_n is None else f"; a force of {tone.force_n:.3g} N does that"
    return f"{tone.hz:.4g} Hz ({tone.motion:.3g} {unit}, {two_digits(tone.share)} of the output{force})"
