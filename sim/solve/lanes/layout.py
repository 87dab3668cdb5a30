"""Everything the lane loop reads: the plans of up to eight machines, stored [item, lane]."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from sim.core.elements import STAGES
from sim.core.lanes import WIDTH
from sim.core.response import FloatArray
from sim.core.system import System
from sim.solve.chunks import IntArray
from sim.solve.collocation import collocation
from sim.solve.lanes.product import Blocks, blocks, compressed
from sim.solve.memory import together
from sim.solve.operators import Coordinates, StepOperators, coordinates, step_operators
from sim.solve.plan import LEVELS, Plan, own_compliance, stiff_rows

KINDS = 3


class LanePlan(NamedTuple):
    """Arrays of the lane loop; as `sim.solve.plan.Plan`, with blocks of rows instead of chunks.

    Integers are the same in every lane. W = 8 lanes.
    """

    sizes: IntArray  # E, F, U, R, Z = 2n, n, s, levels, stiff count, outputs, opening count
    base_step: float
    step_head: FloatArray  # (head, W)
    nodes: FloatArray
    weights: FloatArray
    predict: FloatArray
    force_predict: FloatArray
    slope: FloatArray
    block: IntArray  # blocks of rows of all products, level after level, kind after kind; `sim.solve.lanes.product`
    column: IntArray
    value: FloatArray  # (entries, W)
    first_block: IntArray  # (levels * KINDS + 1,) first block of a product
    node_load: FloatArray  # (levels, s R, W)
    end_load: FloatArray  # (levels, Z, W)
    row_place: IntArray  # (R,)
    prepare_address: IntArray
    force_address: IntArray
    u_at: IntArray
    f_at: IntArray
    size: IntArray
    forces: IntArray
    par_at: IntArray
    par: FloatArray  # (parameters, W)
    ctx_at: IntArray
    ctx_width: IntArray
    out_at: IntArray
    out_count: IntArray
    flags: IntArray  # (E, 2): stiff, exact end
    turns: FloatArray  # (2 E, W)
    speed: FloatArray  # (table, W)
    angle_dof: IntArray  # (2 E,)
    carries: IntArray
    observe_pointer: IntArray
    observe_column: IntArray
    observe_value: FloatArray  # (entries, W)
    opens: IntArray
    compliance: FloatArray  # (levels, stiff, 12 * 6, W)
    stiff_rows: IntArray


def _product(ops: StepOperators, kind: int) -> FloatArray:
    s, rows = ops.node_load.shape
    forces = ops.end_force.shape[2]
    if kind == 0:
        return ops.node_state.reshape(s * rows, ops.end_state.shape[1])
    if kind == 1:
        return ops.node_force.reshape(s * rows, s * forces)
    return np.hstack([ops.end_state, ops.end_force.reshape(ops.end_state.shape[0], s * forces)])


def _products(built: Sequence[Stepped], level: int, kind: int) -> list[FloatArray]:
    """One matrix a lane; lanes with the same operators have the same one."""
    operators = [b.levels[level] for b in built]
    made = {key: _product(ops, kind) for key, ops in {id(ops): ops for ops in operators}.items()}
    return [made[id(ops)] for ops in operators]


def _tables(built: Sequence[Stepped]) -> Blocks:
    return blocks([_products(built, level, kind) for level in range(len(built[0].levels)) for kind in range(KINDS)])


def _by_lane(arrays: Sequence[FloatArray]) -> FloatArray:
    """(items, W) from one flat array a lane."""
    return np.stack([a.ravel() for a in arrays], axis=-1)


@dataclass(frozen=True, kw_only=True)
class Stepped:
    """What differs between the machines of a lane plan: coordinates, operators by level, flat parameters, speeds."""

    coords: Coordinates
    levels: tuple[StepOperators, ...]
    parameters: FloatArray
    turns: FloatArray


def stepped(system: System, step_s: float, levels: int = LEVELS) -> Stepped:
    """Operators of a machine for a base step and its halvings."""
    coords = coordinates(system)
    turns = np.array([[system.speeds_hz[b] for b in e.shafts] for e in system.elements]).reshape(-1, 2)
    parameters = [e.parameters for e in system.elements]
    return Stepped(
        coords=coords,
        levels=step_operators(system, coords, collocation(STAGES), step_s, levels),
        parameters=np.concatenate(parameters) if parameters else np.zeros(1),
        turns=turns,
    )


def lane_plan(systems: Sequence[System], built: Sequence[Stepped], first: Plan) -> LanePlan:
    """Lay eight machines of one structure side by side; `first` is the plan of the first, for what all share."""
    if len(systems) != WIDTH:
        raise ValueError(f"a lane plan takes {WIDTH} machines, not {len(systems)}")
    coords = built[0].coords
    s = int(first.sizes[6])
    f, u = len(coords.force_rows), coords.rows.shape[0]
    rows = f + len(coords.rate_rows)
    n = len(systems[0].dofs)
    sizes = first.sizes.copy()
    sizes[3], sizes[4] = rows, 2 * n
    tables = _tables(built)
    place = [*coords.force_rows, *(u + k for k in coords.rate_rows)]
    o_pointer, o_column, o_value = compressed([b.coords.rows for b in built])
    stiff = stiff_rows(systems[0], coords, first.f_at)
    levels = range(len(built[0].levels))
    own = [own_compliance(sy, b.levels, stiff, first.f_at, s) for sy, b in zip(systems, built, strict=True)]
    plan = LanePlan(
        sizes=sizes,
        base_step=first.base_step,
        step_head=_by_lane([first.step_head] * WIDTH),
        nodes=first.nodes,
        weights=first.weights,
        predict=first.predict,
        force_predict=first.force_predict,
        slope=first.slope,
        block=tables.block,
        column=tables.column,
        value=tables.value,
        first_block=tables.first,
        node_load=_by_lane([np.array([b.levels[k].node_load for k in levels]) for b in built]),
        end_load=_by_lane([np.array([b.levels[k].end_load for k in levels]) for b in built]),
        row_place=np.array(place, dtype=np.int64),
        prepare_address=np.array([e.kernel.lane_prepare for e in systems[0].elements], dtype=np.int64),
        force_address=np.array([e.kernel.lane_force for e in systems[0].elements], dtype=np.int64),
        u_at=first.u_at,
        f_at=first.f_at,
        size=first.size,
        forces=first.forces,
        par_at=first.par_at,
        par=_by_lane([b.parameters for b in built]),
        ctx_at=first.ctx_at,
        ctx_width=first.ctx_width,
        out_at=first.out_at,
        out_count=first.out_count,
        flags=first.flags,
        turns=_by_lane([b.turns for b in built]),
        speed=_by_lane([s.speed for s in systems]),
        angle_dof=np.ascontiguousarray(first.angle_dof.ravel()),
        carries=first.carries,
        observe_pointer=o_pointer,
        observe_column=o_column,
        observe_value=o_value,
        opens=first.opens,
        compliance=_by_lane(own),
        stiff_rows=stiff,
    )
    return together(plan)
