"""Machines on flexible shafts beyond the paper's: a motor's bearings, a two-stage gearbox, an overhung pinion.

What each number stands for and where it comes from: docs/physics/presets.md.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from sim.core.spec import (
    BearingSpec,
    BodySpec,
    GearSpec,
    MachineSpec,
    MeshSpec,
    OperatingSpec,
    ResonatorSpec,
    ShaftSegment,
    ShaftSpec,
    SupportSpec,
    TermSpec,
    TorqueLoad,
    TransmissionError,
)

GRAVITY_M_PER_S2 = 9.80665
BENDING_DAMPING_S = 3e-6
"""Damping ratio 0.01 at 1.06 kHz."""
CLEARANCE_M = 2e-6
RIG_HZ, RIG_ROTOR_KG, RIG_DISC_KG = 29.95, 7.0, 2.5
SEAT_N_PER_M, SEAT_NS_PER_M = 5e8, 1e3
"""Interference fit of an inner ring on its shaft."""

BALANCED_MM_PER_S = 2.5
"""Balance quality grade G 2.5 of electric motors' rotors: ISO 21940-11:2016, Table 1; permissible residual unbalance is
mass times grade over the largest angular speed (clause 6.2.3)."""

GEAR_NS_PER_M = 400.0
"""Oil and ball contacts, whose law has no damping: ratio 0.02 to 0.05 for the shafts' modes on their balls."""


@dataclass(frozen=True, kw_only=True)
class Housing:
    """A bearing's housing: stiffness N/m and damping N s/m to ground, mass that moves with the outer ring, kg."""

    stiffness_n_per_m: float
    damping_ns_per_m: float
    mass_kg: float


def _bearing(
    name: str, body: str, designation: str, housing: Housing, *, inner_kg: float, cage_phase_rad: float = 0.0
) -> BearingSpec:
    return BearingSpec(
        name=name,
        body=body,
        catalogue=designation,
        radial_clearance_m=CLEARANCE_M,
        cage_phase_rad=cage_phase_rad,
        inner_mass_kg=inner_kg,
        outer_mass_kg=housing.mass_kg,
        shaft_stiffness_n_per_m=SEAT_N_PER_M,
        shaft_damping_ns_per_m=SEAT_NS_PER_M,
        bore_damping_ns_per_m=2e3,
        support=SupportSpec(
            stiffness_x_n_per_m=housing.stiffness_n_per_m,
            stiffness_y_n_per_m=housing.stiffness_n_per_m,
            damping_x_ns_per_m=housing.damping_ns_per_m,
            damping_y_ns_per_m=housing.damping_ns_per_m,
        ),
    )


def _sensor(index: int, bearing: str) -> ResonatorSpec:
    """A sensor on its pad: 0.05 kg on 1.2e8 N/m, 7.8 kHz, damping ratio 0.08."""
    return ResonatorSpec(
        name=f"resonator{index}", bearing=bearing, mass_kg=0.05, stiffness_n_per_m=1.2e8, damping_ns_per_m=400.0
    )


def _sensors(bearings: list[BearingSpec]) -> list[ResonatorSpec]:
    return [_sensor(i, b.name) for i, b in enumerate(bearings, 1)]


def _disc(name: str, mass_kg: float, *, polar: float, diametral: float, damping_ns_per_m: float) -> BodySpec:
    return BodySpec(
        name=name,
        shaft="motor",
        mass_kg=mass_kg,
        inertia_kg_m2=polar,
        diametral_inertia_kg_m2=diametral,
        damping_x_ns_per_m=damping_ns_per_m,
        damping_y_ns_per_m=damping_ns_per_m,
    )


def _left_unbalance(body: str, mass_kg: float, speed_hz: float, phase_rad: float) -> TermSpec:
    """What balancing leaves of a body's unbalance, all that its grade permits."""
    moment = mass_kg * BALANCED_MM_PER_S * 1e-3 / (2.0 * math.pi * speed_hz)
    return TermSpec(term="unbalance", site=body, parameters={"moment": float(f"{moment:.2g}"), "phase": phase_rad})


