"""The Sideband dataset behind the gear classifier: recipes of gear pairs drawn over wide ranges, four recordings each.

Every machine is recorded sound, with a tooth cracked at its root, with a tooth broken and with a spalled flank, on the
driving or the driven gear. Sizes, load, speed and what is never perfect in a sound pair (run-out, pitch errors, play,
an uneven torque) differ from machine to machine only. No chain is in the recipe: the motion of both gears is kept, and
heard in `gear_rows`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from learn.simulate.background import log_uniform
from sideband_datasets import Recipe, read_recipe
from sim.core.spec import (
    GearSpec,
    MachineSpec,
    MeshSpec,
    OperatingSpec,
    ShaftSpec,
    TorqueLoad,
    TransmissionError,
)

CLASSES = ("healthy", "tooth")
HEALTHY, TOOTH = CLASSES
SOUND = "sound"
"""A crack of no depth: the same equations as with a fault, so the four recordings are solved side by side."""
GEARS = ("pinion", "wheel")
"""The driving gear and the driven one, whichever is larger."""
SHAFTS = ("input", "output")
RATE_HZ = 30_000.0
SETTLE_S = 0.2
SLOW_HZ, SPLIT_HZ, FAST_HZ = 9.0, 22.0, 62.0
SLOW_S, FAST_S = 3.2, 1.8
"""Length of a recording below and above the split: 29 to 112 turns."""
DRIVING, DRIVEN = (16, 60), (18, 110)
"""Numbers of teeth."""
DUTY_NM = 15.0
"""Middle of the input torques for a module of 2 mm; they grow with its cube."""
TOGETHER = 2
"""Machines of one pair of teeth: as many as fill the lanes of the solver with their four recordings."""
BLANKS = (
    (1.5e-3, 0.015, 20.0, 1.0),
    (2e-3, 0.02, 20.0, 1.0),
    (2e-3, 0.025, 25.0, 1.0),
    (2.5e-3, 0.025, 20.0, 1.15),
    (3e-3, 0.03, 20.0, 1.0),
)
"""Module and face width (m), pressure angle (degrees), addendum (modules): preferred modules of ISO 54, widths of 8 to
14 modules; the longer addendum gives contact ratios near 2, the larger angle those near 1.5."""
DENSITY = 1.5e4
"""kg/m^3: steel, and as much again for hub, shaft and rings."""


@dataclass(frozen=True, kw_only=True)
class Teeth:
    """What both gears of a pair share, and how many teeth each has."""

    module_m: float
    width_m: float
    angle_deg: float
    addendum: float
    driving: int
    driven: int
    number: int

    @property
    def name(self) -> str:
        """`p3-23-81`: number of the pair, teeth."""
        return f"p{self.number}-{self.driving}-{self.driven}"


def pairs(count: int, seed: int) -> tuple[Teeth, ...]:
    """`count` pairs of gears; ratios from a third to six."""
    rng = np.random.default_rng([seed, count])
    found = []
    for number in range(count):
        module, width, angle, addendum = BLANKS[number % len(BLANKS)]
        driving, driven = 0, 0
        while not _runs(driving, driven, angle, addendum):
            driving, driven = round(log_uniform(rng, *DRIVING)), round(log_uniform(rng, *DRIVEN))
        found.append(
            Teeth(
                module_m=module,
                width_m=width,
                angle_deg=angle,
                addendum=addendum,
                driving=driving,
                driven=driven,
                number=number,
            )
        )
    return tuple(found)


def _runs(one: int, other: int, angle_deg: float, addendum: float) -> bool:
    """Whether neither gear's tip reaches below the other's base circle, where there is no involute."""
    if min(one, other) == 0:
        return False
    angle = math.radians(angle_deg)
    reach = (one + other) / 2 * math.sin(angle)
    return all(math.sqrt((z / 2 + addendum) ** 2 - (z / 2 * math.cos(angle)) ** 2) <= reach for z in (one, other))


def machine(kind: Teeth) -> MachineSpec:
    """Two gears, each on its own springs to ground, between a motor's and a brake's inertia."""
    gears = [
        GearSpec(
            name=name,
            shaft=shaft,
            teeth=kind.driving if name == GEARS[0] else kind.driven,
            module_m=kind.module_m,
            pressure_angle_deg=kind.angle_deg,
            addendum_coefficient=kind.addendum,
            face_width_m=kind.width_m,
            density_kg_per_m3=DENSITY,
            stiffness_x_n_per_m=5e7,
            stiffness_y_n_per_m=5e7,
            damping_x_ns_per_m=500.0,
            damping_y_ns_per_m=500.0,
        )
        for name, shaft in zip(GEARS, SHAFTS, strict=True)
    ]
    return MachineSpec(
        name=kind.name,
        shafts=[
            ShaftSpec(
                name=name,
                end_inertia_kg_m2=5e-3,
                torsional_stiffness_nm_per_rad=1e4,
                torsional_damping_nms_per_rad=0.3,
            )
            for name in SHAFTS
        ],
        gears=gears,
        meshes=[
            MeshSpec(
                name="mesh",
                pinion=GEARS[0],
                gear=GEARS[1],
                backlash_m=1e-4,
                transmission_error=TransmissionError(amplitude_m=1e-6),
                line_of_action="rotated",
                centre_distance_form="true",
            )
        ],
        loads=[TorqueLoad(shaft=SHAFTS[0], torque_nm=DUTY_NM)],
        operating=OperatingSpec(shaft=SHAFTS[0], speed_hz=30.0, rotation="geared"),
    )


def _log(low: float, high: float) -> dict[str, object]:
    return {"low": low, "high": high, "scale": "log"}


def vary(kind: Teeth, *, fast: bool) -> dict[str, object]:
    """What differs from machine to machine. The load goes from a sixth of the usual one, where flanks part, to four
    times it; accuracy from ISO 1328 grade 4 to grade 10."""
    duty = DUTY_NM * (kind.module_m / 2e-3) ** 3
    found: dict[str, object] = {
        "operating.speed_hz": _log(SPLIT_HZ, FAST_HZ) if fast else _log(SLOW_HZ, SPLIT_HZ),
        "torque_nm": _log(duty / 6, 4 * duty),
        "meshes.mesh.backlash_m": _log(4e-5, 3e-4),
        "meshes.mesh.damping_ratio": _log(0.03, 0.15),
        "meshes.mesh.transmission_error.amplitude_m": _log(1e-7, 5e-6),
    }
    for name in SHAFTS:
        found |= {
            f"shafts.{name}.end_inertia_kg_m2": _log(5e-4, 1e-2),
            f"shafts.{name}.torsional_stiffness_nm_per_rad": _log(2e3, 5e4),
            f"shafts.{name}.torsional_damping_nms_per_rad": _log(0.05, 2.0),
            f"torque_ripple@{name}.amplitude": _log(duty / 300, duty / 10),
            f"torque_ripple@{name}.order": {"choices": [1, 2, 3, 4, 5]},
        }
    for name in GEARS:
        found |= {
            f"gears.{name}.stiffness_x_n_per_m": _log(1e7, 4e8),
            f"gears.{name}.stiffness_y_n_per_m": _log(1e7, 4e8),
            f"gears.{name}.damping_x_ns_per_m": _log(200.0, 5e3),
            f"gears.{name}.damping_y_ns_per_m": _log(200.0, 5e3),
            f"eccentricity@{name}.radius": _log(1e-6, 2e-5),
            f"eccentricity@{name}.phase": {"low": 0.0, "high": 6.28},
            f"pitch_error@{name}.rms": _log(1e-7, 3e-6),
            f"profile_error@{name}.amplitude": _log(1e-7, 1e-5),
            f"tip_relief@{name}.amount": _log(1e-6, 2e-5),
        }
    return found


def _fault(name: str, term: str, ranges: dict[str, object]) -> dict[str, object]:
    parameters = {**ranges, "place": {"low": 0.0, "high": 0.999}}
    return {"name": name, "terms": [{"term": term, "sites": list(GEARS), "parameters": parameters}]}


FAULTS = (
    _fault(SOUND, "tooth_crack", {"depth": 1e-9}),
    _fault("crack", "tooth_crack", {"depth": {"low": 0.2, "high": 0.5}}),
    _fault("broken", "missing_tooth", {"width": {"low": 0.4, "high": 1.0}, "height": {"low": 0.4, "high": 1.0}}),
    _fault(
        "spall",
        "tooth_spall",
        {"width": {"low": 0.5, "high": 1.0}, "length": {"low": 0.1, "high": 0.6}, "floor": _log(5e-5, 5e-4)},
    ),
)


def recipe(count: int, *, fast: bool, seed: int = 0) -> Recipe:
    """`count` machines and four recordings of each."""
    kinds = pairs(max(1, round(count / TOGETHER)), seed)
    heard = [
        {
            "kind": "accelerometer",
            "name": f"{gear}.{axis}",
            "place": {"location": gear, "direction_deg": angle},
        }
        for gear in GEARS
        for axis, angle in (("x", 0.0), ("y", 90.0))
    ]
    return read_recipe(
        {
            "name": "gears-fast" if fast else "gears-slow",
            "seed": seed,
            "count": len(FAULTS) * TOGETHER * len(kinds),
            "machines": [
                {
                    "name": kind.name,
                    "machine": machine(kind).model_dump(mode="json"),
                    "vary": vary(kind, fast=fast),
                    "instances": TOGETHER,
                }
                for kind in kinds
            ],
            "faults": list(FAULTS),
            "healthy_share": 0.0,
            "measurement": [{"name": "gears", "chain": {"channels": heard}}],
            "sampling_rate_hz": RATE_HZ,
            "duration_s": FAST_S if fast else SLOW_S,
            "settle_s": SETTLE_S,
            "peaks": {"spectra": []},
            "splits": {"train": 1.0},
        }
    )
