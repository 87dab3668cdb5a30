"""Everything the compiled loop reads, flattened to arrays."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sim.core.elements import STAGES
from sim.core.response import FloatArray
from sim.core.system import System
from sim.solve.chunks import Chunked, chunked
from sim.solve.collocation import collocation, derivative_weights, extrapolation, node_extrapolation
from sim.solve.memory import together
from sim.solve.operators import Coordinates, StepOperators, coordinates, step_operators

IntArray = NDArray[np.int64]
LEVELS = 6
"""Halvings of the base step that are prepared: base / 32 is the finest step around an impact."""
KINDS = 3  # node rows from the state, node rows from the forces, end state
SCRATCH = 64


class Plan(NamedTuple):
    """Arrays of the compiled loop; see `sim.solve.loop` for their use.

    Sizes: E elements, F force coordinates, U coordinates, R node rows (padded to 8), Z = 2n states (padded), s nodes.
    """

    sizes: IntArray  # E, F, U, R, Z, n, s, levels, stiff count, outputs, opening count
    base_step: float
    step_head: FloatArray  # template of the `step` array of the kernels
    nodes: FloatArray  # (s,)
    weights: FloatArray  # (s,)
    predict: FloatArray  # (2 * levels + 1, s, s + 1) extrapolation for step ratio 2^(k - levels)
    force_predict: FloatArray  # (2 * levels + 1, s, s) the same for node forces
    slope: FloatArray  # (s, s + 1)
    pointer: IntArray
    column: IntArray
    value: FloatArray
    span: IntArray  # (levels, KINDS, 2) chunk range
    node_load: FloatArray  # (levels, s * R)
    end_load: FloatArray  # (levels, Z)
    row_place: IntArray  # (R,) where a node row goes: u index, or U + index for a rate, -1 padding
    prepare_address: IntArray
    force_address: IntArray
    u_at: IntArray
    f_at: IntArray
    size: IntArray
    forces: IntArray
    par_at: IntArray
    par: FloatArray
    ctx_at: IntArray
    ctx_width: IntArray
    ctx_size: int
    out_at: IntArray
    out_count: IntArray
    flags: IntArray  # (E, 2): stiff, exact end
    turns: FloatArray  # (E, 2) revolutions per second of the two shafts
    speed: FloatArray  # table of the speed over time
    angle_dof: IntArray  # (E, 2) theta DOF or -1
    carries: IntArray  # (U,) 1 where a coordinate carries a force
    observe_rows: FloatArray  # (U, n) all coordinates
    opens: IntArray  # (E,) 1 where a step in which the force begins or ends is halved
    compliance: FloatArray  # (levels, stiff, s, 2d, s, d) own compliance of stiff elements, d <= 2
    stiff_rows: IntArray  # (stiff, 4) node rows of the element's u and ud


@dataclass(frozen=True, kw_only=True)
class Built:
    """A plan with what Python needs beside it."""

    plan: Plan
    coords: Coordinates
    levels: tuple[StepOperators, ...]


def row_order(level: StepOperators) -> IntArray:
    """Order of the node rows, -1 for padding: rows that the same states move stand together, so chunks stay narrow."""
    touched = np.any(level.node_state != 0, axis=0)
    count = touched.shape[0]
    label = np.arange(count)
    for i in range(count):
        for j in range(i):
            if label[j] != label[i] and np.any(touched[i] & touched[j]):
                label[label == label[j]] = label[i]
    sizes = np.bincount(label, minlength=count)[label] if count else label
    order = np.lexsort((np.arange(count), label, -sizes))
    return np.concatenate([order, np.full(-count % 8, -1)]).astype(np.int64)


def _place_of(order: IntArray) -> IntArray:
    """Where a node row stands in the order."""
    return np.argsort(np.where(order < 0, order.size, order), kind="stable")


def _place(coords: Coordinates, order: IntArray) -> IntArray:
    u_count = coords.rows.shape[0]
    target = [*coords.force_rows, *(u_count + u for u in coords.rate_rows)]
    return np.array([-1 if r < 0 else target[r] for r in order], dtype=np.int64)


def _pad(matrix: FloatArray, rows: int) -> FloatArray:
    out = np.zeros((rows, *matrix.shape[1:]))
    out[: matrix.shape[0]] = matrix
    return out


def _ordered(matrix: FloatArray, order: IntArray) -> FloatArray:
    out = np.zeros((order.size, *matrix.shape[1:]))
    out[order >= 0] = matrix[order[order >= 0]]
    return out


def _pack(level: StepOperators, order: IntArray, states: int) -> list[Chunked]:
    s = level.node_load.shape[0]
    width = level.end_state.shape[0]
    node_state = np.concatenate([_ordered(_wide(level.node_state[i], states), order) for i in range(s)])
    forces = level.end_force.shape[2]
    node_force = np.concatenate(
        [_ordered(level.node_force[i].reshape(level.node_force.shape[1], s * forces), order) for i in range(s)]
    )
    end = np.zeros((states, states + s * forces))
    end[:width, :width] = level.end_state
    end[:width, states:] = level.end_force.reshape(width, s * forces)
    return [chunked(node_state), chunked(node_force), chunked(end)]


def _wide(matrix: FloatArray, columns: int) -> FloatArray:
    out = np.zeros((matrix.shape[0], columns))
    out[:, : matrix.shape[1]] = matrix
    return out


def own_compliance(
    system: System, levels: Sequence[StepOperators], rows: IntArray, starts: IntArray, s: int
) -> FloatArray:
    """Response of each stiff element to its own forces, (levels, stiff, 12, 6): rows node, u u ud ud."""
    stiff = [i for i, e in enumerate(system.elements) if e.stiff]
    table = np.zeros((len(levels), max(len(stiff), 1), 4 * s, 2 * s))
    for ell, level in enumerate(levels):
        for k, i in enumerate(stiff):
            d = system.elements[i].forces
            f0 = int(starts[i])
            picked = level.node_force[:, rows[k, : 2 * d]][:, :, :, f0 : f0 + d]
            own = np.zeros((s, 2, 2, s, 2))
            own[:, :, :d, :, :d] = picked.reshape(s, 2, d, s, d)
            table[ell, k] = own.reshape(4 * s, 2 * s)
    return table


def _padded_compliance(own: FloatArray) -> FloatArray:
    """By rows padded to 8, then by columns padded to 16, as `sim.solve.newton` reads it."""
    by_rows = np.pad(own, ((0, 0), (0, 0), (0, 0), (0, 2)))
    by_columns = np.pad(np.swapaxes(own, 2, 3), ((0, 0), (0, 0), (0, 0), (0, 4)))
    flat = [part.reshape(*own.shape[:2], -1) for part in (by_rows, by_columns)]
    return np.concatenate(flat, axis=2)


def stiff_rows(system: System, coords: Coordinates, starts: IntArray) -> IntArray:
    """Node rows (before ordering) of each stiff element's coordinates and rates."""
    stiff = [i for i, e in enumerate(system.elements) if e.stiff]
    rows = np.zeros((max(len(stiff), 1), 4), dtype=np.int64)
    first_rate = len(coords.force_rows)
    rate_of = {u: first_rate + r for r, u in enumerate(coords.rate_rows)}
    for k, i in enumerate(stiff):
        d = system.elements[i].forces
        if d > 2 or d != system.elements[i].size:
            raise ValueError(f"stiff element {system.elements[i].name} must have one or two coordinates, all forces")
        for a in range(d):
            rows[k, a] = starts[i] + a
            rows[k, d + a] = rate_of[coords.force_rows[int(starts[i]) + a]]
    return rows


