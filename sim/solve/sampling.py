"""Compiled sampling of a run: advance, observe, account energy, write requested channels at the base rate."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sim.core.compiled import jit
from sim.core.response import FloatArray
from sim.core.system import System
from sim.solve.loop import OK, advance_base, evaluate, prepare_all, start_coordinates
from sim.solve.operators import Coordinates
from sim.solve.plan import Built, Plan
from sim.solve.pointers import plan_pointers, work_pointers

IntArray = NDArray[np.int64]
DISSIPATED, LINEAR_POWER = 0, 1


class Probe(NamedTuple):
    """Linear read-out of the state: channel = sum value * x[column], x = [z (Z), forces (F), outputs (O), 1]."""

    pointer: IntArray  # (channels + 1,)
    column: IntArray
    value: FloatArray
    damper_pointer: IntArray  # (dampers + 1,)
    damper_dof: IntArray
    damper_weight: FloatArray
    damper_value: FloatArray
    x: FloatArray
    energy: FloatArray  # 2 + 4 E: see `account`
    contact: FloatArray  # (E, 3): samples, samples in contact, samples beyond a table
    contact_output: IntArray
    range_output: IntArray


def probe_rows(plan: Plan, coords: Coordinates, system: System, names: tuple[str, ...]) -> list[dict[int, float]]:
    """Read-out weights by column for each requested channel; names must exist."""
    n, states = len(system.dofs), int(plan.sizes[4])
    forces = int(plan.sizes[1])
    place = {name: i for i, name in enumerate(system.dofs)}
    outputs = {}
    for e, element in enumerate(system.elements):
        for k, output in enumerate(element.outputs):
            outputs[f"{element.name}.{output.name}"] = states + forces + int(plan.out_at[e]) + 3 + k
    force_map = coords.rows[list(coords.force_rows)]
    one = states + forces + int(plan.sizes[9])
    rows = []
    for name in names:
        if name in outputs:
            rows.append({outputs[name]: 1.0})
            continue
        dof, quantity = name.rsplit(".", 1)
        i = place[dof]
        if quantity == "displacement":
            rows.append({i: 1.0})
        elif quantity == "velocity":
            rows.append({n + i: 1.0})
        else:
            row: dict[int, float] = {one: float(system.load[i] / system.mass[i])}
            for j in np.flatnonzero(system.stiffness[i]):
                row[int(j)] = -float(system.stiffness[i, j] / system.mass[i])
            for j in np.flatnonzero(system.damping[i]):
                row[n + int(j)] = -float(system.damping[i, j] / system.mass[i])
            for f in np.flatnonzero(force_map[:, i]):
                row[states + int(f)] = -float(force_map[f, i] / system.mass[i])
            rows.append(row)
    return rows


def _compressed(rows: list[dict[int, float]]) -> tuple[IntArray, IntArray, FloatArray]:
    pointer = np.concatenate([[0], np.cumsum([len(r) for r in rows])]).astype(np.int64)
    column = np.array([c for r in rows for c in sorted(r)], dtype=np.int64)
    value = np.array([r[c] for r in rows for c in sorted(r)], dtype=np.float64)
    return pointer, column, value


def new_probe(built: Built, system: System, names: tuple[str, ...]) -> Probe:
    """Probe of the requested channels."""
    pointer, column, value = _compressed(probe_rows(built.plan, built.coords, system, names))
    dampers = [dict(d.weights) for d in system.dampers]
    d_pointer, d_column, d_value = _compressed(dampers)
    states, forces, outs = (int(built.plan.sizes[k]) for k in (4, 1, 9))
    x = np.zeros(states + forces + outs + 1)
    x[-1] = 1.0
    count = len(system.elements)
    return Probe(
        pointer=pointer,
        column=column,
        value=value,
        damper_pointer=d_pointer,
        damper_dof=d_column,
        damper_weight=d_value,
        damper_value=np.array([d.damping for d in system.dampers], dtype=np.float64),
        x=x,
        energy=np.zeros(2 + 6 * max(count, 1)),
        contact=np.zeros((max(count, 1), 3)),
        contact_output=np.array([e.contact_output for e in system.elements], dtype=np.int64),
        range_output=np.array([e.range_output for e in system.elements], dtype=np.int64),
    )


@jit
def observe(plan, work, probe):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Evaluate every element at the current instant; fill probe.x with state, forces and outputs."""
    for k in range(plan.states):
        probe.x[k] = work.z[k]
    for k in range(2 * plan.coords):
        work.u[k] = work.start[k]
    for e in range(plan.elements):
        row = plan.stages if plan.flags[2 * e + 1] == 1 else plan.stages - 1
        evaluate(plan, work, 2, e, 0, row)
        for k in range(plan.forces[e]):
            probe.x[plan.states + plan.f_at[e] + k] = work.trial[k]
        base = plan.states + plan.forces_total + plan.out_at[e]
        for k in range(plan.out_count[e]):
            probe.x[base + k] = work.out[k]


@jit
def account(plan, probe, weight):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Trapezoid of dissipated and parametric power; `weight` is the time each sample stands for.

    energy: [linear dissipation, spare, then per element stored now, dissipated, parametric, first stored, spare x 2].
    """
    power = 0.0
    n = plan.dofs
    for d in range(probe.damper_value.size):
        rate = 0.0
        for k in range(probe.damper_pointer[d], probe.damper_pointer[d + 1]):
            rate += probe.damper_weight[k] * probe.x[n + probe.damper_dof[k]]
        power += probe.damper_value[d] * rate * rate
    probe.energy[0] += power * weight
    for e in range(plan.elements):
        base = plan.states + plan.forces_total + plan.out_at[e]
        probe.energy[2 + 6 * e] = probe.x[base]
        probe.energy[2 + 6 * e + 1] += probe.x[base + 1] * weight
        probe.energy[2 + 6 * e + 2] += probe.x[base + 2] * weight
        if probe.contact_output[e] >= 0:
            probe.contact[e, 0] += 1.0
            probe.contact[e, 1] += probe.x[base + 3 + probe.contact_output[e]]
        if probe.range_output[e] >= 0:
            probe.contact[e, 2] += probe.x[base + 3 + probe.range_output[e]]


@jit
def begin(plan_arrays, work_arrays, probe):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Observe the initial state: contexts are prepared so that a step ends at t = 0."""
    plan = plan_pointers(plan_arrays)
    work = work_pointers(work_arrays)
    start_coordinates(plan, work)
    prepare_all(plan, work, -plan.base_step, plan.base_step)
    observe(plan, work, probe)
    account(plan, probe, 0.5 * plan.base_step)
    for e in range(plan.elements):
        probe.energy[2 + 6 * e + 3] = probe.energy[2 + 6 * e]


@jit
def sample(plan_arrays, work_arrays, probe, first, count, rtol, last, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Write `count` samples of every channel from base step `first` on, advancing one base step after each.

    `last` is the index of the final sample of the run (its energy weight is halved). `out` is (channels, count).
    Returns the number of samples written before the motion stopped being finite (count if all is well).
    """
    plan = plan_pointers(plan_arrays)
    work = work_pointers(work_arrays)
    channels = probe.pointer.size - 1
    for j in range(count):
        for c in range(channels):
            total = 0.0
            for k in range(probe.pointer[c], probe.pointer[c + 1]):
                total += probe.value[k] * probe.x[probe.column[k]]
            out[c, j] = total
        if advance_base(plan, work, first + j, rtol) != OK or not math.isfinite(work.z[0]):
            return j
        observe(plan, work, probe)
        account(plan, probe, plan.base_step * (0.5 if first + j + 1 == last else 1.0))
    return count
