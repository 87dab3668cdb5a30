"""The deflection at which a mesh carries its mean load, gears turned slowly."""

from __future__ import annotations

import math

import numpy as np

from sim.core.laws import MeshLaw
from sim.core.response import FloatArray
from sim.parts.mesh_element import OUTPUTS
from sim.solve.law_picture.bench import Bench

STIFFNESS, ERROR = ([output.name for output in OUTPUTS].index(n) for n in ("stiffness", "transmission_error"))
ROOT_STEP_M = 1e-9
FAR_M = 5e-4
"""Beyond any error of the teeth: there all flanks of the pairs in mesh touch."""


def mean_load_n(law: MeshLaw) -> float:
    """Mean force on the line of action, with its sign, N."""
    return law.drive * law.mean_force_n


def carried(bench: Bench, times: FloatArray, load_n: float) -> FloatArray | None:
    """Deflection (n,) at which the mesh carries a load, by Newton's method on the piecewise linear law; m."""
    if load_n == 0.0:
        return None
    u = bench.zeros()
    found = np.zeros(times.size)
    for k, t in enumerate(times):
        row = bench.row(float(t), still=True)
        stiffness = bench.outputs(row, bench.zeros())[STIFFNESS]
        # from the side where all flanks touch: there Newton's steps never leave the load behind
        u[0] = 4.0 * load_n / stiffness + math.copysign(FAR_M, load_n)
        for _ in range(40):
            force = float(bench.force(row, u)[0])
            ahead = u.copy()
            ahead[0] -= math.copysign(ROOT_STEP_M, load_n)
            slope = (force - float(bench.force(row, ahead)[0])) / math.copysign(ROOT_STEP_M, load_n)
            if slope <= 0.0:
                return None
            change = (load_n - force) / slope
            u[0] += change
            if abs(change) < 1e-13:
                break
        found[k] = u[0]
    return found
