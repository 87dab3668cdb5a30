"""Gear recordings to train on: simulated pairs heard at one to four places, without faults that nothing shows."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from learn.gears.angle import mesh_angle
from learn.gears.turns import Turns, finer, turns_of
from learn.orders import of_ratio
from learn.simulate.background import knocks, log_uniform, neighbours, rolling_noise, warped
from learn.simulate.chain import drawn_chain, motion_of_ring
from learn.simulate.gears import FAULTS, GEARS, HEALTHY, RATE_HZ, SETTLE_S, SOUND, TOOTH, recipe
from learn.simulate.other_gears import modulation, other_mesh, twist_rad
from learn.simulate.tooth_shows import SHOWS_DB, tooth_db
from sideband_datasets import Recipe
from sideband_datasets.make.stream import rows_of
from sideband_datasets.plan.tried import plan_again
from signals.sensors.measure import measure
from signals.series import FloatArray

SHARE_FAST = 2 / 3
AT_ONCE = 8
HEARINGS = 3
RATES_HZ = (12_800.0, 20_000.0, 25_600.0)
CHANNELS = (1, 1, 2, 3, 4)
"""How many channels a hearing has, each as likely."""
STILL = 1e-6
ROLLING = of_ratio(9, 0.2)
"""A bearing on the driving shaft, whose rolling noise is modulated."""


@dataclass(frozen=True, kw_only=True)
class GearRow:
    """One simulated recording of a gear pair; `channels` (c, n); `place` is the damaged gear's number, or None."""

    machine: int
    label: str
    fault: str
    channels: FloatArray
    rate_hz: float
    speed_hz: float
    teeth: tuple[int, int]
    place: int | None
    clear_db: float


@dataclass(frozen=True, kw_only=True)
class _Four:
    """The recordings of one machine: motion of both gears (4, n) by fault, the damaged gear of each."""

    number: int
    speed_hz: float
    teeth: tuple[int, int]
    motions: dict[str, FloatArray]
    places: dict[str, int]


def gear_rows(count: int, seed: int, part: int, parts: int) -> Iterator[GearRow]:
    """Rows of every `parts`-th group of machines of a dataset of about `count`, from `part` on."""
    for fast in (True, False):
        share = SHARE_FAST if fast else 1 - SHARE_FAST
        recorded = recipe(round(count * share), fast=fast, seed=seed)
        for four in _fours(recorded, part, parts, fast):
            for hearing in range(HEARINGS):
                yield from _heard(four, np.random.default_rng([seed, int(fast), four.number, hearing]))


def _fours(recorded: Recipe, part: int, parts: int, fast: bool) -> Iterator[_Four]:
    """Machines one after the other; those with the same teeth are simulated together."""
    plan = plan_again(recorded)  # drawn by this program, so nothing has to be tried first
    names = [plan.recipe.machines[f].name for f in plan.family.tolist()]
    families = sorted(set(names))[part::parts]
    size = plan.rows_per_recording
    for family in families:
        chosen = [m for m, name in enumerate(names) if name == family]
        wanted = [int(r) * size + c for m in chosen for r in np.flatnonzero(plan.machine == m) for c in range(size)]
        found = {row.row: row for row in rows_of(plan, wanted, failed=_left_out)}
        for m in chosen:
            spec = plan.machines[m].spec
            motions: dict[str, FloatArray] = {}
            places: dict[str, int] = {}
            for r in np.flatnonzero(plan.machine == m):
                channels = [found.get(int(r) * size + c) for c in range(size)]
                kept = [c for c in channels if c is not None]
                if len(kept) == size:
                    motions[kept[0].fault_type] = np.stack([c.signal.astype(np.float64) for c in kept])
                    places[kept[0].fault_type] = GEARS.index(kept[0].fault_location or GEARS[0])
            if SOUND in motions and float(np.std(motions[SOUND])) > STILL and spec.operating is not None:
                teeth = {g.name: g.teeth for g in spec.gears}
                yield _Four(
                    number=2 * m + int(fast),
                    speed_hz=spec.operating.speed_hz,
                    teeth=(teeth[GEARS[0]], teeth[GEARS[1]]),
                    motions=motions,
                    places=places,
                )


