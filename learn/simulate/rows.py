"""Recordings of drawn machines: motion, its fault, the chain, and whether the fault shows at all."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy import fft

from learn.orders import FaultOrders, from_geometry
from learn.simulate.background import free_axis, knocks, log_uniform, rolling_noise
from learn.simulate.chain import RATES_HZ, drawn_chain
from learn.simulate.machines import BALLS, CLASSES, FAST_S, SLOW_S, Drawn, draw
from signals.sensors.measure import measure
from signals.sensors.motion import Motion, motion_of
from signals.series import FloatArray
from sim.core.response import Response
from sim.parts.bearing.from_spec import geometry_from_spec
from sim.solve.ensemble import Member, simulate_many
from sim.solve.settings import Settings

MOTION_RATE_HZ = 48_000.0
SETTLED_S = 0.15
OUTPUTS = ("bearing1.outer.x.acceleration", "bearing1.outer.y.acceleration")
PER_BATCH = 2
SINGLE = 13
"""Batch whose kind of machine stands for all where nothing is spread: nine balls, above 22 Hz."""
STILL = 1e-6
"""RMS acceleration, m/s^2, below which the measured bearing carries nothing."""
BANDS = 16
SHOWS = 0.3
"""Share that the fault's own power must have in some band over what the sound machine and the noise have there."""


@dataclass(frozen=True, kw_only=True)
class Variant:
    """What of the recipe is switched on: the measurement chain (with what real bearings add), the spread of machines."""

    chain: bool = True
    spread: bool = True


@dataclass(frozen=True, kw_only=True)
class Row:
    """One simulated recording; `clear_db`: the fault's power over the background in its best band, dB."""

    machine: int
    label: str
    samples: FloatArray
    rate_hz: float
    speed_hz: float
    orders: FaultOrders
    width_m: float
    clear_db: float


FULL = Variant()


def batch_plan(index: int) -> tuple[int, bool]:
    """(balls, fast) of batch `index`."""
    return BALLS[index % len(BALLS)], (index // len(BALLS)) % 3 != 0


def rows(seed: int, batches: Sequence[int], variant: Variant = FULL) -> Iterator[Row]:
    """Rows of these batches of two machines."""
    for batch in batches:
        balls, fast = batch_plan(batch if variant.spread else SINGLE)
        numbers = [PER_BATCH * batch + k for k in range(PER_BATCH)]
        drawn = [draw(seed, n, balls, fast, spread=variant.spread) for n in numbers]
        members = [Member(machine=m, seed=d.seed) for d in drawn for m in d.machines]
        found = simulate_many(
            members,
            duration_s=FAST_S if fast else SLOW_S,
            output_rate_hz=MOTION_RATE_HZ,
            channels=OUTPUTS,
            settings=Settings(estimate_error=False),
        )
        for k, (number, one) in enumerate(zip(numbers, drawn, strict=True)):
            four = found[len(CLASSES) * k : len(CLASSES) * (k + 1)]
            responses = [r for r in four if isinstance(r, Response)]
            if len(responses) == len(CLASSES):
                yield from _measured(number, one, responses, np.random.default_rng([seed, number, 1]), variant.chain)


def _measured(
    number: int, drawn: Drawn, responses: Sequence[Response], rng: np.random.Generator, chain: bool
) -> Iterator[Row]:
    motions = [motion_of(r) for r in responses]
    operating = motions[0].recording.operating
    assert operating is not None
    rms = float(np.std(motions[0].recording.samples[:, int(SETTLED_S * MOTION_RATE_HZ) :]))
    if rms < STILL:
        return
    orders = from_geometry(geometry_from_spec(drawn.machines[0].bearings[0]))
    rate = float(rng.choice(RATES_HZ)) if chain else MOTION_RATE_HZ
    if chain:
        level = _level(motions, rms, rng)
        motions = _in_life(motions, orders, operating.speed_hz, level, rng)
        links = drawn_chain(rng, level, rate)
        recorded = [measure(motion, links, seed=drawn.seed).recording.samples[0] for motion in motions]
    else:
        recorded = [motion.recording.samples[1] for motion in motions]
    settled = [r[int(SETTLED_S * rate) :] for r in recorded]
    for label, width, samples in zip(CLASSES, drawn.widths_m, settled, strict=True):
        clear = 0.0 if label == CLASSES[0] else visible_db(settled[0], samples)
        if label != CLASSES[0] and clear < 10 * np.log10(SHOWS):
            continue
        yield Row(
            machine=number,
            label=label,
            samples=samples,
            rate_hz=rate,
            speed_hz=operating.speed_hz,
            orders=orders,
            width_m=width,
            clear_db=clear,
        )


def _level(motions: Sequence[Motion], rms: float, rng: np.random.Generator) -> float:
    """Level that background and noise are drawn around, m/s^2: between what the sound machine moves and what the
    faults add (their median), so that clear and buried faults are both common."""
    sound = motions[0].recording.samples
    added = float(np.median([np.std(m.recording.samples - sound) for m in motions[1:]]))
    share = rng.random()
    return float(rms ** (1 - share) * max(added, rms) ** share)


def _in_life(
    motions: Sequence[Motion], orders: FaultOrders, speed_hz: float, level: float, rng: np.random.Generator
) -> list[Motion]:
    """The same background for all four; the ball's spall on a ball whose axis is free."""
    sound = motions[0].recording.samples
    angle = motions[0].angle_rad("input")
    ground = level * log_uniform(rng, 0.03, 3.0) * rolling_noise(rng, angle, orders)
    ground = ground + level * log_uniform(rng, 0.1, 3.0) * knocks(rng, sound.shape[1], MOTION_RATE_HZ)
    found = []
    for label, motion in zip(CLASSES, motions, strict=True):
        added = motion.recording.samples - sound
        if label == "ball":
            added = free_axis(rng, added, MOTION_RATE_HZ, 0.5 * orders.ball * speed_hz, orders.cage * speed_hz)
        found.append(replace(motion, recording=replace(motion.recording, samples=sound + ground + added)))
    return found


def visible_db(sound: FloatArray, faulty: FloatArray) -> float:
    """Power the fault adds over the sound recording's (noise included), in the best of equal bands, dB.

    The two recordings share machine, chain and noise, so their difference is the fault's own.
    """
    own = np.abs(fft.rfft(faulty - sound)) ** 2
    ground = np.abs(fft.rfft(sound - np.mean(sound))) ** 2
    edges = np.linspace(1, own.size, BANDS + 1).astype(int)[:-1]
    ratio = np.add.reduceat(own, edges) / np.maximum(np.add.reduceat(ground, edges), 1e-300)
    return float(10 * np.log10(np.max(ratio) + 1e-12))

