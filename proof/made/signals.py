"""What sensors of a rig hear: shafts, teeth, noise, and what is hidden in the test."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from proof.made.rigs import LABEL, LINES, FloatArray, Rig

SWAY_HZ = (0.3, 1.1, 2.7)
GAIN = 0.03
"""By which a sensor's sensitivity differs from one session to the next, standard deviation."""
SLIP = (-0.012, 0.004)
STRENGTHS = {"pit": (1.0, 15.0), "tooth": (0.2, 1.5)}
"""From hardly to be seen to gross."""


@dataclass(frozen=True, kw_only=True)
class Hidden:
    """`word`: nothing, load, outer, inner, ball or tooth; `place`: number of the bearing, or (stage, side)."""

    word: str
    site: str = ""
    bearing: int = 0
    stage: int = 0
    side: int = 0
    strength: float = 1.0


def hidden(rig: Rig, number: int, rng: np.random.Generator) -> Hidden:
    """What the case `number` hides, in turn."""
    pit, tooth = (float(np.exp(rng.uniform(*np.log(STRENGTHS[kind])))) for kind in ("pit", "tooth"))
    if rig.teeth:
        word = ("nothing", "tooth", "tooth", "load")[number % 4]
        stage, side = int(rng.integers(len(rig.teeth))), int(rng.integers(2))
        if word == "load":
            return Hidden(word=word, strength=float(rng.uniform(1.2, 2.0)))
        site = f"{('pinion', 'wheel')[side]}{stage + 1}"
        return (
            Hidden(word=word)
            if word == "nothing"
            else Hidden(word=word, site=site, stage=stage, side=side, strength=tooth)
        )
    word = ("nothing", "outer", "inner", "ball")[number % 4]
    bearing = int(rng.integers(len(rig.bearings)))
    return (
        Hidden(word=word)
        if word == "nothing"
        else Hidden(word=word, site=rig.bearings[bearing].name, bearing=bearing, strength=pit)
    )


def heard(rig: Rig, what: Hidden, rng: np.random.Generator) -> FloatArray:
    """Acceleration in m/s^2, (sensors, samples)."""
    count = int(rig.rate_hz * rig.seconds)
    time = np.arange(count) / rig.rate_hz
    turns = _turns(rig, time, rng)
    source = 0.03 * rng.standard_normal((len(rig.bearings), count))
    if what.word in ("outer", "inner", "ball"):
        source[what.bearing] += _blows(time, *_of_bearing(rig, what, turns[0], rng))
    if what.word == "tooth":
        own = turns[what.stage + what.side]
        at = np.arange(int(own[-1])) + 0.37
        size = 3.0 * what.strength * (1 + 0.2 * rng.standard_normal(at.size))
        source[min(what.stage + what.side, len(source) - 1)] += _blows(time, np.interp(at, own, time), size)
    load = what.strength if what.word == "load" else 1.0
    rows = []
    for sensor in range(rig.sensors):
        x = sum(_ring(s, m, rig.rate_hz) for s, m in zip(source, rig.modes[sensor], strict=True))
        x = x + sum(a * np.cos(2 * np.pi * k * turns[0] + sensor + k) for k, a in enumerate(rig.shaft[sensor], 1))
        x = x + rig.supply * np.cos(2 * np.pi * 100.0 * time + sensor) + rig.noise * _noise(rng, count)
        for stage in range(len(rig.teeth)):
            x = x + load * _mesh(rig, what, sensor, stage, turns)
        rows.append(x * (1 + GAIN * rng.standard_normal()))
    return np.array(rows)


def _turns(rig: Rig, time: FloatArray, rng: np.random.Generator) -> list[FloatArray]:
    """Of each shaft, (samples,)."""
    sway = sum(rng.uniform(0.2, 1.0) * np.sin(2 * np.pi * f * time + rng.uniform(0, 6)) for f in SWAY_HZ)
    speed = rig.speed_hz * (1 + rng.uniform(-LABEL, LABEL)) * (1 + rig.wander * sway / np.std(sway))
    turns = [np.cumsum(speed) / rig.rate_hz]
    for pinion, wheel in rig.teeth:
        turns.append(turns[-1] * pinion / wheel)
    return turns


