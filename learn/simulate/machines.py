"""Bearing machines drawn over wide ranges: sizes, stiffnesses, loads, speeds, healthy nuisance, one fault.

A machine is drawn once and simulated four times: sound, and with a spall on the outer race, the inner race and a ball.
So the four differ by the fault alone, and what the fault adds at the sensor is known (`visible`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from learn.simulate.background import log_uniform
from sim.core.spec import (
    BallGeometry,
    BearingSpec,
    BodySpec,
    FluctuatingSpeed,
    ForceLoad,
    MachineSpec,
    OperatingSpec,
    ShaftSpec,
    SupportSpec,
    TermSpec,
)
from sim.parts.bearing.catalogue import catalogue

CLASSES = ("healthy", "outer", "inner", "ball")
BALLS = (8, 9, 7, 8, 9, 10, 8, 9, 8, 9, 12, 13)
"""Ball numbers of the batches: lanes of one batch share theirs; eight and nine are the commonest by far."""
USUAL = 0.7
"""Share of bearings with a diameter ratio as a catalogue bearing of as many balls has it, within 2 %."""
SLOW_HZ, SPLIT_HZ, FAST_HZ = 9.0, 22.0, 62.0
SLOW_S, FAST_S = 3.2, 1.7
"""Simulated length below and above the split: 27 to 100 turns."""
GRAVITY_M_PER_S2 = 9.80665
BEARINGS = ("bearing1", "bearing2")


@dataclass(frozen=True, kw_only=True)
class Drawn:
    """One machine: four specifications in the order of `CLASSES`, the spall's arc of each fault in rad."""

    machines: tuple[MachineSpec, ...]
    widths_m: tuple[float, ...]
    seed: int


def _geometry(rng: np.random.Generator, balls: int) -> BallGeometry:
    """Usual ratios, or balls that fill 55 to 90 % of the pitch circle at contact angles of up to 30 degrees."""
    alike = [r for r in catalogue().values() if r.balls == balls and r.element == "ball"]
    angle = 0.0
    if alike and rng.random() < USUAL:
        one = alike[int(rng.integers(len(alike)))]
        ratio = one.ball_diameter_m / one.pitch_diameter_m * float(rng.uniform(0.98, 1.02))
    else:
        ratio = min(0.3, math.sin(math.pi / balls * rng.uniform(0.55, 0.9)))
        angle = 0.0 if rng.random() < 0.6 else float(rng.uniform(5.0, 30.0))
    pitch = log_uniform(rng, 0.025, 0.09)
    return BallGeometry(
        balls=balls, ball_diameter_m=ratio * pitch, pitch_diameter_m=pitch, contact_angle_deg=round(angle, 2)
    )


def _bearing(rng: np.random.Generator, name: str, balls: int, clearance_m: float) -> BearingSpec:
    mass, stiffness = log_uniform(rng, 0.1, 2.0), log_uniform(rng, 2e7, 4e8)
    ratio = log_uniform(rng, 0.6, 1.6)
    damping = 2 * log_uniform(rng, 0.02, 0.15) * math.sqrt(stiffness * mass)
    return BearingSpec(
        name=name,
        body="disc",
        geometry=_geometry(rng, balls),
        radial_clearance_m=clearance_m + float(rng.uniform(-1e-6, 1e-6)),
        inner_mass_kg=log_uniform(rng, 0.03, 0.3),
        outer_mass_kg=mass,
        shaft_stiffness_n_per_m=log_uniform(rng, 3e7, 4e8),
        shaft_damping_ns_per_m=log_uniform(rng, 200.0, 2e3),
        cage_phase_rad=float(rng.uniform(0, 2 * math.pi)),
        support=SupportSpec(
            stiffness_x_n_per_m=stiffness,
            stiffness_y_n_per_m=stiffness * ratio,
            damping_x_ns_per_m=damping,
            damping_y_ns_per_m=damping,
        ),
    )


