"""An atlas is made once for a machine, an operating point and a set of sensors, and kept under a name that says so."""

from __future__ import annotations

import hashlib
import json
import zipfile
import zlib
from collections.abc import Callable
from typing import Protocol

from reconcile.atlas.bank import Bank, Mapper, make_bank
from reconcile.atlas.plan import AtlasPlan, Point
from reconcile.observe.watch import bases_at, watch_list
from sim.core.errors import Problem, SpecError
from sim.version import PHYSICS_VERSION

ATLAS_VERSION = 8


class Keeper(Protocol):
    """Where atlases are kept between runs."""

    def get(self, key: str) -> bytes | None:
        """The stored bytes, or None."""

    def put(self, key: str, data: bytes) -> None:
        """Store; the whole of it or nothing is ever seen."""


class Forgetful:
    """Keeps nothing: every run makes its own."""

    def get(self, key: str) -> bytes | None:  # noqa: ARG002
        """Nothing is here."""
        return None

    def put(self, key: str, data: bytes) -> None:
        """Forget it."""


def atlas_key(plan: AtlasPlan, point: Point, channels: tuple[str, ...]) -> str:
    """Hash of everything the simulated statistics depend on: not of what the machine is called."""
    document: dict[str, object] = {
        "machine": plan.machine.model_dump(mode="json", exclude={"name", "notes"}),
        "draws": [
            [d.pair, d.twin, d.candidate.label if d.candidate else "", d.term.model_dump() if d.term else None]
            for d in plan.draws
        ],
        "seed": plan.seed,
        "point": [point.speed_hz, point.torque_ratio],
        "channels": list(channels),
        "versions": [PHYSICS_VERSION, ATLAS_VERSION],
    }
    bands = watch_list(plan.machine).bands(bases_at(plan.machine, point.speed_hz))
    if not bands.usual:
        document["bands"] = [bands.edges_hz.tolist(), bands.shapes_hz]
    text = json.dumps(document, sort_keys=True, separators=(",", ":"))
    return "atlas-" + hashlib.sha256(text.encode()).hexdigest()[:32]


def kept_bank(
    plan: AtlasPlan,
    point: Point,
    channels: tuple[str, ...],
    *,
    keeper: Keeper,
    mapper: Mapper,
    made: Callable[[int], None] | None = None,
) -> Bank:
    """The bank of a point, made if it is not kept; `made` hears how many draws had to be simulated."""
    key = atlas_key(plan, point, channels)
    stored = keeper.get(key)
    if stored is not None and (kept := _read(stored)) is not None:
        return kept
    bank = make_bank(plan, point, channels, mapper)
    if not bank.alive.any():
        message = "the machine does not run at this operating point: every simulation of it failed"
        allowed = "a machine that `sideband simulate` can run at this speed and torque"
        raise SpecError(Problem(field="machine", message=message, given=f"{point.speed_hz:g} Hz", allowed=allowed))
    data = bank.to_bytes()
    keeper.put(key, data)
    if made is not None:
        made(len(plan.draws))
    return Bank.from_bytes(data)


def _read(stored: bytes) -> Bank | None:
    """None for a file that was cut short or damaged: it is made again."""
    try:
        return Bank.from_bytes(stored)
    except (ValueError, KeyError, OSError, EOFError, zipfile.BadZipFile, zlib.error):
        return None
