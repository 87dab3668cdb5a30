"""Systems and machines built by hand, and random small machines for property tests."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from hypothesis import strategies as st

from sim.assembly.assemble import assemble
from sim.core.elements import Coordinate, Element
from sim.core.spec import (
    BallGeometry,
    BearingSpec,
    BodySpec,
    CustomLaw,
    ForceLoad,
    GearSpec,
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
from sim.core.system import System
from sim.core.terms import Term
from sim.parts.wall import CONTEXT, OUTPUTS, WALL_PARAMS, wall_parameters
from sim.presets import preset
from sim.terms import REGISTRY
from sim.terms.fit_clearance import KERNEL


def bare_system(
    dofs: Sequence[str],
    mass: Sequence[float],
    *,
    stiffness: object = None,
    damping: object = None,
    load: object = None,
    elements: tuple[Element, ...] = (),
) -> System:
    """A system of matrices and elements without a machine behind it."""
    n = len(dofs)
    return replace(
        assemble(preset("oscillator")),
        dofs=tuple(dofs),
        mass=np.array(mass, dtype=float),
        stiffness=np.zeros((n, n)) if stiffness is None else np.array(stiffness, dtype=float),
        damping=np.zeros((n, n)) if damping is None else np.array(damping, dtype=float),
        load=np.zeros(n) if load is None else np.array(load, dtype=float),
        dampers=(),
        elements=elements,
        speeds_hz={"": 0.0},
        channels=(),
    )


def wall_element(**values: float) -> Element:
    """Wall on the DOFs `ring.x` and `ring.y`; values in the units of the clearance terms."""
    filled = {p.name: p.default for p in WALL_PARAMS} | values
    return Element(
        name="wall",
        site="ring",
        kernel=KERNEL,
        coordinates=tuple(Coordinate(name=a, unit="m", weights=((f"ring.{a}", 1.0),)) for a in ("x", "y")),
        forces=2,
        parameters=wall_parameters(filled),
        context=CONTEXT,
        shafts=("", ""),
        outputs=OUTPUTS,
        stiff=True,
        contact_output=0,
    )


def _logs(low: float, high: float) -> st.SearchStrategy[float]:
    return st.floats(np.log10(low), np.log10(high)).map(lambda x: float(10.0**x))


@st.composite
def rotors(draw: st.DrawFn) -> MachineSpec:
    """A disc in one bearing with a sensor: 7 to 9 DOF, stiffness and damping of engineering size."""
    support = draw(_logs(2e7, 2e8))
    ring = draw(st.floats(0.05, 0.5))
    return MachineSpec(
        name="random rotor",
        shafts=[ShaftSpec(name="input")],
        bodies=[BodySpec(name="disc", mass_kg=draw(st.floats(0.5, 10.0)), shaft="input", axes="xy")],
        bearings=[
            BearingSpec(
                name="bearing1",
                body="disc",
                geometry=BallGeometry(balls=draw(st.integers(5, 10)), diameter_ratio=draw(st.floats(0.15, 0.3))),
                contact_stiffness_n_per_m15=draw(_logs(1e9, 1e10)),
                radial_clearance_m=draw(st.floats(-2e-6, 2e-6)),
                inner_mass_kg=ring,
                outer_mass_kg=ring,
                shaft_stiffness_n_per_m=draw(_logs(2e7, 2e8)),
                shaft_damping_ns_per_m=draw(_logs(1e2, 1e4)),
                support=SupportSpec(
                    stiffness_x_n_per_m=support,
                    stiffness_y_n_per_m=support,
                    damping_x_ns_per_m=draw(_logs(1e3, 1e4)),
                    damping_y_ns_per_m=draw(_logs(1e3, 1e4)),
                ),
            )
        ],
        resonators=[
            ResonatorSpec(name="sensor", bearing="bearing1", mass_kg=0.1, stiffness_n_per_m=1e7, damping_ns_per_m=100.0)
        ],
        loads=[
            ForceLoad(body="disc", axis="x", constant_n=draw(st.floats(-200.0, 200.0))),
            ForceLoad(body="disc", axis="y", amplitude_n=draw(st.floats(0.0, 50.0)), frequency_hz=70.0),
        ],
        gravity_m_per_s2=9.80665,
        operating=OperatingSpec(shaft="input", speed_hz=draw(st.floats(10.0, 80.0))),
    )


@st.composite
def gear_pairs(draw: st.DrawFn) -> MachineSpec:
    """Two gears on rigid supports with end masses: 4 DOF in torsion, tooth pairs or one curve."""

    def gear(name: str, shaft: str, teeth: int) -> GearSpec:
        return GearSpec(name=name, shaft=shaft, teeth=teeth, module_m=0.002, face_width_m=0.02, translates=False)

    def shaft(name: str, inertia: float) -> ShaftSpec:
        return ShaftSpec(
            name=name, end_inertia_kg_m2=inertia, torsional_stiffness_nm_per_rad=2e4, torsional_damping_nms_per_rad=5.0
        )

    return MachineSpec(
        name="random gear pair",
        shafts=[shaft("input", draw(_logs(1e-3, 1e-2))), shaft("output", draw(_logs(1e-3, 1e-2)))],
        gears=[gear("pinion", "input", draw(st.integers(18, 30))), gear("wheel", "output", draw(st.integers(31, 60)))],
        meshes=[
            MeshSpec(
                name="mesh1",
                pinion="pinion",
                gear="wheel",
                damping_ratio=0.1,
                tooth_pairs=draw(st.booleans()),
                transmission_error=TransmissionError(amplitude_m=draw(st.floats(0.0, 2e-6))),
            )
        ],
        loads=[TorqueLoad(shaft="input", torque_nm=draw(st.floats(20.0, 60.0)))],
        operating=OperatingSpec(shaft="input", speed_hz=draw(st.floats(10.0, 60.0))),
    )


def with_terms(machine: MachineSpec, *terms: TermSpec) -> MachineSpec:
    """The machine with more effects."""
    return machine.model_copy(update={"terms": [*machine.terms, *terms]})


LAW = CustomLaw(name="stop", dof="bearing4.outer.y", expression="1e7*max(x-1e-6,0)^1.5+20*tanh(v/0.02)*cos(phi)")
ASKED_FOR = {
    "fit_clearance": ("bearing1", {}),
    "fit_clearance_series": ("bearing3", {}),
    "eccentricity": ("pinion", {}),
    "unbalance": ("gear", {}),
    "rub": ("gear", {"gap": 3e-6}),
    "custom_force": ("bearing4", {}),
    "tooth_crack": ("gear", {}),
}
"""Sites and values of effects in the machine of them all; the others act at the first bearing, gear, mesh or shaft that
lets them, with their defaults."""
WITHOUT_ASKING = {"mesh_pairs", "ball_contact", "force_load"}
INSTEAD = {"mesh_total"}
"""Takes the place of `mesh_pairs` where a mesh is given by one curve."""
NEEDS_PAIRS = {"lead_misalignment", "missing_tooth", "profile_error", "tip_relief", "tooth_crack", "tooth_friction"} | {
    "tooth_spall"
}
"""Effects that a mesh given by one curve refuses."""


def _placed(placed: Sequence[TermSpec], term: Term, sites: Mapping[str, Sequence[str]]) -> TermSpec:
    """A site for a term that none of the terms placed before forbids."""
    site, values = ASKED_FOR.get(term.key, ("", {}))
    for candidate in [site] if site else [s for kind in term.sites for s in sites.get(kind, ())]:
        others = {spec.term for spec in placed if spec.site == candidate}
        if not (others & set(term.excludes)) and not any(term.key in REGISTRY.get(o).excludes for o in others):
            return TermSpec(term=term.key, site=candidate, parameters=values)
    raise AssertionError(f"{term.key} has no place in the machine of every effect")


def every_term_machine(*, curve: MeshTable | None = None) -> MachineSpec:
    """The lightly damped gearbox with one of every registered effect; `curve` in place of tooth pairs for its mesh."""
    plain = preset("paper-lightly-damped")
    loads = [*plain.loads, ForceLoad(body="gear", axis="x", amplitude_n=5.0, frequency_hz=90.0)]
    meshes = plain.meshes if curve is None else [plain.meshes[0].model_copy(update={"table": curve})]
    machine = plain.model_copy(update={"loads": loads, "custom_laws": [LAW], "meshes": meshes})
    left_out = WITHOUT_ASKING | INSTEAD | (NEEDS_PAIRS if curve is not None else set())
    sites = {
        "bearing": ("bearing2", "bearing4", "bearing3", "bearing1"),
        "gear": ("pinion", "gear"),
        "mesh": ("mesh1",),
        "shaft": ("input", "output"),
    }
    placed: list[TermSpec] = []
    for term in sorted(REGISTRY, key=lambda t: (t.key not in ASKED_FOR, t.key)):
        if term.key not in left_out:
            placed.append(_placed(placed, term, sites))
    second = TermSpec(term="eccentricity", site="gear", parameters={"radius": 2e-5, "phase": 1.0})
    return with_terms(machine, *placed, second)
