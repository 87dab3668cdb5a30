"""A machine's motion with what sounds beside its model."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from sideband_datasets.make.about import bearing_at
from sideband_datasets.plan.drawing import Drawing
from sideband_datasets.plan.ground import Ground, Noise
from signals.background import Carrier, free_axis, knocks, rolling_noise, trains
from signals.sensors import Motion, motion_of
from signals.sensors.shafts import shaft_named
from signals.series import FloatArray
from sim.assembly.kinematics import shaft_of
from sim.core.errors import SidebandError
from sim.core.response import Response
from sim.core.spec import MachineSpec
from sim.core.speed import warped_times

BALL = "ball_spall"
LEAST = 1e-9
"""RMS acceleration, m/s^2, below which a machine stands still: nothing can be relative to it."""
BASES = {"outer": ("f_o", 1.0), "inner": ("f_i", 1.0), "ball": ("f_b", 2.0), "cage": ("f_c", 1.0)}
"""Ingredient to base frequency of its bearing and multiple of it."""


class StandsStill(SidebandError):
    """A machine without motion, which no background can be drawn around."""


@dataclass(frozen=True, kw_only=True)
class Heard:
    """A motion with its background; `level`: RMS acceleration that the background is drawn around, m/s^2."""

    motion: Motion
    level: float


def heard(response: Response, sound: Response, drawn: Drawing, ground: Ground, settle_s: float) -> Heard:
    """The motion of `response` and what sounds beside it; `sound` is the same machine without the fault.

    Accelerations in x and y get it, at every part alike but for the rolling noise, which each part has its own of.
    StandsStill for a machine whose parts do not move at all.
    """
    rows = _moving(response)
    level = ground.level * _rms(sound, rows, settle_s)
    if not level > LEAST:
        message = "without the fault the parts that are measured do not move in x or y: they carry nothing"
        raise StandsStill(f"{message}, and no level can be relative to their motion")
    samples = np.array(sound.signals, dtype=np.float64)
    samples += _added(response, sound, drawn, ground)
    for part, axis, row in rows:
        samples[row] += level * _beside(response, drawn, ground, part)[axis]
    motion = motion_of(response)
    return Heard(motion=replace(motion, recording=replace(motion.recording, samples=samples)), level=level)


def _moving(response: Response) -> list[tuple[str, int, int]]:
    """(part, 0 for x and 1 for y, row) of every acceleration in the plane of the shaft's section."""
    return [
        (channel.location, "xy".index(channel.axis), row)
        for row, channel in enumerate(response.channels)
        if channel.quantity == "acceleration" and channel.axis in ("x", "y")
    ]


def _rms(sound: Response, rows: list[tuple[str, int, int]], settle_s: float) -> float:
    first = round(settle_s * sound.sampling_rate_hz)
    found = [float(np.var(sound.signals[row, first:])) for _, _, row in rows]
    return math.sqrt(float(np.mean(found))) if found else 0.0


def _added(response: Response, sound: Response, drawn: Drawing, ground: Ground) -> FloatArray:
    """What the fault adds to every channel, (channels, n)."""
    found: FloatArray = np.asarray(response.signals - sound.signals, dtype=np.float64)
    if ground.axis is None or not drawn.effects or any(effect.term != BALL for effect in drawn.effects):
        return found
    number = [bearing.name for bearing in drawn.spec.bearings].index(drawn.effects[0].site) + 1
    return free_axis(
        np.random.default_rng([drawn.noise_seed, *b"axis"]),
        found,
        response.sampling_rate_hz,
        cage_s=1.0 / response.bases_hz[f"f_c{number}"],
        stay_s=ground.axis.stay_s,
        slip_s=ground.axis.slip / response.bases_hz[f"f_b{number}"],
        inside=ground.axis.inside,
    )


def _beside(response: Response, drawn: Drawing, ground: Ground, part: str) -> FloatArray:
    """Everything beside the model at a part, in levels, (2, n)."""
    samples, rate = response.signals.shape[1], response.sampling_rate_hz
    found = np.zeros((2, samples))
    if ground.rolling is not None:
        rng = np.random.default_rng([drawn.noise_seed, *b"rolling", *part.encode()])
        carriers = list(_carriers(rng, response, drawn.spec, ground.rolling, part))
        found += ground.rolling.level * rolling_noise(rng, samples, carriers)
    if ground.knocks is not None:
        level, per_s = ground.knocks
        found += level * knocks(np.random.default_rng([drawn.noise_seed, *b"knocks"]), samples, rate, per_s)
    if ground.neighbours is not None and drawn.spec.operating is not None:
        level, others = ground.neighbours
        speed = drawn.spec.operating.speed_hz
        rng = np.random.default_rng([drawn.noise_seed, *b"neighbours"])
        found += level * trains(rng, samples, rate, [replace(one, per_s=one.per_s * speed) for one in others])
    return found


def _carriers(
    rng: np.random.Generator, response: Response, machine: MachineSpec, noise: Noise, part: str
) -> Iterator[Carrier]:
    """What the noise at a part follows: shaft and balls of its bearing."""
    if machine.operating is None:
        return
    turns = warped_times(response.speed, np.arange(response.signals.shape[1]) / response.sampling_rate_hz)[0]
    bearing = bearing_at(machine, part)
    driven = _shaft_hz(response, machine, machine.operating.shaft)
    found = {"shaft": driven, "twice_shaft": 2 * driven, "foreign": noise.foreign_order * driven}
    if bearing is not None:
        number = [b.name for b in machine.bearings].index(bearing) + 1
        own = _shaft_hz(response, machine, shaft_of(machine, machine.bearings[number - 1].body))
        found |= {"shaft": own, "twice_shaft": 2 * own}
        for name, (base, multiple) in BASES.items():
            if f"{base}{number}" in response.bases_hz:
                found[name] = multiple * response.bases_hz[f"{base}{number}"]
    for name, hz in found.items():
        phase = np.asarray(2 * math.pi * hz * turns + rng.uniform(0.0, 2 * math.pi), dtype=np.float64)
        yield Carrier(phase_rad=phase, depth=noise.depths[name])


def _shaft_hz(response: Response, machine: MachineSpec, shaft: str | None) -> float:
    """Turns a second of a shaft; of one that does not turn, none."""
    if shaft is None:
        return 0.0
    return response.bases_hz.get(f"f_r{shaft_named(machine, shaft, 'shaft')[0]}", 0.0)