def _starts(counts: Sequence[int]) -> IntArray:
    return np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)


def _chunks(packs: Sequence[Sequence[Chunked]]) -> tuple[IntArray, IntArray, FloatArray, IntArray]:
    pointer, column, value = [np.zeros(1, dtype=np.int64)], [np.zeros(0, dtype=np.int64)], [np.zeros(0)]
    span = np.zeros((len(packs), KINDS, 2), dtype=np.int64)
    chunks, entries = 0, 0
    for ell, pack in enumerate(packs):
        for kind, piece in enumerate(pack):
            count = piece.pointer.size - 1
            span[ell, kind] = chunks, chunks + count
            pointer.append(piece.pointer[1:] + entries)
            column.append(piece.column)
            value.append(piece.value)
            chunks += count
            entries += piece.column.size
    return np.concatenate(pointer), np.concatenate(column), np.concatenate(value), span


def _angle_dofs(system: System) -> IntArray:
    """(E, 2) index of the angle that each shaft of an element turns with, -1 where it is prescribed."""
    found = [[system.dynamic_angle.get(b, -1) for b in e.shafts] for e in system.elements]
    return np.array(found, dtype=np.int64).reshape(-1, 2)


def build_plan(
    system: System, base_step_s: float, levels: int = LEVELS, drawn_s: float = 0.0, pack: bool = True
) -> Built:
    """A system flattened for a base step and halvings (`drawn_s`: see `sim.core.elements`); not `pack`: no products."""
    rule, coords, elements = collocation(STAGES), coordinates(system), system.elements
    ops = step_operators(system, coords, rule, base_step_s, levels)
    n, s, f, u = len(system.dofs), rule.stages, len(coords.force_rows), coords.rows.shape[0]
    order = row_order(ops[0])
    r, z = order.size, -(-2 * n // 8) * 8
    pointer, column, value, span = _chunks([_pack(level, order, z) for level in ops if pack])
    u_at, f_at = _starts([e.size for e in elements]), _starts([e.forces for e in elements])
    par_at = _starts([e.parameters.size for e in elements])
    ctx_at = _starts([(s + 1) * e.context for e in elements])
    out_at = _starts([3 + len(e.outputs) for e in elements])
    rows = stiff_rows(system, coords, f_at)
    stiff = sum(e.stiff for e in elements)
    head = np.concatenate([[0.0, 0.0, float(s)], rule.c, rule.lagrange.ravel(), rule.b, [drawn_s]])
    opens = np.array([e.stiff or e.opens for e in elements], dtype=np.int64)
    ints = np.array([len(elements), f, u, r, z, n, s, levels, stiff, out_at[-1], opens.sum()], dtype=np.int64)
    plan = Plan(
        sizes=ints,
        base_step=base_step_s,
        step_head=head,
        nodes=rule.c,
        weights=rule.b,
        predict=np.array([extrapolation(s, 2.0 ** (k - levels)) for k in range(2 * levels + 1)]),
        force_predict=np.array([node_extrapolation(s, 2.0 ** (k - levels)) for k in range(2 * levels + 1)]),
        slope=derivative_weights(s),
        pointer=pointer,
        column=column,
        value=value,
        span=span,
        node_load=np.array([np.concatenate([_ordered(level.node_load[i], order) for i in range(s)]) for level in ops]),
        end_load=np.array([_pad(level.end_load, z) for level in ops]),
        row_place=_place(coords, order),
        prepare_address=np.array([e.kernel.prepare_address for e in elements], dtype=np.int64),
        force_address=np.array([e.kernel.force_address for e in elements], dtype=np.int64),
        u_at=u_at,
        f_at=f_at,
        size=np.array([e.size for e in elements], dtype=np.int64),
        forces=np.array([e.forces for e in elements], dtype=np.int64),
        par_at=par_at,
        par=np.concatenate([np.zeros(0), *(e.parameters for e in elements)]),
        ctx_at=ctx_at,
        ctx_width=np.array([e.context for e in elements], dtype=np.int64),
        ctx_size=int(ctx_at[-1]),
        out_at=out_at,
        out_count=np.array([3 + len(e.outputs) for e in elements], dtype=np.int64),
        flags=np.array([[e.stiff, e.exact_end] for e in elements], dtype=np.int64).reshape(-1, 2),
        turns=np.array([[system.speeds_hz[b] for b in e.shafts] for e in elements]).reshape(-1, 2),
        speed=system.speed,
        angle_dof=_angle_dofs(system),
        carries=np.isin(np.arange(u), coords.force_rows).astype(np.int64),
        observe_rows=np.ascontiguousarray(coords.rows),
        opens=opens,
        compliance=_padded_compliance(own_compliance(system, ops, rows, f_at, s)),
        stiff_rows=_place_of(order)[rows] if stiff else rows,
    )
    return Built(plan=together(plan), coords=coords, levels=ops)