def bearing_rig() -> MachineSpec:
    """A motor shaft on two 6205 bearings with a load disc beyond the drive end."""
    housing = Housing(stiffness_n_per_m=1e8, damping_ns_per_m=1.5e3, mass_kg=0.6)
    bearings = [
        _bearing("drive_end", "rotor", "6205", housing, inner_kg=0.05),
        _bearing("fan_end", "rotor", "6205", housing, inner_kg=0.05, cage_phase_rad=0.3),
    ]
    shaft = ShaftSpec(
        name="motor",
        segments=[
            ShaftSegment(length_m=0.02, diameter_m=0.025),
            ShaftSegment(length_m=0.24, diameter_m=0.035),
            ShaftSegment(length_m=0.08, diameter_m=0.025),
        ],
        seats={"fan_end": 0.01, "rotor": 0.14, "drive_end": 0.27, "disc": 0.325},
        torsional_damping_nms_per_rad=0.2,
        bending_damping_s=BENDING_DAMPING_S,
        longest_element_m=0.07,
    )
    return MachineSpec(
        name="bearing-rig",
        notes="A motor shaft on two 6205 bearings, 1797 r/min, a load disc overhung at the drive end, under gravity; "
        "rotor and disc are balanced to G 2.5.",
        shafts=[shaft],
        bodies=[
            _disc("rotor", RIG_ROTOR_KG, polar=0.0110, diametral=0.0148, damping_ns_per_m=500.0),
            _disc("disc", RIG_DISC_KG, polar=0.0045, diametral=0.0023, damping_ns_per_m=200.0),
        ],
        bearings=bearings,
        resonators=_sensors(bearings),
        gravity_m_per_s2=GRAVITY_M_PER_S2,
        operating=OperatingSpec(shaft="motor", speed_hz=RIG_HZ, rotation="geared"),
        terms=[
            _left_unbalance("rotor", RIG_ROTOR_KG, RIG_HZ, 0.0),
            _left_unbalance("disc", RIG_DISC_KG, RIG_HZ, 2.0),
        ],
    )


def _gear(name: str, shaft: str, teeth: int, module_m: float, width_m: float) -> GearSpec:
    return GearSpec(
        name=name,
        shaft=shaft,
        teeth=teeth,
        module_m=module_m,
        face_width_m=width_m,
        damping_x_ns_per_m=GEAR_NS_PER_M,
        damping_y_ns_per_m=GEAR_NS_PER_M,
    )


def _mesh(name: str, pinion: str, gear: str, error_m: float) -> MeshSpec:
    return MeshSpec(
        name=name,
        pinion=pinion,
        gear=gear,
        damping_ratio=0.07,
        transmission_error=TransmissionError(amplitude_m=error_m),
        line_of_action="rotated",
        centre_distance_form="true",
    )


def _straight(
    name: str,
    diameter_m: float,
    length_m: float,
    seats: dict[str, float],
    *,
    end: tuple[float, float] | None = None,
    twist_damping: float = 1.0,
) -> ShaftSpec:
    """A shaft of one diameter; `end`: inertia of motor or brake, kg m^2, and its place, m."""
    return ShaftSpec(
        name=name,
        segments=[ShaftSegment(length_m=length_m, diameter_m=diameter_m)],
        length_m=length_m,
        seats=seats,
        end_inertia_kg_m2=None if end is None else end[0],
        end_position_m=0.0 if end is None else end[1],
        torsional_damping_nms_per_rad=twist_damping,
        bending_damping_s=BENDING_DAMPING_S,
    )


def _runout(gear: str, radius_m: float, phase_rad: float) -> TermSpec:
    return TermSpec(term="eccentricity", site=gear, parameters={"radius": radius_m, "phase": phase_rad})