def _left_out(failure: object) -> None:
    """A recording that could not be simulated: its machine has one fault fewer."""


def _heard(four: _Four, rng: np.random.Generator) -> Iterator[GearRow]:
    """All recordings through the same chains, with the same background and wander; the sound one only where some fault
    shows beside it, or else a quiet background alone would speak for a fault."""
    rate = float(rng.choice(RATES_HZ))
    recorded = _recorded(four, rate, rng)
    sound = recorded.pop(SOUND)
    angle = mesh_angle(list(sound), rate, four.speed_hz, four.teeth[0])
    shown = {}
    for fault, channels in recorded.items():
        clear = max(tooth_db(*both) for both in _turned(four, four.places[fault], angle, sound, channels))
        if clear >= SHOWS_DB:
            shown[fault] = (TOOTH, channels, four.places[fault], clear)
    if not shown:
        return
    for fault, (label, channels, place, clear) in {SOUND: (HEALTHY, sound, None, 0.0), **shown}.items():
        yield GearRow(
            machine=four.number,
            label=label,
            fault=fault,
            channels=channels,
            rate_hz=rate,
            speed_hz=four.speed_hz,
            teeth=four.teeth,
            place=place,
            clear_db=clear,
        )


def _turned(
    four: _Four, place: int, angle_rad: FloatArray, sound: FloatArray, faulty: FloatArray
) -> Iterator[tuple[Turns, Turns]]:
    """Turns of the damaged gear, channel by channel, without and with the fault."""
    for pair in zip(sound, faulty, strict=True):
        one, other = (turns_of(finer(row), angle_rad, four.teeth, place) for row in pair)
        yield one, other


def _recorded(four: _Four, rate_hz: float, rng: np.random.Generator) -> dict[str, FloatArray]:
    sound = four.motions[SOUND]
    samples = sound.shape[1]
    angle = np.asarray(2 * np.pi * four.speed_hz / RATE_HZ * np.arange(samples), dtype=np.float64)
    ratio = four.teeth[0] / four.teeth[1]
    level = float(np.sqrt(np.mean(sound**2)))
    ground = level * log_uniform(rng, 0.01, 1.0) * rolling_noise(rng, angle, ROLLING)
    ground = ground + level * log_uniform(rng, 0.01, 1.0) * knocks(rng, samples, RATE_HZ)
    ground = ground + level * log_uniform(rng, 0.01, 1.0) * neighbours(rng, samples, RATE_HZ, four.speed_hz)
    ground = ground + level * log_uniform(rng, 0.01, 2.0) * other_mesh(rng, angle, ratio, RATE_HZ)
    twist = twist_rad(rng, angle, ratio) / (2 * np.pi * four.speed_hz) * RATE_HZ
    wander = (log_uniform(rng, 1e-4, 4e-3), log_uniform(rng, 0.1, 2.0), int(rng.integers(2**31)))
    heard = int(rng.choice(CHANNELS))
    weights = rng.beta(0.5, 0.5, heard)
    others = [np.exp(rng.normal(0.0, 1.0)) for _ in range(heard)]
    gains = [modulation(rng, angle, ratio) for _ in range(heard)]
    links = [drawn_chain(rng, level, rate_hz) for _ in range(heard)]
    at = np.clip(np.arange(samples) + twist, 0, samples - 1)
    settled = int(SETTLE_S * rate_hz)
    found = {}
    for fault in (SOUND, *(str(f["name"]) for f in FAULTS[1:])):
        if fault not in four.motions:
            continue
        moved = np.stack([np.interp(at, np.arange(samples), row) for row in four.motions[fault]])
        both = warped(np.concatenate([moved, ground]), RATE_HZ, *wander)
        rows = []
        for c in range(heard):
            gears = weights[c] * both[:2] + (1 - weights[c]) * both[2:4]
            motion = gains[c] * gears + others[c] * both[4:]
            rows.append(measure(motion_of_ring(motion, RATE_HZ), links[c], seed=four.number).recording.samples[0])
        found[fault] = np.stack(rows)[:, settled:]
    return found
