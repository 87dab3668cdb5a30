"""Parameters of the elements that look at tooth pairs: header, then all tables; and which tooth is of which kind."""

from __future__ import annotations

import numpy as np

from sim.core.elements import flat
from sim.core.laws import TOOTH_POINTS, MeshLaw
from sim.core.response import FloatArray
from sim.core.spec import MachineSpec
from sim.parts import mesh_kernels as mk
from sim.parts.band_limit import step_response
from sim.parts.mesh_element import header, zero_row


def mean_stiffness_n_per_m(law: MeshLaw) -> float:
    """Mean of the sum over all pairs, at the installed centre distance."""
    if law.pair_rows is None or law.pair_ratios is None:
        raise ValueError("a mesh given by one curve has no pairs")
    row = zero_row(law)
    return float(law.pair_rows[law.pair_rows.shape[0] // 2, row].mean() * law.pair_ratios[row])


def tooth_kinds(law: MeshLaw) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Kind of every tooth of the pinion and of the gear, and the shapes (kinds, 2, TOOTH_POINTS); kind 0 is sound."""
    sound = np.zeros((1, 2 * TOOTH_POINTS))
    if law.pinion_shape is None and law.gear_shape is None:
        return np.zeros(law.teeth[0]), np.zeros(law.teeth[1]), sound.reshape(-1, 2, TOOTH_POINTS)
    given = [
        np.zeros((teeth, 2 * TOOTH_POINTS)) if shape is None else shape.reshape(teeth, -1)
        for teeth, shape in zip(law.teeth, (law.pinion_shape, law.gear_shape), strict=True)
    ]
    rows = np.concatenate([sound, *given])
    found, first, kinds = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first)  # the sound tooth comes first
    rank = np.empty(order.size)
    rank[order] = np.arange(order.size)
    numbers = rank[kinds.ravel()][1:]
    # the kernels count teeth as they enter
    entering = np.roll(numbers[law.teeth[0] :], -law.gear_first_tooth)
    return numbers[: law.teeth[0]], entering, found[order].reshape(-1, 2, TOOTH_POINTS)


def pair_parameters(law: MeshLaw, machine: MachineSpec, extra: FloatArray | None = None) -> FloatArray:
    """Header and tables of `pair_kernels`; `extra` parameters of another element's own stand behind them."""
    if law.pair_rows is None or law.pair_ratios is None:
        raise ValueError("a mesh given by one curve has no pairs")
    kinds_p, kinds_g, shapes = tooth_kinds(law)
    if shapes.shape[0] == 1:
        kinds_p, kinds_g, shapes = np.zeros(0), np.zeros(0), np.zeros((0, 2, TOOTH_POINTS))
    slice_gaps = np.zeros(law.slices if law.slices > 1 else 0)
    own = np.zeros(0) if extra is None else extra
    tables = (
        law.pinion_tooth_gap_m,
        law.gear_tooth_gap_m,
        law.pair_ratios,
        law.pair_rows,
        kinds_p,
        kinds_g,
        shapes,
        slice_gaps,
        step_response(),
        own,
    )
    at = mk.HEADER + np.concatenate([[0], np.cumsum([t.size for t in tables])])
    head = header(law, machine, table_at=int(at[3]), points=law.pair_rows.shape[2])
    head[mk.H_RATIOS] = at[2]
    head[mk.H_KINDS] = max(shapes.shape[0], 1)
    head[mk.H_KINDS_P], head[mk.H_KINDS_G], head[mk.H_SHAPES] = at[4:7]
    head[mk.H_SLICE_GAPS], head[mk.H_STEP], head[mk.H_EXTRA] = at[7:10]
    return flat(head, *tables)
