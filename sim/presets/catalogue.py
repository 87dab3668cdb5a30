"""Named machines. `paper`: Tables 1-3 as written; `paper-lightly-damped`: as the reference solutions;
`paper-demo`: lightly damped with clearance and run-out; machines on flexible shafts (`rigs.py`); and the smallest
machines for tests and teaching.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from sim.core.errors import UnknownName
from sim.core.spec import (
    BallGeometry,
    BearingSpec,
    BodySpec,
    ForceLoad,
    GearSpec,
    MachineSpec,
    MeshSpec,
    OperatingSpec,
    ShaftSpec,
    SupportSpec,
    TermSpec,
    TorqueLoad,
    TransmissionError,
)
from sim.presets.gearbox import GearboxNumbers, gearbox
from sim.presets.rigs import bearing_rig, overhung, two_stage

PAPER = GearboxNumbers(
    name="paper",
    notes="Tables 1 to 3 of the paper as written; what it leaves open is stated in docs/physics/presets.md.",
)
LIGHT = replace(
    PAPER,
    name="paper-lightly-damped",
    notes="The paper's gearbox with structural damping of engineering size instead of Table 1's overdamped values.",
    torsional_stiffness=4.4e4,
    torsional_damping=5.0,
    shaft_damping=1.8e3,
    support_damping=1.8e3,
    resonator_stiffness=2.5e8,
    resonator_damping=1.8e3,
    outer_mass=0.1,
    resonator_mass=0.5,
    ball_stiffness=8e9,
    ball_clearance=2e-6,
    bore_damping=2e3,
)
DEMO_GAP_M = 2e-5
DEMO_RUNOUT_M = 2e-5
"""Run-out radius of the demo's pinion: 40 um total indicated run-out."""


def clearance(gap_m: float, site: str = "bearing1") -> TermSpec:
    """Fit clearance of the paper's variant at a bearing; the collision damping is the machine's."""
    return TermSpec(term="fit_clearance", site=site, parameters={"gap": gap_m})


def _paper() -> MachineSpec:
    return gearbox(PAPER)


def _light() -> MachineSpec:
    return gearbox(LIGHT)


def _demo() -> MachineSpec:
    terms = (
        clearance(DEMO_GAP_M),
        TermSpec(term="eccentricity", site="pinion", parameters={"radius": DEMO_RUNOUT_M}),
    )
    notes = "Lightly damped, clearance 20 µm at bearing 1, pinion run-out 20 µm radius: f_m ± f_r1 needs the run-out."
    return gearbox(replace(LIGHT, name="paper-demo", notes=notes, terms=terms))


def _oscillator() -> MachineSpec:
    return MachineSpec(
        name="oscillator",
        notes="One mass on a spring and damper. A force of 10 N steps on at t = 0 and stays: the mass rings down at "
        "50.3 Hz with a damping ratio of 0.05. Nothing turns, so there are no lines to label.",
        bodies=[BodySpec(name="mass", mass_kg=1.0, axes="y", stiffness_y_n_per_m=1e5, damping_y_ns_per_m=31.6227766)],
        loads=[ForceLoad(body="mass", axis="y", constant_n=10.0)],
    )


def _small_bearing(index: int) -> BearingSpec:
    return BearingSpec(
        name=f"bearing{index}",
        body="disc",
        geometry=BallGeometry(balls=9, ball_diameter_m=0.00794, pitch_diameter_m=0.03904),
        inner_mass_kg=0.1,
        outer_mass_kg=0.1,
        shaft_stiffness_n_per_m=5e7,
        shaft_damping_ns_per_m=500.0,
        support=SupportSpec(
            stiffness_x_n_per_m=5e7, stiffness_y_n_per_m=5e7, damping_x_ns_per_m=2e3, damping_y_ns_per_m=2e3
        ),
    )


def _rotor() -> MachineSpec:
    return MachineSpec(
        name="rotor",
        notes="A disc on a shaft in two deep-groove bearings (ball 7.94 mm, pitch 39.04 mm), loaded by its weight.",
        shafts=[ShaftSpec(name="input", length_m=0.3)],
        bodies=[BodySpec(name="disc", mass_kg=5.0, shaft="input", axes="xy")],
        bearings=[_small_bearing(1), _small_bearing(2)],
        gravity_m_per_s2=9.80665,
        operating=OperatingSpec(shaft="input", speed_hz=30.0, rotation="geared"),
    )


def _plain_gear(name: str, shaft: str, teeth: int) -> GearSpec:
    return GearSpec(name=name, shaft=shaft, teeth=teeth, module_m=0.002, face_width_m=0.024, translates=False)


def _gear_pair() -> MachineSpec:
    return MachineSpec(
        name="gear-pair",
        notes="Two gears on rigid supports: torsion and mesh only.",
        shafts=[ShaftSpec(name="input"), ShaftSpec(name="output")],
        gears=[_plain_gear("pinion", "input", 23), _plain_gear("gear", "output", 81)],
        meshes=[
            MeshSpec(name="mesh1", pinion="pinion", gear="gear", transmission_error=TransmissionError(amplitude_m=5e-6))
        ],
        loads=[TorqueLoad(shaft="input", torque_nm=25.0)],
        operating=OperatingSpec(shaft="input", speed_hz=30.0, rotation="geared"),
    )


@dataclass(frozen=True, kw_only=True)
class Preset:
    """A named machine and the sentence that explains it."""

    name: str
    sentence: str
    build: Callable[[], MachineSpec]


PRESETS: Mapping[str, Preset] = {
    p.name: p
    for p in (
        Preset(name="paper-demo", sentence="Lightly damped gearbox, loose bearing 1, pinion run-out.", build=_demo),
        Preset(name="paper", sentence="The paper's gearbox, tables as written (heavily damped).", build=_paper),
        Preset(name="paper-lightly-damped", sentence="The paper's gearbox with realistic damping.", build=_light),
        Preset(name="gear-pair", sentence="Two gears on rigid supports.", build=_gear_pair),
        Preset(name="rotor", sentence="A disc in two ball bearings under its weight.", build=_rotor),
        Preset(name="bearing-rig", sentence="A motor shaft on two 6205 bearings with a load disc.", build=bearing_rig),
        Preset(name="two-stage", sentence="Two-stage gearbox: three flexible shafts, six bearings.", build=two_stage),
        Preset(name="overhung", sentence="A pinion overhung beyond its two bearings.", build=overhung),
        Preset(
            name="oscillator", sentence="One mass on a spring that rings down after a step of force.", build=_oscillator
        ),
    )
}


def names() -> tuple[str, ...]:
    """Names of all presets, the default first."""
    return tuple(PRESETS)


def preset(name: str) -> MachineSpec:
    """Build a preset; UnknownName lists what exists."""
    if name not in PRESETS:
        raise UnknownName("preset", name, names())
    return PRESETS[name].build()
