"""The order of the method, measured by halving steps on smooth problems at a generic end time."""

from __future__ import annotations

import numpy as np
import pytest

from sim.assembly.assemble import assemble
from sim.core.spec import MeshTable
from sim.presets import preset
from tests.strategies.running import drive

STATED_ORDER = 4.0
"""Least order the documentation promises; the collocation itself has order 5."""


def smooth_gear_pair():
    machine = preset("gear-pair")
    table = MeshTable(centre_distance_error_m=[0.0], stiffness_n_per_m=[[3e8, 3e8]])
    return assemble(machine.model_copy(update={"meshes": [machine.meshes[0].model_copy(update={"table": table})]}))


def preloaded_rotor():
    machine = preset("rotor")
    bearings = [b.model_copy(update={"radial_clearance_m": -2e-5}) for b in machine.bearings]
    return assemble(machine.model_copy(update={"bearings": bearings}))


@pytest.mark.parametrize(
    ("system", "end_s", "coarsest"), [(smooth_gear_pair(), 0.00713, 150), (preloaded_rotor(), 0.00617, 250)]
)
def test_order_by_halving(system, end_s, coarsest):
    n = len(system.dofs)

    def final(steps):
        # no refinement: every run keeps its step
        return drive(system, step_s=end_s / steps, steps=steps, rtol=1e-13, levels=1).states[-1][:n]

    exact = final(32 * coarsest)
    errors = [np.linalg.norm(final(coarsest * 2**k) - exact) for k in range(3)]
    orders = [np.log2(errors[k] / errors[k + 1]) for k in range(2)]
    assert min(orders) >= STATED_ORDER
    assert errors[-1] < 1e-6 * np.linalg.norm(exact)
