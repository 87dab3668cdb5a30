"""Small atlases that stand beside tests: what one was made for, and whether that is still so.

Its stamp is compared by numbers of nine digits: the last bits of exponentials differ between processors, and the name
under which the engine looks for an atlas differs with them. So the engine gets the file under today's name. To be small
it holds the channels of the test's sensors only, to 12 bits (0.002 dB); the engine does not look at the others.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from reconcile.atlas.bank import ARRAYS, Bank, Mapper, make_bank, run_task, tasks
from reconcile.atlas.candidates import Candidate
from reconcile.atlas.keep import ATLAS_VERSION, atlas_key
from reconcile.atlas.places import simulated_channel, standard_channels
from reconcile.atlas.plan import AtlasPlan, Point, atlas_plan, with_tooth_pairs
from reconcile.calibrate.uncertain import uncertain_numbers
from reconcile.machine.local import LANES
from signals.series import FloatArray
from sim.core.response import Channel
from sim.core.spec import MachineSpec
from sim.version import PHYSICS_VERSION
from store.atlas import AtlasFolder

BITS = 12
STEP_RAD = 1.0 / 128.0
"""Of a phase, 0.07 dB."""
REMAKE = "make it again with `make tests-atlas` (some minutes), look at the verdicts and commit the files"
SAME_DB = 0.1
"""Median deviation from the stored levels; other last bits of a processor change far less."""


@dataclass(frozen=True, kw_only=True)
class Wanted:
    """What the engine asks for, and the file in which it stands."""

    bank: Path
    plan: AtlasPlan
    point: Point
    channels: tuple[str, ...]
    stored: tuple[int, ...]
    """Numbers of the channels that are kept."""

    @property
    def stamp(self) -> Path:
        """Beside the atlas."""
        return self.bank.with_suffix(".json")

    @property
    def key(self) -> str:
        """The engine's name for it."""
        return atlas_key(self.plan, self.point, self.channels)

    def made_for(self) -> dict[str, object]:
        """Versions, and a hash of all numbers that go in."""
        document = [
            self.plan.machine.model_dump(mode="json"),
            [[n.label for n in self.plan.numbers], [o.values.tolist() for o in (*self.plan.offsets, *self.plan.twins)]],
            [d.term.model_dump() for d in self.plan.draws if d.term is not None],
            [self.point.speed_hz, self.point.torque_ratio, *self.channels, *self.stored],
        ]
        text = json.dumps(_rounded(document), sort_keys=True)
        return {
            "physics_version": PHYSICS_VERSION,
            "atlas_version": ATLAS_VERSION,
            "draws": len(self.plan.draws),
            "numbers": hashlib.sha256(text.encode()).hexdigest()[:32],
        }


def _rounded(value: object) -> object:
    if isinstance(value, float):
        return f"{value:.9g}"
    if isinstance(value, dict):
        return {k: _rounded(v) for k, v in value.items()}
    return [_rounded(v) for v in value] if isinstance(value, (list, tuple)) else value


def wanted(
    machine: MachineSpec, nominated: Sequence[Candidate], sensors: Sequence[str], speed_hz: float, bank: Path
) -> Wanted:
    """As the engine plans it: seed 0, both axes at every bearing; `sensors` are place and axis, `bearing1.y`."""
    paired = with_tooth_pairs(machine)
    channels = standard_channels(machine, ())
    return Wanted(
        bank=bank,
        plan=atlas_plan(paired, uncertain_numbers(paired), nominated, seed=0),
        point=Point(speed_hz=speed_hz),
        channels=channels,
        stored=tuple(channels.index(_simulated(machine, sensor)) for sensor in sensors),
    )


def _simulated(machine: MachineSpec, sensor: str) -> str:
    place, axis = sensor.split(".")
    recorded = Channel(name=sensor, quantity="acceleration", unit="m/s^2", location=place, axis=axis)
    return simulated_channel(machine, recorded) or ""


