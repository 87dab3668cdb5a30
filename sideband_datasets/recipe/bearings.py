"""Machines on two ball bearings drawn over wide ranges, four recordings each: what `sideband classify` learns from.

Every machine is recorded sound and with a spall on the outer race, the inner race and a ball. Speed, load, sizes,
stiffnesses, what is never perfect in a sound machine, background and measurement differ from machine to machine only,
so the four recordings of one machine differ by the fault alone. What hardly shows its fault is left out.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache

from sideband_datasets.recipe.chains import bare_chain, drawn_chains, log
from sideband_datasets.recipe.model import Recipe
from sideband_datasets.recipe.read import read_recipe
from sim.core.spec import (
    BallGeometry,
    BearingSpec,
    BodySpec,
    FluctuatingSpeed,
    MachineSpec,
    OperatingSpec,
    ShaftSpec,
    SupportSpec,
)
from sim.parts.bearing.catalogue import CatalogueRow, catalogue

CLASSES = ("healthy", "outer", "inner", "ball")
FAULTS = CLASSES[1:]
BEARINGS = ("bearing1", "bearing2")
RATE_HZ = 48_000.0
SETTLE_S = 0.15
SLOW_HZ, SPLIT_HZ, FAST_HZ = 9.0, 22.0, 62.0
SLOW_S, FAST_S = 3.0, 1.6
"""Length of a recording below and above the split: 27 to 100 turns."""
UNUSUAL = ((6, 0.28, 0.0), (7, 0.25, 20.0), (8, 0.28, 0.0), (9, 0.18, 15.0), (10, 0.24, 0.0), (11, 0.2, 25.0),
           (12, 0.19, 0.0), (13, 0.16, 15.0), (14, 0.17, 0.0), (16, 0.13, 12.0))  # fmt: skip
"""Beside the catalogue: balls, diameter ratio, contact angle (degrees)."""
PITCH_M = 0.045
NOTES = (
    "Wide ranges of bearing machines, for training classifiers of recordings of other machines: one split, no test. "
    "docs/sim2real.md says what was learnt from it."
)
BACKGROUND: dict[str, object] = {"rolling": {}, "knocks": {}, "neighbours": {}, "free_axis": {}}
SHOWS_DB = -5.0
"""Power that a fault must add in some band, over what the sound machine and the noise have there. An envelope's lines
grow with the number of impacts, so somewhat less than the background is still seen, and much less is not."""
MACHINES, SHARE_FAST = 240, 2 / 3
"""About so many, before every family has one at least; a share of them fast."""
RARE = 0.35
"""Machines of each unusual geometry, relative to those of a catalogue size."""


@dataclass(frozen=True, kw_only=True)
class Bearings:
    """Bearings of one family: sizes of the catalogue with as many balls, or one free geometry."""

    name: str
    sizes: tuple[str, ...] = ()
    geometry: BallGeometry | None = None
    share: float = 1.0
    """How many machines, relative to the other families."""


UNUSUAL_NAME = "free"
"""Of families of bearings that the catalogue lacks, before their number."""


@cache
def families() -> tuple[Bearings, ...]:
    """Catalogue bearings by number of balls, as common as the catalogue has them, then unusual ones."""
    rows: dict[int, list[CatalogueRow]] = {}
    for row in catalogue().values():
        if row.element == "ball" and row.contact_angle_rad == 0.0:
            rows.setdefault(row.balls, []).append(row)
    usual = [
        Bearings(name=f"usual{z}", sizes=tuple(sorted(r.designation for r in found)), share=float(len(found)))
        for z, found in sorted(rows.items())
    ]
    free = [
        Bearings(
            name=f"{UNUSUAL_NAME}{k}",
            geometry=BallGeometry(
                balls=z, ball_diameter_m=ratio * PITCH_M, pitch_diameter_m=PITCH_M, contact_angle_deg=angle
            ),
            share=RARE,
        )
        for k, (z, ratio, angle) in enumerate(UNUSUAL)
    ]
    return (*usual, *free)


def _bearing(name: str, kind: Bearings) -> BearingSpec:
    return BearingSpec(
        name=name,
        body="disc",
        catalogue=kind.sizes[0] if kind.sizes else None,
        geometry=kind.geometry,
        inner_mass_kg=0.1,
        outer_mass_kg=0.5,
        shaft_stiffness_n_per_m=1e8,
        shaft_damping_ns_per_m=600.0,
        support=SupportSpec(
            stiffness_x_n_per_m=1e8, stiffness_y_n_per_m=1e8, damping_x_ns_per_m=1e3, damping_y_ns_per_m=1e3
        ),
    )


def machine(kind: Bearings) -> MachineSpec:
    """A disc on a shaft in two bearings under a radial load."""
    return MachineSpec(
        name=kind.name,
        shafts=[ShaftSpec(name="input", length_m=0.3)],
        bodies=[BodySpec(name="disc", mass_kg=5.0, shaft="input", axes="xy")],
        bearings=[_bearing(name, kind) for name in BEARINGS],
        gravity_m_per_s2=9.80665,
        operating=OperatingSpec(shaft="input", speed_hz=30.0, profile=FluctuatingSpeed(random_rms=1e-3)),
    )


def vary(kind: Bearings, *, fast: bool) -> dict[str, object]:
    """What differs from machine to machine. Gravity stands for any radial load (belts, weights, neighbours), clearance
    below zero for preload, under which all balls carry and a defect is struck alike wherever it stands."""
    found: dict[str, object] = {
        "operating.speed_hz": log(SPLIT_HZ, FAST_HZ) if fast else log(SLOW_HZ, SPLIT_HZ),
        "operating.profile.random_rms": log(1e-4, 4e-3),
        "operating.profile.correlation_s": log(0.1, 2.0),
        "gravity_m_per_s2": log(9.8, 100.0),
        "bodies.disc.mass_kg": log(1.0, 20.0),
        "unbalance@disc.moment": log(1e-6, 5e-4),
        "parallel_misalignment@input.offset": log(1e-6, 1e-5),
        "parallel_misalignment@input.stiffness": log(1e4, 1e6),
        "parallel_misalignment@input.odd": {"low": 0.0, "high": 0.6},
    }
    for name in BEARINGS:
        at = f"bearings.{name}"
        if kind.sizes:
            found[f"{at}.catalogue"] = {"choices": list(kind.sizes)}
        found |= {
            f"{at}.radial_clearance_m": {"low": -8e-6, "high": 7e-6},
            f"{at}.inner_mass_kg": log(0.03, 0.3),
            f"{at}.outer_mass_kg": log(0.1, 2.0),
            f"{at}.shaft_stiffness_n_per_m": log(3e7, 4e8),
            f"{at}.shaft_damping_ns_per_m": log(200.0, 2e3),
            f"{at}.cage_phase_rad": {"low": 0.0, "high": 6.28},
            f"{at}.support.stiffness_x_n_per_m": log(2e7, 4e8),
            f"{at}.support.stiffness_y_n_per_m": log(2e7, 4e8),
            f"{at}.support.damping_x_ns_per_m": log(200.0, 5e3),
            f"{at}.support.damping_y_ns_per_m": log(200.0, 5e3),
            f"cage_slip@{name}.share": {"low": 0.0, "high": 0.03},
        }
        for term in ("outer_waviness", "inner_waviness"):
            found[f"{term}@{name}.amplitude"] = log(3e-9, 5e-7)
            found[f"{term}@{name}.order"] = {"choices": [float(k) for k in range(2, 60)]}
    return found


def _fault(name: str) -> dict[str, object]:
    """A spall 0.15 to 3 mm long; on the outer race within 70 degrees of the load."""
    angle = {"low": -math.pi / 2 - 1.2, "high": -math.pi / 2 + 1.2} if name == "outer" else {"low": 0.0, "high": 6.28}
    longest = 2e-3 if name == "ball" else 3e-3
    values = {"width": log(1.5e-4, longest), "depth": log(3e-5, 4e-4), "angle": angle}
    return {"name": name, "terms": [{"term": f"{name}_spall", "sites": [BEARINGS[0]], "parameters": values}]}


@dataclass(frozen=True, kw_only=True)
class Variant:
    """What of the recipe is on.

    `chain`: structure, fastening, noise, hum, filter, converter and a drawn rate; without it the ring's motion in y is
    taken as it is. `background`: rolling noise, knocks, neighbours and a ball's free axis. `spread`: of the machines.
    `rare`: bearings that the catalogue lacks; without them fewer families share the lanes of the solver.
    """

    chain: bool = True
    background: bool = True
    spread: bool = True
    rare: bool = True


FULL = Variant()


def bearings_recipe(count: int, *, fast: bool, seed: int = 1, variant: Variant = FULL) -> Recipe:
    """About `count` machines and four recordings of each; without spread all are one machine but for their faults."""
    kinds = families() if variant.spread else tuple(f for f in families() if f.name == "usual9")
    if not variant.rare:
        kinds = tuple(kind for kind in kinds if kind.sizes)
    total = sum(f.share for f in kinds)
    instances = [max(1, round(count * kind.share / total)) for kind in kinds]
    place = f"{BEARINGS[0]}.outer"
    return read_recipe(
        {
            "name": "bearings-fast" if fast else "bearings-slow",
            "notes": NOTES,
            "seed": seed,
            "count": len(CLASSES) * sum(instances),
            "machines": [
                _family(kind, number, fast=fast, spread=variant.spread)
                for kind, number in zip(kinds, instances, strict=True)
            ],
            "faults": [_fault(name) for name in FAULTS],
            "measurement": drawn_chains(place) if variant.chain else bare_chain(place),
            # Without ingredients it still gives the level that the numbers of a drawn chain are multiples of.
            "background": {**(BACKGROUND if variant.background else {}), "chain_in_levels": variant.chain},
            "siblings": True,
            "shown_db": SHOWS_DB,
            "sampling_rate_hz": RATE_HZ,
            "duration_s": FAST_S if fast else SLOW_S,
            "settle_s": SETTLE_S,
            "peaks": {"spectra": []},
            "plan": "latin_hypercube",
            "splits": {"train": 1.0},
        }
    )


def _family(kind: Bearings, instances: int, *, fast: bool, spread: bool) -> dict[str, object]:
    return {
        "name": kind.name,
        "machine": machine(kind).model_dump(mode="json"),
        "vary": vary(kind, fast=fast) if spread else {"operating.speed_hz": {"low": 29.0, "high": 31.0}},
        "instances": instances,
    }
