"""Machines from flat parameter files: the names of the 28-DOF reference solutions, mapped to a composed machine."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from sim.core.spec import MachineSpec, MeshTable, TermSpec
from sim.presets.gearbox import GearboxNumbers, gearbox


def machine_from_reference(
    p: Mapping[str, float], table: NDArray[np.float64], errors: NDArray[np.float64]
) -> MachineSpec:
    """Compose the machine a reference file describes."""
    terms = []
    if p["delta"] > 0:
        values = {"gap": p["delta"], "damping": p["cN"], "friction": p["mu"], "length": p["L2"]}
        terms.append(TermSpec(term="fit_clearance", site="bearing1", parameters=values))
    spec_errors = np.linspace(errors[0], errors[-1], errors.size)
    return gearbox(
        GearboxNumbers(
            name="reference",
            input_inertia=p["If1"],
            pinion_inertia=p["Ip"],
            gear_inertia=p["Ig"],
            output_inertia=p["If2"],
            pinion_mass=p["mp_"],
            gear_mass=p["mg"],
            torsional_stiffness=p["kf"],
            torsional_damping=p["cf"],
            shaft_stiffness=p["ks"],
            shaft_damping=p["cs"],
            support_stiffness=p["kp"],
            support_damping=p["cp"],
            resonator_stiffness=p["kr"],
            resonator_damping=p["cr"],
            inner_mass=p["ms"],
            outer_mass=p["mo"],
            resonator_mass=p["mr"],
            ball_stiffness=p["kre"],
            ball_clearance=p["c0"],
            error_mean=p["e0"],
            error_amplitude=p["em"],
            error_phase=p["phi"],
            mesh_damping=p["ct"],
            speed_hz=p["fr1"],
            torque=p["T"],
            output_torque=p["Tout"],
            pinion_teeth=int(p["z1"]),
            gear_teeth=int(p["z2"]),
            module=p["m"],
            width=p["W"],
            pressure_angle_deg=p["al"],
            shaft_length=p["L"],
            input_balls=int(p["nb1"]),
            input_ratio=p["g1"],
            output_balls=int(p["nb2"]),
            output_ratio=p["g2"],
            table=MeshTable(centre_distance_error_m=spec_errors.tolist(), stiffness_n_per_m=table.tolist()),
            terms=tuple(terms),
        )
    )