def _nuisance(
    rng: np.random.Generator, bearings: Sequence[BearingSpec], speed_hz: float, load_n: float
) -> list[TermSpec]:
    """What every sound machine has: unbalance and misalignment (forces up to half of the load, which so keeps the
    bearings loaded), waves on races, slip of the cage."""
    omega = 2 * math.pi * speed_hz
    offset = log_uniform(rng, 1e-6, 1e-4)
    terms = [
        TermSpec(
            term="unbalance",
            site="disc",
            parameters={"moment": log_uniform(rng, 1e-3, 0.5) * load_n / omega**2, "phase": float(rng.uniform(0, 6.28))},
        ),
        TermSpec(
            term="parallel_misalignment",
            site="input",
            parameters={
                "offset": offset,
                "stiffness": log_uniform(rng, 1e-3, 0.3) * load_n / offset,
                "odd": float(rng.uniform(0, 0.6)),
                "phase": float(rng.uniform(0, 6.28)),
            },
        ),
    ]
    for bearing in bearings:
        for term in ("outer_waviness", "inner_waviness"):
            values = {
                "amplitude": log_uniform(rng, 3e-9, 5e-7),
                "order": float(rng.integers(2, 60)),
                "phase": float(rng.uniform(0, 6.28)),
            }
            terms.append(TermSpec(term=term, site=bearing.name, parameters=values))
        share = float(rng.uniform(0.0, 0.02))
        terms.append(TermSpec(term="cage_slip", site=bearing.name, parameters={"share": share}))
    return terms


def _fault(rng: np.random.Generator, kind: str, bearing: BearingSpec) -> TermSpec:
    """A spall 0.15 to 4 mm long; on the outer race within 70 degrees of the load."""
    assert bearing.geometry is not None and bearing.geometry.ball_diameter_m is not None
    ball = bearing.geometry.ball_diameter_m
    longest = min(4e-3, 0.35 * ball)
    angle = -math.pi / 2 + rng.uniform(-1.2, 1.2) if kind == "outer" else rng.uniform(0, 6.28)
    values = {
        "width": log_uniform(rng, 1.5e-4, longest),
        "depth": log_uniform(rng, 3e-5, min(5e-4, 0.2 * ball)),
        "angle": float(angle),
    }
    return TermSpec(term=f"{kind}_spall", site=bearing.name, parameters=values)


def draw(seed: int, index: int, balls: int, fast: bool, *, spread: bool = True) -> Drawn:
    """Machine `index` of a seed: the same whatever else is drawn. Without `spread` all are one machine but for the
    faults."""
    rng = np.random.default_rng([seed, index if spread else 0])
    speed = log_uniform(rng, SPLIT_HZ, FAST_HZ) if fast else log_uniform(rng, SLOW_HZ, SPLIT_HZ)
    clearance = float(rng.uniform(-4e-6, 8e-6))
    bearings = [_bearing(rng, name, balls, clearance) for name in BEARINGS]
    mass, push = log_uniform(rng, 1.0, 20.0), log_uniform(rng, 1.0, 3e3)
    load = mass * GRAVITY_M_PER_S2 + push
    wander = log_uniform(rng, 1e-4, 4e-3)
    profile = FluctuatingSpeed(random_rms=wander, correlation_s=log_uniform(rng, 0.1, 2.0))
    sound = MachineSpec(
        name="drawn",
        shafts=[ShaftSpec(name="input", length_m=0.3)],
        bodies=[BodySpec(name="disc", mass_kg=mass, shaft="input", axes="xy")],
        bearings=bearings,
        loads=[ForceLoad(body="disc", axis="y", constant_n=-push)],
        gravity_m_per_s2=GRAVITY_M_PER_S2,
        operating=OperatingSpec(shaft="input", speed_hz=speed, rotation="geared", profile=profile),
        terms=_nuisance(rng, bearings, speed, load),
    )
    rng = rng if spread else np.random.default_rng([seed, index])
    faults = [_fault(rng, kind, bearings[0]) for kind in CLASSES[1:]]
    machines = [sound, *(sound.model_copy(update={"terms": [*sound.terms, f]}) for f in faults)]
    return Drawn(
        machines=tuple(machines),
        widths_m=(0.0, *(f.parameters["width"] for f in faults)),
        seed=int(rng.integers(2**31)),
    )