def _of_bearing(rig: Rig, what: Hidden, turns: FloatArray, rng: np.random.Generator) -> tuple[FloatArray, FloatArray]:
    """(times, sizes) of the blows of a pit: an inner race is struck in the load zone, a ball as the cage carries it
    there, harder by one race."""
    bearing = rig.bearings[what.bearing]
    order = {"outer": bearing.outer, "inner": bearing.inner, "ball": bearing.ball}[what.word]
    order *= 1 + rng.uniform(*SLIP)
    steps = 1 + rig.jitter * rng.standard_normal(int(turns[-1] * order) + 2)
    at = (np.cumsum(steps) - rng.uniform()) / order
    at = at[(at > 0) & (at < turns[-1])]
    size = what.strength * (1 + 0.15 * rng.standard_normal(at.size))
    carried = {"inner": at, "ball": at * bearing.cage}.get(what.word)
    if carried is not None:
        size *= 0.15 + np.maximum(np.cos(2 * np.pi * carried), 0.0) ** 1.5
    if what.word == "ball":
        size *= 1 + 0.5 * (np.arange(at.size) % 2)
    return np.interp(at, turns, np.arange(turns.size) / rig.rate_hz), size


def _blows(time: FloatArray, at: FloatArray, size: FloatArray) -> FloatArray:
    """Impulses between samples, (samples,)."""
    place = at / time[1]
    first = np.minimum(place.astype(np.int64), time.size - 2)
    force = np.zeros(time.size)
    np.add.at(force, first, size * (1 - (place - first)))
    np.add.at(force, first + 1, size * (place - first))
    return force


def _ring(source: FloatArray, modes: FloatArray, rate_hz: float) -> FloatArray:
    """A source through a sensor's modes, and the roll-off before half the sampling rate."""
    hz = np.fft.rfftfreq(2 * source.size, 1 / rate_hz)
    path = np.zeros(hz.size, dtype=np.complex128)
    for share, damping, gain in modes:
        x = hz / (share * rate_hz)
        path += gain * x**2 / (1 - x**2 + 2j * damping * x)
    path /= 1 + (hz / (0.42 * rate_hz)) ** 8
    return np.asarray(np.fft.irfft(np.fft.rfft(source, 2 * source.size) * path)[: source.size])


def _noise(rng: np.random.Generator, count: int) -> FloatArray:
    """Louder at low frequencies, of unit size."""
    hz = np.maximum(np.arange(count // 2 + 1), 1.0)
    x = np.fft.irfft(np.fft.rfft(rng.standard_normal(count)) * hz**-0.2, count)
    return np.asarray(x / np.std(x))


def _mesh(rig: Rig, what: Hidden, sensor: int, stage: int, turns: list[FloatArray]) -> FloatArray:
    """Lines of a mesh that runout of both gears modulates, and a damaged tooth for the width of one."""
    pair = (turns[stage], turns[stage + 1])
    size = 1 + sum(r * np.cos(2 * np.pi * t + 1) for r, t in zip(rig.runout[stage], pair, strict=True))
    phase = 0.5 * rig.runout[stage, 0] * np.cos(2 * np.pi * pair[0])
    if what.word == "tooth" and what.stage == stage:
        away = np.mod(pair[what.side], 1.0) - 0.37
        tooth = np.exp(-0.5 * (away * rig.teeth[stage][what.side] / 0.7) ** 2)
        size, phase = size - 0.5 * what.strength * tooth, phase + 0.4 * what.strength * tooth
    angle = 2 * np.pi * rig.teeth[stage][0] * pair[0] + phase
    return np.asarray(
        size * sum(rig.mesh[sensor, stage, k - 1] * np.cos(k * angle + sensor * k) for k in range(1, LINES + 1))
    )