def two_stage() -> MachineSpec:
    """Three shafts in a row; the middle one carries the gear of the first mesh and the pinion of the second."""
    light = Housing(stiffness_n_per_m=1.5e8, damping_ns_per_m=3e3, mass_kg=0.5)
    heavy = Housing(stiffness_n_per_m=2.5e8, damping_ns_per_m=5e3, mass_kg=0.8)
    bearings = [
        _bearing("bearing1", "pinion1", "6205", light, inner_kg=0.05),
        _bearing("bearing2", "pinion1", "6205", light, inner_kg=0.05),
        _bearing("bearing3", "gear1", "6206", light, inner_kg=0.08),
        _bearing("bearing4", "pinion2", "6206", light, inner_kg=0.08),
        _bearing("bearing5", "gear2", "6208", heavy, inner_kg=0.15),
        _bearing("bearing6", "gear2", "6208", heavy, inner_kg=0.15),
    ]
    width = 0.16
    return MachineSpec(
        name="two-stage",
        notes="Two-stage parallel gearbox, 25 Hz and 20 N m in, ratio 9.91, run-out of 5 to 10 µm on three gears.",
        shafts=[
            _straight("input", 0.025, width, {"bearing1": 0.01, "pinion1": 0.05, "bearing2": 0.15}, end=(0.01, 0.0)),
            _straight("idler", 0.03, width, {"bearing3": 0.01, "gear1": 0.05, "pinion2": 0.105, "bearing4": 0.15}),
            _straight("output", 0.04, width, {"bearing5": 0.01, "gear2": 0.105, "bearing6": 0.15}, end=(0.05, width)),
        ],
        gears=[
            _gear("pinion1", "input", 21, 0.002, 0.022),
            _gear("gear1", "idler", 59, 0.002, 0.02),
            _gear("pinion2", "idler", 19, 0.0025, 0.032),
            _gear("gear2", "output", 67, 0.0025, 0.03),
        ],
        meshes=[_mesh("mesh1", "pinion1", "gear1", 2e-6), _mesh("mesh2", "pinion2", "gear2", 3e-6)],
        bearings=bearings,
        resonators=_sensors(bearings),
        loads=[TorqueLoad(shaft="input", torque_nm=20.0)],
        gravity_m_per_s2=GRAVITY_M_PER_S2,
        operating=OperatingSpec(shaft="input", speed_hz=25.0, rotation="geared"),
        terms=[_runout("pinion1", 5e-6, 0.0), _runout("gear1", 8e-6, 1.0), _runout("gear2", 1e-5, 2.0)],
    )


def overhung() -> MachineSpec:
    """A pinion at the free end of its shaft, beyond both its bearings; its gear between its own."""
    housing = Housing(stiffness_n_per_m=1.5e8, damping_ns_per_m=3e3, mass_kg=0.5)
    bearings = [
        _bearing("bearing1", "pinion", "6206", housing, inner_kg=0.08),
        _bearing("bearing2", "pinion", "6206", housing, inner_kg=0.08),
        _bearing("bearing3", "gear", "6208", housing, inner_kg=0.15),
        _bearing("bearing4", "gear", "6208", housing, inner_kg=0.15),
    ]
    return MachineSpec(
        name="overhung",
        notes="Pinion overhung by 45 mm beyond a bearing span of 110 mm; 30 Hz and 25 N m in, ratio 3.05.",
        shafts=[
            _straight("input", 0.03, 0.18, {"bearing1": 0.015, "bearing2": 0.125, "pinion": 0.17}, end=(0.01, 0.0)),
            _straight("output", 0.04, 0.16, {"bearing3": 0.01, "gear": 0.08, "bearing4": 0.15}, end=(0.03, 0.16)),
        ],
        gears=[_gear("pinion", "input", 21, 0.0025, 0.022), _gear("gear", "output", 64, 0.0025, 0.02)],
        meshes=[_mesh("mesh1", "pinion", "gear", 3e-6)],
        bearings=bearings,
        resonators=_sensors(bearings),
        loads=[TorqueLoad(shaft="input", torque_nm=25.0)],
        gravity_m_per_s2=GRAVITY_M_PER_S2,
        operating=OperatingSpec(shaft="input", speed_hz=30.0, rotation="geared"),
        terms=[_runout("pinion", 5e-6, 0.0)],
    )
