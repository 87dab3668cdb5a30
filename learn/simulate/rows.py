"""Recordings to train on: the dataset's machines, heard through a drawn chain, without faults that nothing shows."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from learn.orders import FaultOrders, from_geometry
from learn.simulate.background import free_axis, knocks, log_uniform, neighbours, rolling_noise, warped
from learn.simulate.chain import RATES_HZ, drawn_chain
from learn.simulate.machines import BEARINGS, CLASSES, RATE_HZ, SETTLE_S, recipe
from learn.simulate.visible import SHOWS_DB, visible_db
from sideband_datasets import make_plan
from sideband_datasets import rows as dataset_rows
from signals.recording import Recording
from signals.sensors.measure import measure
from signals.sensors.motion import Motion
from signals.series import FloatArray
from sim.core.response import Channel
from sim.parts.bearing.from_spec import geometry_from_spec

SHARE_FAST = 2 / 3
AT_ONCE = 8
"""Machines simulated and held at once."""
HEARINGS = 2
"""Chains and backgrounds drawn for each machine."""
STILL = 1e-6
"""RMS acceleration, m/s^2, below which the measured bearing carries nothing."""


@dataclass(frozen=True, kw_only=True)
class Variant:
    """What of the recipe is on.

    `chain`: structure, fastening, noise, hum, filter, converter and a drawn rate; without it the ring's motion in y is
    taken as it is. `background`: rolling noise, knocks, neighbours, wander of the speed and a ball's free axis.
    `spread`: of the machines. Without chain and background each machine is heard once, as nothing is left to draw.
    """

    chain: bool = True
    background: bool = True
    spread: bool = True

    @property
    def hearings(self) -> int:
        """How often each machine is heard."""
        return HEARINGS if self.chain or self.background else 1


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


@dataclass(frozen=True, kw_only=True)
class _Four:
    """The recordings of one machine: motion of the ring (2, n) by class, spall lengths."""

    number: int
    speed_hz: float
    orders: FaultOrders
    motions: dict[str, FloatArray]
    widths_m: dict[str, float]


FULL = Variant()


def _size(count: int, fast: bool) -> int:
    return round(count * (SHARE_FAST if fast else 1 - SHARE_FAST))


def rows(count: int, seed: int, part: int, parts: int, variant: Variant = FULL) -> Iterator[Row]:
    """Rows of every `parts`-th machine of a dataset of about `count`, from `part` on."""
    for fast in (True, False):
        for four in _fours(count, seed, fast, part, parts, variant):
            for hearing in range(variant.hearings):
                key = [seed, int(fast), four.number, *([hearing] if hearing else [])]
                yield from _heard(four, np.random.default_rng(key), variant)


def _fours(count: int, seed: int, fast: bool, part: int, parts: int, variant: Variant) -> Iterator[_Four]:
    """Machines one after the other; those of a family lie together, so that they fill the lanes."""
    recorded = recipe(_size(count, fast), fast=fast, seed=seed, spread=variant.spread)
    plan = make_plan(recorded)
    numbers = sorted(range(part, len(plan.machines), parts), key=lambda m: plan.machines[m].family)
    size = plan.rows_per_recording
    for first in range(0, len(numbers), AT_ONCE):
        chosen = numbers[first : first + AT_ONCE]
        wanted = [int(r) * size + c for m in chosen for r in np.flatnonzero(plan.machine == m) for c in range(size)]
        found = {row.row: row for row in dataset_rows(recorded, wanted, failed=_left_out)}
        for m in chosen:
            motions: dict[str, FloatArray] = {}
            widths: dict[str, float] = {}
            speed = 0.0
            for r in np.flatnonzero(plan.machine == m):
                channels = [found.get(int(r) * size + c) for c in range(size)]
                if any(c is None for c in channels):
                    continue
                kept = [c for c in channels if c is not None]
                motions[kept[0].fault_type] = np.stack([c.signal.astype(np.float64) for c in kept])
                widths[kept[0].fault_type] = kept[0].fault_severity or 0.0
                speed = float(kept[0].speed_hz or 0.0)
            if CLASSES[0] in motions and float(np.std(motions[CLASSES[0]])) > STILL:
                bearing = next(b for b in plan.machines[m].spec.bearings if b.name == BEARINGS[0])
                number = 2 * m + int(fast)
                orders = from_geometry(geometry_from_spec(bearing))
                yield _Four(number=number, speed_hz=speed, orders=orders, motions=motions, widths_m=widths)


def _left_out(failure: object) -> None:
    """A recording that could not be simulated: its machine has one class fewer."""


def _heard(four: _Four, rng: np.random.Generator, variant: Variant) -> Iterator[Row]:
    rate = float(rng.choice(RATES_HZ)) if variant.chain else RATE_HZ
    bare = {label: motion[1] for label, motion in four.motions.items()}
    recorded = _recorded(four, rate, rng, variant) if variant.chain or variant.background else bare
    sound = recorded[CLASSES[0]]
    for label, samples in recorded.items():
        clear = 0.0 if label == CLASSES[0] else visible_db(sound, samples)
        if label == CLASSES[0] or clear >= SHOWS_DB:
            yield Row(
                machine=four.number,
                label=label,
                samples=samples,
                rate_hz=rate,
                speed_hz=four.speed_hz,
                orders=four.orders,
                width_m=four.widths_m[label],
                clear_db=clear,
            )


def _recorded(four: _Four, rate_hz: float, rng: np.random.Generator, variant: Variant) -> dict[str, FloatArray]:
    """All recordings through one chain, with one background and one wander of the speed."""
    level = _level(four, rng)
    ground = _ground(four, level, rng) if variant.background else None
    links = drawn_chain(rng, level, rate_hz) if variant.chain else None
    motions = four.motions if ground is None else _as_it_turns(four, ground, rng)
    settled = int(SETTLE_S * rate_hz)
    if links is None:
        return {label: motion[1, settled:] for label, motion in motions.items()}
    return {
        label: measure(motion_of_ring(motion), links, seed=four.number).recording.samples[0][settled:]
        for label, motion in motions.items()
    }


def _ground(four: _Four, level: float, rng: np.random.Generator) -> FloatArray:
    """What sounds beside the model of the machine, m/s^2, shape (2, n): the same in all its recordings."""
    count = four.motions[CLASSES[0]].shape[1]
    angle = np.asarray(2 * np.pi * four.speed_hz / RATE_HZ * np.arange(count), dtype=np.float64)
    ground = level * log_uniform(rng, 0.03, 3.0) * rolling_noise(rng, angle, four.orders)
    ground = ground + level * log_uniform(rng, 0.1, 3.0) * knocks(rng, count, RATE_HZ)
    return ground + level * log_uniform(rng, 0.03, 1.5) * neighbours(rng, count, RATE_HZ, four.speed_hz)


def _as_it_turns(four: _Four, ground: FloatArray, rng: np.random.Generator) -> dict[str, FloatArray]:
    """Motions with that ground, one wander of the speed, and a ball whose axis is free."""
    sound = four.motions[CLASSES[0]]
    wander = (log_uniform(rng, 1e-4, 4e-3), log_uniform(rng, 0.1, 2.0), int(rng.integers(2**31)))
    free = np.random.default_rng(int(rng.integers(2**31)))
    found = {}
    for label in CLASSES:
        if label not in four.motions:
            continue
        added = four.motions[label] - sound
        if label == "ball":
            spin, cage = 0.5 * four.orders.ball * four.speed_hz, four.orders.cage * four.speed_hz
            added = free_axis(free, added, RATE_HZ, spin, cage)
        found[label] = warped(sound + ground + added, RATE_HZ, *wander)
    return found


def _level(four: _Four, rng: np.random.Generator) -> float:
    """Level that background and noise are drawn around, m/s^2: between what the sound machine moves and what the
    faults add (their median), so that clear and buried faults are both common."""
    sound = four.motions[CLASSES[0]]
    rms = float(np.std(sound))
    others: Sequence[FloatArray] = [m for label, m in four.motions.items() if label != CLASSES[0]]
    added = float(np.median([np.std(m - sound) for m in others])) if others else rms
    share = rng.random()
    return float(rms ** (1 - share) * max(added, rms) ** share)


def motion_of_ring(samples: FloatArray, rate_hz: float = RATE_HZ) -> Motion:
    """Accelerations (2, n) of a ring in x and y, as a measurement chain takes them."""
    channels = tuple(
        Channel(name=f"ring.{axis}.acceleration", quantity="acceleration", unit="m/s^2", location="ring", axis=axis)
        for axis in ("x", "y")
    )
    return Motion(recording=Recording(sampling_rate_hz=rate_hz, channels=channels, samples=samples, origin="simulated"))
