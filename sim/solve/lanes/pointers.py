"""Lane plan and work as pointers inside compiled code; see `sim.solve.pointers` for why."""

from __future__ import annotations

from collections import namedtuple
from typing import NamedTuple

import numpy as np

from sim.core.compiled import doubles, inline, integers
from sim.core.lanes import WIDTH, as_lanes
from sim.core.response import FloatArray
from sim.solve.lanes.layout import LanePlan
from sim.solve.memory import together
from sim.solve.plan import SCRATCH

NEWTON_ROWS = 200
COUNTS = 10


class LaneWork(NamedTuple):
    """State and scratch of eight runs, [item, lane]; arrays are changed in place."""

    z: FloatArray
    rows: FloatArray
    fixed: FloatArray
    u: FloatArray
    before: FloatArray
    start: FloatArray
    ctx: FloatArray
    end_ctx: FloatArray  # each element's context at its last accepted instant, at the element's place
    step: FloatArray
    shafts: FloatArray
    trial: FloatArray
    out: FloatArray
    newton: FloatArray
    next_z: FloatArray
    last_force: FloatArray
    force_nodes: FloatArray
    work: FloatArray
    counts: FloatArray  # iterations, steps, refined, rejected, unconverged, level, last level, alive, position, quiet


def _lanes(items: int) -> FloatArray:
    return np.zeros((max(items, 1), WIDTH))


def new_lane_work(plan: LanePlan) -> LaneWork:
    """Eight machines at rest at t = 0."""
    e, f, u, r, z, _, s = (int(v) for v in plan.sizes[:7])
    counts = _lanes(COUNTS)
    counts[7] = 1.0
    step = _lanes(plan.step_head.shape[0])
    step[...] = plan.step_head
    work = LaneWork(
        z=_lanes(z + s * f),
        rows=_lanes(s * r),
        fixed=_lanes(s * r),
        u=_lanes(s * 2 * u),
        before=_lanes((s + 1) * u),
        start=_lanes(2 * u),
        ctx=_lanes(int(plan.ctx_at[-1])),
        end_ctx=_lanes(int(plan.ctx_at[-1])),
        step=step,
        shafts=_lanes(e * 4 * (s + 1)),
        trial=_lanes(SCRATCH),
        out=_lanes(SCRATCH),
        newton=_lanes(NEWTON_ROWS),
        next_z=_lanes(z),
        last_force=_lanes(f),
        force_nodes=_lanes(s * f),
        work=_lanes(e),
        counts=counts,
    )
    return together(work)


LanePlanPointers = namedtuple(
    "LanePlanPointers",
    "elements forces_total coords rows states dofs stages levels stiff outputs opening base_step nodes weights predict "
    "force_predict slope block column value first_block node_load end_load row_place prepare_address force_address "
    "u_at f_at size forces par_at par ctx_at ctx_width out_at out_count flags turns speed angle_dof carries "
    "observe_pointer observe_column observe_value opens compliance stiff_rows",
)
LaneWorkPointers = namedtuple(
    "LaneWorkPointers",
    "z rows fixed u before start ctx end_ctx step shafts trial out newton next_z last_force force_nodes work counts",
)


@inline
def lane_plan_pointers(p):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Addresses of a lane plan."""
    return LanePlanPointers(
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
        integers(p.block.ctypes.data),
        integers(p.column.ctypes.data),
        as_lanes(doubles(p.value.ctypes.data)),
        integers(p.first_block.ctypes.data),
        as_lanes(doubles(p.node_load.ctypes.data)),
        as_lanes(doubles(p.end_load.ctypes.data)),
        integers(p.row_place.ctypes.data),
        integers(p.prepare_address.ctypes.data),
        integers(p.force_address.ctypes.data),
        integers(p.u_at.ctypes.data),
        integers(p.f_at.ctypes.data),
        integers(p.size.ctypes.data),
        integers(p.forces.ctypes.data),
        integers(p.par_at.ctypes.data),
        as_lanes(doubles(p.par.ctypes.data)),
        integers(p.ctx_at.ctypes.data),
        integers(p.ctx_width.ctypes.data),
        integers(p.out_at.ctypes.data),
        integers(p.out_count.ctypes.data),
        integers(p.flags.ctypes.data),
        as_lanes(doubles(p.turns.ctypes.data)),
        as_lanes(doubles(p.speed.ctypes.data)),
        integers(p.angle_dof.ctypes.data),
        integers(p.carries.ctypes.data),
        integers(p.observe_pointer.ctypes.data),
        integers(p.observe_column.ctypes.data),
        as_lanes(doubles(p.observe_value.ctypes.data)),
        integers(p.opens.ctypes.data),
        as_lanes(doubles(p.compliance.ctypes.data)),
        integers(p.stiff_rows.ctypes.data),
    )


@inline
def lane_work_pointers(w):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Addresses of the work arrays."""
    return LaneWorkPointers(
        as_lanes(doubles(w.z.ctypes.data)),
        as_lanes(doubles(w.rows.ctypes.data)),
        as_lanes(doubles(w.fixed.ctypes.data)),
        as_lanes(doubles(w.u.ctypes.data)),
        as_lanes(doubles(w.before.ctypes.data)),
        as_lanes(doubles(w.start.ctypes.data)),
        as_lanes(doubles(w.ctx.ctypes.data)),
        as_lanes(doubles(w.end_ctx.ctypes.data)),
        as_lanes(doubles(w.step.ctypes.data)),
        as_lanes(doubles(w.shafts.ctypes.data)),
        as_lanes(doubles(w.trial.ctypes.data)),
        as_lanes(doubles(w.out.ctypes.data)),
        as_lanes(doubles(w.newton.ctypes.data)),
        as_lanes(doubles(w.next_z.ctypes.data)),
        as_lanes(doubles(w.last_force.ctypes.data)),
        as_lanes(doubles(w.force_nodes.ctypes.data)),
        as_lanes(doubles(w.work.ctypes.data)),
        as_lanes(doubles(w.counts.ctypes.data)),
    )
