"""Sampling of eight runs: advance, observe, account energy, write the requested channels at the base rate."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from sim.core.choose import select
from sim.core.compiled import doubles, inline, integers, jit
from sim.core.lanes import WIDTH, as_lanes, lane_shift
from sim.core.response import FloatArray
from sim.core.system import System
from sim.solve.chunks import IntArray
from sim.solve.lanes.commit import keep_contexts, start_coordinates
from sim.solve.lanes.layout import LanePlan
from sim.solve.lanes.loop import advance_base, evaluate, prepare_all
from sim.solve.lanes.pointers import lane_plan_pointers, lane_work_pointers
from sim.solve.lanes.product import compressed
from sim.solve.memory import together
from sim.solve.operators import coordinates
from sim.solve.plan import Built
from sim.solve.sampling import probe_rows


class LaneProbe(NamedTuple):
    """As `sim.solve.sampling.Probe`, [item, lane]; x = [state, forces, outputs, 1]."""

    pointer: IntArray
    column: IntArray
    value: FloatArray
    damper_pointer: IntArray
    damper_dof: IntArray
    damper_weight: FloatArray
    damper_value: FloatArray
    x: FloatArray
    energy: FloatArray
    contact: FloatArray  # (3 E, W)
    contact_output: IntArray
    range_output: IntArray


def _dense(rows: Sequence[dict[int, float]], columns: int) -> FloatArray:
    table = np.zeros((len(rows), columns))
    for r, row in enumerate(rows):
        for column, weight in row.items():
            table[r, column] = weight
    return table


def new_lane_probe(plan: LanePlan, systems: Sequence[System], first: Built, names: tuple[str, ...]) -> LaneProbe:
    """Probe of the requested channels; names must exist in every machine."""
    forces, states, outputs = (int(plan.sizes[k]) for k in (1, 4, 9))
    width = states + forces + outputs + 1
    padded = int(first.plan.sizes[4])
    tables = []
    for system in systems:
        rows = probe_rows(first.plan, coordinates(system), system, names)
        # rows are written for padded states: move what stands behind them
        moved = [{c if c < states else c - padded + states: w for c, w in row.items()} for row in rows]
        tables.append(_dense(moved, width))
    pointer, column, value = compressed(tables)
    dampers = [_dense([dict(d.weights) for d in s.dampers], len(s.dofs)) for s in systems]
    d_pointer, d_dof, d_weight = compressed(dampers)
    x = np.zeros((width, WIDTH))
    x[-1] = 1.0
    count = max(len(systems[0].elements), 1)
    probe = LaneProbe(
        pointer=pointer,
        column=column,
        value=np.ascontiguousarray(value),
        damper_pointer=d_pointer,
        damper_dof=d_dof,
        damper_weight=np.ascontiguousarray(d_weight),
        damper_value=np.array([[d.damping for d in s.dampers] for s in systems]).T.copy().reshape(-1, WIDTH),
        x=x,
        energy=np.zeros((2 + 6 * count, WIDTH)),
        contact=np.zeros((3 * count, WIDTH)),
        contact_output=np.array([e.contact_output for e in systems[0].elements], dtype=np.int64),
        range_output=np.array([e.range_output for e in systems[0].elements], dtype=np.int64),
    )
    return together(probe)


@inline
def observe(plan, work, x):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Evaluate every element at the current instant; fill x with state, forces and outputs."""
    for k in range(plan.states):
        x[k] = work.z[k]
    for k in range(2 * plan.coords):
        work.u[k] = work.start[k]
    for e in range(plan.elements):
        evaluate(plan, work, 2, e, 0, lane_shift(work.end_ctx, plan.ctx_at[e]))
        for k in range(plan.forces[e]):
            x[plan.states + plan.f_at[e] + k] = work.trial[k]
        base = plan.states + plan.forces_total + plan.out_at[e]
        for k in range(plan.out_count[e]):
            x[base + k] = work.out[k]


@inline
def account(plan, probe, x, energy, weight):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Trapezoid of dissipated and parametric power, as in `sim.solve.sampling.account`."""
    damping = as_lanes(doubles(probe.damper_value.ctypes.data))
    weights = as_lanes(doubles(probe.damper_weight.ctypes.data))
    pointer = integers(probe.damper_pointer.ctypes.data)
    dof = integers(probe.damper_dof.ctypes.data)
    contact = as_lanes(doubles(probe.contact.ctypes.data))
    contact_output = integers(probe.contact_output.ctypes.data)
    range_output = integers(probe.range_output.ctypes.data)
    power = 0.0 * x[0]
    for d in range(probe.damper_value.shape[0]):
        rate = 0.0 * power
        for k in range(pointer[d], pointer[d + 1]):
            rate += weights[k] * x[plan.dofs + dof[k]]
        power += damping[d] * rate * rate
    energy[0] = energy[0] + power * weight
    for e in range(plan.elements):
        base = plan.states + plan.forces_total + plan.out_at[e]
        energy[2 + 6 * e] = x[base]
        energy[2 + 6 * e + 1] = energy[2 + 6 * e + 1] + x[base + 1] * weight
        energy[2 + 6 * e + 2] = energy[2 + 6 * e + 2] + x[base + 2] * weight
        if contact_output[e] >= 0:
            contact[3 * e] = contact[3 * e] + 1.0
            contact[3 * e + 1] = contact[3 * e + 1] + x[base + 3 + contact_output[e]]
        if range_output[e] >= 0:
            contact[3 * e + 2] = contact[3 * e + 2] + x[base + 3 + range_output[e]]


@jit
def begin(plan_arrays, work_arrays, probe):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Observe the initial state: contexts are prepared so that a step ends at t = 0."""
    plan = lane_plan_pointers(plan_arrays)
    work = lane_work_pointers(work_arrays)
    x = as_lanes(doubles(probe.x.ctypes.data))
    energy = as_lanes(doubles(probe.energy.ctypes.data))
    start_coordinates(plan, work)
    prepare_all(plan, work, 0.0 * work.z[0] - plan.base_step, plan.base_step)
    keep_contexts(plan, work, work.counts[7] > 0.0)
    observe(plan, work, x)
    account(plan, probe, x, energy, 0.5 * plan.base_step)
    for e in range(plan.elements):
        energy[2 + 6 * e + 3] = energy[2 + 6 * e]


@jit
def sample(plan_arrays, work_arrays, probe, first, count, rtol, last, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Write `count` samples of every channel from base step `first` on, advancing one base step after each.

    `out` is (channels, count, W). A lane whose motion stops being finite stays where it is: `counts[7]` says so.
    """
    plan = lane_plan_pointers(plan_arrays)
    work = lane_work_pointers(work_arrays)
    x = as_lanes(doubles(probe.x.ctypes.data))
    energy = as_lanes(doubles(probe.energy.ctypes.data))
    value = as_lanes(doubles(probe.value.ctypes.data))
    target = as_lanes(doubles(out.ctypes.data))
    pointer = integers(probe.pointer.ctypes.data)
    column = integers(probe.column.ctypes.data)
    channels = probe.pointer.size - 1
    for j in range(count):
        for c in range(channels):
            total = 0.0 * x[0]
            for k in range(pointer[c], pointer[c + 1]):
                total += value[k] * x[column[k]]
            target[c * count + j] = total
        advance_base(plan, work, first + j, rtol)
        work.counts[7] = select(work.z[0] * 0.0 == 0.0, work.counts[7], 0.0)
        observe(plan, work, x)
        account(plan, probe, x, energy, plan.base_step * (0.5 if first + j + 1 == last else 1.0))
