"""Gear trains on isotropic bearings: shafts in a row, each with one gear."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Literal

from sim.core.spec import (
    BallGeometry,
    BearingSpec,
    GearSpec,
    MachineSpec,
    MeshSpec,
    OperatingSpec,
    ShaftSpec,
    SupportSpec,
    TermSpec,
    TorqueLoad,
)

STIFFNESS, DAMPING = 5e7, 2e3


def bearing(name: str, gear: str, *, cage_phase_rad: float = 0.0) -> BearingSpec:
    """The same in x and y."""
    return BearingSpec(
        name=name,
        body=gear,
        geometry=BallGeometry(balls=8, diameter_ratio=0.25),
        contact_stiffness_n_per_m15=5e9,
        inner_mass_kg=0.3,
        outer_mass_kg=0.2,
        shaft_stiffness_n_per_m=STIFFNESS,
        shaft_damping_ns_per_m=DAMPING,
        support=SupportSpec(
            stiffness_x_n_per_m=STIFFNESS,
            stiffness_y_n_per_m=STIFFNESS,
            damping_x_ns_per_m=DAMPING,
            damping_y_ns_per_m=DAMPING,
        ),
        cage_phase_rad=cage_phase_rad,
    )


def train(
    teeth: Mapping[str, int],
    pairs: Sequence[tuple[str, str]],
    torques_nm: Mapping[str, float],
    *,
    rotation: Literal["printed", "geared"] = "geared",
    cages_rad: Mapping[str, float] | None = None,
    held: Sequence[str] = (),
    inertia_share: Mapping[str, float] | None = None,
    terms: Sequence[TermSpec] = (),
    **mesh: object,
) -> MachineSpec:
    """Gears by name on shafts of their own (`a` on `shaft_a`, bearings `a_1`, `a_2`), meshing in `pairs`.

    The first torque's shaft has the given speed. `held` gears do not translate; `mesh` goes to every mesh.
    """
    share = inertia_share or {}
    phases = cages_rad or {}
    return MachineSpec(
        name="train",
        shafts=[
            ShaftSpec(
                name=f"shaft_{n}",
                end_inertia_kg_m2=4e-3 * share.get(n, 1.0),
                torsional_stiffness_nm_per_rad=3e4 * share.get(n, 1.0),
                torsional_damping_nms_per_rad=4.0 * share.get(n, 1.0),
            )
            for n in teeth
        ],
        gears=[
            GearSpec(
                name=n,
                shaft=f"shaft_{n}",
                teeth=z,
                module_m=0.003,
                face_width_m=0.02,
                mass_kg=2.0,
                inertia_kg_m2=2e-3 * share.get(n, 1.0),
                translates=n not in held,
            )
            for n, z in teeth.items()
        ],
        meshes=[
            MeshSpec(name=f"mesh{i}", pinion=p, gear=g, damping_ns_per_m=3e3, **mesh)
            for i, (p, g) in enumerate(pairs, 1)
        ],
        bearings=[
            bearing(f"{n}_{i}", n, cage_phase_rad=phases.get(n, 0.0)) for n in teeth if n not in held for i in (1, 2)
        ],
        loads=[TorqueLoad(shaft=f"shaft_{n}", torque_nm=t) for n, t in torques_nm.items()],
        operating=OperatingSpec(shaft=f"shaft_{next(iter(torques_nm))}", speed_hz=20.0, rotation=rotation),
        terms=list(terms),
    )
