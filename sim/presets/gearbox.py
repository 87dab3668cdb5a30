"""The paper's gearbox as a composed machine: two shafts, one mesh, four bearings, four resonators."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from sim.core.spec import (
    BallGeometry,
    BearingSpec,
    GearSpec,
    LoadSpec,
    MachineSpec,
    MeshSpec,
    MeshTable,
    OperatingSpec,
    ResonatorSpec,
    ShaftSpec,
    SupportSpec,
    TermSpec,
    TorqueLoad,
    TransmissionError,
)


@dataclass(frozen=True, kw_only=True)
class GearboxNumbers:
    """Everything the paper's Tables 1-3 give or leave open, SI; defaults are the seed's Table 1 to 3.

    What the seed does not give (masses of rings and resonators, ball stiffness, mesh damping) is stated in
    docs/physics/presets.md with the reason for each value.
    """

    name: str
    notes: str = ""
    input_inertia: float = 0.0021
    pinion_inertia: float = 4.365e-4
    gear_inertia: float = 8.362e-3
    output_inertia: float = 0.0105
    pinion_mass: float = 0.96
    gear_mass: float = 2.88
    torsional_stiffness: float = 4.4e5
    torsional_damping: float = 5e5
    shaft_stiffness: float = 6.56e7
    shaft_damping: float = 1.8e5
    support_stiffness: float = 6.56e7
    support_damping: float = 1.8e5
    resonator_stiffness: float = 6.56e7
    resonator_damping: float = 1.8e5
    inner_mass: float = 0.4
    outer_mass: float = 0.2
    resonator_mass: float = 1.0
    ball_stiffness: float | None = 1e9
    ball_clearance: float = 0.0
    bore_damping: float = 2e5
    error_mean: float = 3e-5
    error_amplitude: float = 2e-5
    error_phase: float = 0.0
    mesh_damping: float | None = None
    mesh_damping_ratio: float = 0.05
    speed_hz: float = 30.0
    rotation: Literal["printed", "geared"] = "printed"
    torque: float = 25.0
    output_torque: float | None = None
    pinion_teeth: int = 23
    gear_teeth: int = 81
    module: float = 0.002
    width: float = 0.024
    pressure_angle_deg: float = 20.0
    youngs_modulus: float = 2.16e11
    shaft_length: float = 0.26
    input_balls: int = 7
    input_ratio: float = 0.2647
    output_balls: int = 7
    output_ratio: float = 0.2648
    gravity: float = 0.0
    table: MeshTable | None = None
    terms: tuple[TermSpec, ...] = ()


def _bearing(n: GearboxNumbers, index: int) -> BearingSpec:
    first = index <= 2
    balls = n.input_balls if first else n.output_balls
    return BearingSpec(
        name=f"bearing{index}",
        body="pinion" if first else "gear",
        geometry=BallGeometry(balls=balls, diameter_ratio=n.input_ratio if first else n.output_ratio),
        contact_stiffness_n_per_m15=n.ball_stiffness,
        radial_clearance_m=n.ball_clearance,
        bore_damping_ns_per_m=n.bore_damping,
        inner_mass_kg=n.inner_mass,
        outer_mass_kg=n.outer_mass,
        shaft_stiffness_n_per_m=n.shaft_stiffness,
        shaft_damping_ns_per_m=n.shaft_damping,
        support=SupportSpec(
            stiffness_x_n_per_m=n.support_stiffness,
            stiffness_y_n_per_m=n.support_stiffness,
            damping_x_ns_per_m=n.support_damping,
            damping_y_ns_per_m=n.support_damping,
        ),
    )


def _gear(n: GearboxNumbers, name: str) -> GearSpec:
    driving = name == "pinion"
    return GearSpec(
        name=name,
        shaft="input" if driving else "output",
        teeth=n.pinion_teeth if driving else n.gear_teeth,
        module_m=n.module,
        pressure_angle_deg=n.pressure_angle_deg,
        face_width_m=n.width,
        youngs_modulus_pa=n.youngs_modulus,
        mass_kg=n.pinion_mass if driving else n.gear_mass,
        inertia_kg_m2=n.pinion_inertia if driving else n.gear_inertia,
    )


def _shaft(n: GearboxNumbers, name: str, inertia: float) -> ShaftSpec:
    return ShaftSpec(
        name=name,
        end_inertia_kg_m2=inertia,
        torsional_stiffness_nm_per_rad=n.torsional_stiffness,
        torsional_damping_nms_per_rad=n.torsional_damping,
        length_m=n.shaft_length,
    )


def gearbox(n: GearboxNumbers) -> MachineSpec:
    """Compose the machine."""
    resonators = [
        ResonatorSpec(
            name=f"resonator{i}",
            bearing=f"bearing{i}",
            mass_kg=n.resonator_mass,
            stiffness_n_per_m=n.resonator_stiffness,
            damping_ns_per_m=n.resonator_damping,
        )
        for i in range(1, 5)
    ]
    loads: list[LoadSpec] = [TorqueLoad(shaft="input", torque_nm=n.torque)]
    if n.output_torque is not None:
        loads.append(TorqueLoad(shaft="output", torque_nm=-n.output_torque))
    return MachineSpec(
        name=n.name,
        notes=n.notes,
        shafts=[_shaft(n, "input", n.input_inertia), _shaft(n, "output", n.output_inertia)],
        gears=[_gear(n, "pinion"), _gear(n, "gear")],
        meshes=[
            MeshSpec(
                name="mesh1",
                pinion="pinion",
                gear="gear",
                damping_ns_per_m=n.mesh_damping,
                damping_ratio=n.mesh_damping_ratio,
                transmission_error=TransmissionError(
                    mean_m=n.error_mean, amplitude_m=n.error_amplitude, phase_rad=n.error_phase
                ),
                table=n.table,
            )
        ],
        bearings=[_bearing(n, i) for i in range(1, 5)],
        resonators=resonators,
        loads=loads,
        gravity_m_per_s2=n.gravity,
        operating=OperatingSpec(shaft="input", speed_hz=n.speed_hz, rotation=n.rotation),
        terms=list(n.terms),
    )