def make(now: Wanted, mapper: Mapper = map) -> str:
    """Simulate and write the atlas and its stamp; says what was written."""
    bank = make_bank(now.plan, now.point, now.channels, mapper)
    now.bank.parent.mkdir(exist_ok=True)
    now.bank.write_bytes(slim(bank, now.stored).to_bytes())
    now.stamp.write_text(json.dumps(now.made_for(), indent=1) + "\n", encoding="utf-8")
    alive = int(bank.alive.sum())
    return f"{now.bank}: {alive} of {len(now.plan.draws)} machines, {now.bank.stat().st_size / 1e3:.0f} kB"


def slim(bank: Bank, stored: tuple[int, ...]) -> Bank:
    """The channels kept, to so many bits."""
    few = bank.at(range(bank.alive.size), stored)
    levels = {name: _to_bits(getattr(few, name)) for name in ARRAYS if name != "phase"}
    return replace(few, phase=_to_steps(few.phase), **levels)


def _to_bits(values: FloatArray) -> FloatArray:
    mantissa, exponent = np.frexp(values)
    return np.ldexp(np.round(mantissa * 2.0**BITS) / 2.0**BITS, exponent)


def _to_steps(phases: FloatArray) -> FloatArray:
    """Against the first kept channel's, which nothing but differences is read from."""
    turned = np.angle(np.exp(1j * (phases - phases[:, :1])))
    return np.asarray(np.round(turned / STEP_RAD) * STEP_RAD)


def whole(bank: Bank, now: Wanted) -> Bank:
    """With channels of nothing where none were kept."""
    found = {}
    for name in ARRAYS:
        few = getattr(bank, name)
        found[name] = np.full((few.shape[0], len(now.channels), *few.shape[2:]), np.nan)
        found[name][:, now.stored] = few
    return replace(bank, **found)


def stale(now: Wanted) -> str | None:
    """Why the stored atlas cannot be used, or None."""
    if not (now.bank.exists() and now.stamp.exists()):
        return f"there is no {now.bank.name} in {now.bank.parent}/: {REMAKE}"
    made_for, today = json.loads(now.stamp.read_text(encoding="utf-8")), now.made_for()
    differing = [f"{k} was {made_for.get(k)}, is {today[k]}" for k in today if made_for.get(k) != today[k]]
    return f"the small atlas {now.bank.name} is out of date ({'; '.join(differing)}): {REMAKE}" if differing else None


def deviation_db(now: Wanted, task: int) -> dict[str, float]:
    """Median deviation of levels simulated today from the stored ones, for one task of the plan: as many of its
    machines as vector lanes hold."""
    chosen = tasks(now.plan, now.point, now.channels)[task]
    chosen = replace(chosen, draws=chosen.draws[:LANES])
    bank = Bank.from_bytes(now.bank.read_bytes()).at(chosen.draws, range(len(now.stored)))
    places = list(now.stored)
    today = run_task(chosen)
    found = {}
    for name in ("line", "floor", "band"):
        rows = [(getattr(one, name)[places], kept) for one, kept in zip(today, getattr(bank, name), strict=True) if one]
        fresh, kept = (np.concatenate([r[k].ravel() for r in rows]) for k in (0, 1))
        both = (fresh > 0) & (kept > 0)
        found[name] = float(np.median(np.abs(20 * np.log10(fresh[both] / kept[both]))))
    return found


class Kept(AtlasFolder):
    """A folder with stored atlases under today's names; that the engine simulates another one is a failure."""

    def put(self, key: str, data: bytes) -> None:
        """Nothing but the stored atlases is used."""
        raise AssertionError(f"the engine asked for an atlas that is not kept, {key}: {REMAKE}")


def kept(several: Sequence[Wanted], folder: Path) -> Kept:
    """The stored atlases as the engine finds them."""
    for now in several:
        AtlasFolder(folder).put(now.key, whole(Bank.from_bytes(now.bank.read_bytes()), now).to_bytes())
    return Kept(folder)
