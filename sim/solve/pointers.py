"""Plan and work as bare pointers inside compiled code.

`Plan` and `Work` are tuples of arrays; inside the loop every array would be reference-counted at each use, which
cost more than the arithmetic when measured. `plan_pointers` and `work_pointers` take the addresses once per call;
the arrays stay alive through the caller's arguments.
"""

from __future__ import annotations

from collections import namedtuple
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sim.core.compiled import doubles, inline, integers
from sim.core.response import FloatArray
from sim.solve.memory import together
from sim.solve.newton import NEWTON_SCRATCH
from sim.solve.plan import SCRATCH, Plan

IntArray = NDArray[np.int64]


class Work(NamedTuple):
    """State and scratch of a run; arrays are changed in place."""

    z: FloatArray  # (Z + s F) state, then node forces: one input vector for the end product
    rows: FloatArray  # (s R) node rows
    fixed: FloatArray  # (s R) node rows without contact forces
    u: FloatArray  # (s 2 U) coordinates and rates at the nodes
    before: FloatArray  # ((s + 1) U) coordinates at start and nodes of the last accepted step
    start: FloatArray  # (2 U) coordinates and rates at the start
    ctx: FloatArray
    step: FloatArray
    shafts: FloatArray  # (E 4 (s + 1))
    trial: FloatArray  # one element's force
    out: FloatArray  # tangent or outputs of one element
    newton: FloatArray
    next_z: FloatArray  # (Z)
    last_force: FloatArray  # (F) forces at the start of the step
    force_nodes: FloatArray  # (s F) node forces of the last accepted step
    work: FloatArray  # (E) work of the elements on the machine, J
    counts: IntArray  # iterations, steps, refined steps, rejected, unconverged, level, last level, spare


def new_work(plan: Plan) -> Work:
    """A machine at rest at t = 0."""
    e, f, u, r, z, _, s = (int(v) for v in plan.sizes[:7])
    work = Work(
        z=np.zeros(z + s * f),
        rows=np.zeros(s * r),
        fixed=np.zeros(s * r),
        u=np.zeros(max(s * 2 * u, 1)),
        before=np.zeros(max((s + 1) * u, 1)),
        start=np.zeros(max(2 * u, 1)),
        ctx=np.zeros(max(plan.ctx_size, 1)),
        step=plan.step_head.copy(),
        shafts=np.zeros(max(e * 4 * (s + 1), 1)),
        trial=np.zeros(SCRATCH),
        out=np.zeros(SCRATCH),
        newton=np.zeros(NEWTON_SCRATCH),
        next_z=np.zeros(z),
        last_force=np.zeros(max(f, 1)),
        force_nodes=np.zeros(max(s * f, 1)),
        work=np.zeros(max(e, 1)),
        counts=np.zeros(8, dtype=np.int64),
    )
    return together(work)


# compiled code builds these; the compiler knows the types
PlanPointers = namedtuple(
    "PlanPointers",
    "elements forces_total coords rows states dofs stages levels stiff outputs opening base_step nodes weights predict "
    "force_predict slope "
    "pointer column value span node_load end_load row_place prepare_address force_address u_at f_at size forces "
    "par_at par ctx_at ctx_width out_at out_count flags turns speed angle_dof carries observe_rows "
    "opens compliance stiff_rows",
)
WorkPointers = namedtuple(
    "WorkPointers",
    "z rows fixed u before start ctx step shafts trial out newton next_z last_force force_nodes work counts",
)


@inline
def plan_pointers(p):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Addresses of a plan."""
    return PlanPointers(
        p.sizes[0],
        p.sizes[1],
        p.sizes[2],
        p.sizes[3],
        p.sizes[4],
        p.sizes[5],
        p.sizes[6],
        p.sizes[7],
        p.sizes[8],
        p.sizes[9],
        p.sizes[10],
        p.base_step,
        doubles(p.nodes.ctypes.data),
        doubles(p.weights.ctypes.data),
        doubles(p.predict.ctypes.data),
        doubles(p.force_predict.ctypes.data),
        doubles(p.slope.ctypes.data),
        integers(p.pointer.ctypes.data),
        integers(p.column.ctypes.data),
        doubles(p.value.ctypes.data),
        integers(p.span.ctypes.data),
        doubles(p.node_load.ctypes.data),
        doubles(p.end_load.ctypes.data),
        integers(p.row_place.ctypes.data),
        integers(p.prepare_address.ctypes.data),
        integers(p.force_address.ctypes.data),
        integers(p.u_at.ctypes.data),
        integers(p.f_at.ctypes.data),
        integers(p.size.ctypes.data),
        integers(p.forces.ctypes.data),
        integers(p.par_at.ctypes.data),
        doubles(p.par.ctypes.data),
        integers(p.ctx_at.ctypes.data),
        integers(p.ctx_width.ctypes.data),
        integers(p.out_at.ctypes.data),
        integers(p.out_count.ctypes.data),
        integers(p.flags.ctypes.data),
        doubles(p.turns.ctypes.data),
        doubles(p.speed.ctypes.data),
        integers(p.angle_dof.ctypes.data),
        integers(p.carries.ctypes.data),
        doubles(p.observe_rows.ctypes.data),
        integers(p.opens.ctypes.data),
        doubles(p.compliance.ctypes.data),
        integers(p.stiff_rows.ctypes.data),
    )


@inline
def work_pointers(w):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Addresses of the work arrays."""
    return WorkPointers(
        doubles(w.z.ctypes.data),
        doubles(w.rows.ctypes.data),
        doubles(w.fixed.ctypes.data),
        doubles(w.u.ctypes.data),
        doubles(w.before.ctypes.data),
        doubles(w.start.ctypes.data),
        doubles(w.ctx.ctypes.data),
        doubles(w.step.ctypes.data),
        doubles(w.shafts.ctypes.data),
        doubles(w.trial.ctypes.data),
        doubles(w.out.ctypes.data),
        doubles(w.newton.ctypes.data),
        doubles(w.next_z.ctypes.data),
        doubles(w.last_force.ctypes.data),
        doubles(w.force_nodes.ctypes.data),
        doubles(w.work.ctypes.data),
        integers(w.counts.ctypes.data),
    )
