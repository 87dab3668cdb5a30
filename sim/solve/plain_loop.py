"""The plain slow twin of the compiled loop: dense operators, interpreted kernels, the same decisions in the same order.

Written from the method (docs/numerics.md), not from the flat arrays, so that an error of packing, of sparsity or of an
offset in the compiled loop shows as a difference.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from sim.core.elements import STAGES, Element
from sim.core.response import FloatArray
from sim.core.system import System
from sim.solve.collocation import collocation, extrapolation, node_extrapolation
from sim.solve.loop import MAX_ITERATIONS
from sim.solve.newton import BACKTRACK, MAX_NEWTON, RTOL_SHARE
from sim.solve.operators import Coordinates, StepOperators, coordinates, step_operators
from sim.solve.plain import plain_context, plain_force, shaft_rows, step_array


@dataclass(kw_only=True)
class PlainRun:
    """A run of the twin. `state` (2 n,) is (q, q'); `history` (s + 1, U) the last step's coordinates."""

    system: System
    base_step_s: float
    levels: int
    rtol: float
    state: FloatArray
    history: FloatArray
    node_forces: FloatArray
    coords: Coordinates
    operators: Sequence[StepOperators]
    level: int = 0
    last_level: int = 0
    rejected: int = 0
    contexts: list[FloatArray] = field(default_factory=list)


def plain_run(system: System, base_step_s: float, *, levels: int = 6, rtol: float = 1e-4) -> PlainRun:
    """A machine at rest at t = 0."""
    coords = coordinates(system)
    rule = collocation(STAGES)
    count = coords.rows.shape[0]
    return PlainRun(
        system=system,
        base_step_s=base_step_s,
        levels=levels,
        rtol=rtol,
        state=np.zeros(2 * len(system.dofs)),
        history=np.zeros((STAGES + 1, count)),
        node_forces=np.zeros((STAGES, len(coords.force_rows))),
        coords=coords,
        operators=[*step_operators(system, coords, rule, base_step_s, levels)],
    )


def _places(run: PlainRun) -> list[tuple[Element, slice, slice]]:
    """Each element with its places among the coordinates and among the forces."""
    places, u, f = [], 0, 0
    for e in run.system.elements:
        places.append((e, slice(u, u + e.size), slice(f, f + e.forces)))
        u, f = u + e.size, f + e.forces
    return places


def _start(run: PlainRun) -> tuple[FloatArray, FloatArray]:
    n = len(run.system.dofs)
    return run.coords.rows @ run.state[:n], run.coords.rows @ run.state[n:]


def _corrected(run: PlainRun, level: int, fixed: FloatArray, lam: FloatArray, u: FloatArray, ud: FloatArray) -> None:
    """Coordinates and rates at the nodes for the node forces `lam` (s, F), into `u` and `ud` (s, U)."""
    rows = fixed + np.einsum("irjf,jf->ir", run.operators[level].node_force, lam)
    count = len(run.coords.force_rows)
    u[:, list(run.coords.force_rows)] = rows[:, :count]
    ud[:, list(run.coords.rate_rows)] = rows[:, count:]


def _regular(run: PlainRun, u: FloatArray, ud: FloatArray, lam: FloatArray) -> tuple[float, float]:
    change = largest = 0.0
    for index, (element, at, place) in enumerate(_places(run)):
        if element.stiff:
            continue
        for i in range(STAGES):
            new = plain_force(element, 0, u[i, at], ud[i, at], run.contexts[index][i]).force
            change = max(change, float(np.max(np.abs(new - lam[i, place]))))
            largest = max(largest, float(np.max(np.abs(new))))
            lam[i, place] = new
    return change, largest


def _stiff(run: PlainRun, level: int, rows: FloatArray, lam: FloatArray) -> tuple[bool, float]:
    """Damped Newton for each stiff element through its own compliance; `rows` (s, R) are the current node rows."""
    ok, moved = True, 0.0
    rate_of = {u: len(run.coords.force_rows) + r for r, u in enumerate(run.coords.rate_rows)}
    for index, (element, _, place) in enumerate(_places(run)):
        if not element.stiff:
            continue
        d = element.forces
        own_rows = list(range(place.start, place.stop))
        own_rows += [rate_of[run.coords.force_rows[k]] for k in range(place.start, place.stop)]
        own = run.operators[level].node_force[:, own_rows][:, :, :, place].reshape(2 * d * STAGES, d * STAGES)
        entry = lam[:, place].ravel()
        base = rows[:, own_rows].ravel() - own @ entry
        found, converged = _newton(run, element, run.contexts[index], base, own, entry)
        lam[:, place] = found.reshape(STAGES, d)
        ok, moved = ok and converged, max(moved, float(np.max(np.abs(found - entry))))
    return ok, moved


def _newton(
    run: PlainRun, element: Element, context: FloatArray, base: FloatArray, own: FloatArray, lam: FloatArray
) -> tuple[FloatArray, bool]:
    d = element.forces

    def residual(x: FloatArray) -> tuple[FloatArray, FloatArray]:
        points = (base + own @ x).reshape(STAGES, 2 * d)
        force, slope = np.zeros(x.size), np.zeros((x.size, base.size))
        for i, point in enumerate(points):
            value = plain_force(element, 1, point[:d], point[d:], context[i])
            assert value.stiffness is not None and value.damping is not None
            force[i * d : (i + 1) * d] = value.force
            slope[i * d : (i + 1) * d, 2 * d * i : 2 * d * (i + 1)] = np.hstack([value.stiffness, value.damping])
        return x - force, np.eye(x.size) - slope @ own

    lam = lam.copy()
    gap, jacobian = residual(lam)
    for _ in range(MAX_NEWTON):
        before = float(gap @ gap)
        if before <= (RTOL_SHARE * run.rtol * np.max(np.abs(lam))) ** 2 + 1e-16:
            return lam, True
        step, old, share = np.linalg.solve(jacobian, gap), lam, 1.0
        while True:
            lam = old - share * step
            gap, jacobian = residual(lam)
            if gap @ gap <= before * (1.0 - 1e-4 * share) or share < BACKTRACK:
                break
            share *= 0.5
    return lam, False


def _try(run: PlainRun, t: float, level: int) -> tuple[bool, FloatArray, FloatArray, FloatArray]:
    """One step; returns (accepted as is, node coordinates, node forces, new state)."""
    h = run.base_step_s / 2**level
    rule, ops = collocation(STAGES), run.operators[level]
    u0, ud0 = _start(run)
    step = step_array(t, h, rule.c, rule.lagrange, rule.b)
    run.contexts = [
        plain_context(e, step, shaft_rows(run.system, e, step, run.state), u0[at], ud0[at]) for e, at, _ in _places(run)
    ]
    ratio = 2.0 ** (run.last_level - level)
    u, ud = np.tile(u0, (STAGES, 1)), np.tile(ud0, (STAGES, 1))
    carried = list(run.coords.force_rows)
    u[:, carried] = (extrapolation(STAGES, ratio) @ run.history)[:, carried]
    lam = np.zeros_like(run.node_forces)
    for element, _, place in _places(run):
        if element.stiff:
            lam[:, place] = (node_extrapolation(STAGES, ratio) @ run.node_forces)[:, place]
    _regular(run, u, ud, lam)
    fixed = ops.node_load + ops.node_state @ run.state
    good = False
    for iteration in range(MAX_ITERATIONS):
        rows = fixed + np.einsum("irjf,jf->ir", ops.node_force, lam)
        _corrected(run, level, fixed, lam, u, ud)
        stiff_ok, moved = _stiff(run, level, rows, lam)
        change, largest = _regular(run, u, ud, lam)
        change = max(change, moved)
        if stiff_ok and change <= run.rtol * largest + 1e-9:
            good = True
            break
        if iteration >= 4 and change > largest:
            break
    end = ops.end_load + ops.end_state @ run.state + np.einsum("zjf,jf->z", ops.end_force, lam)
    return good and not _contact_changed(run, lam), u, lam, end


def _contact_changed(run: PlainRun, lam: FloatArray) -> bool:
    for element, _, place in _places(run):
        if element.stiff or element.opens:
            before = bool(np.any(run.node_forces[-1, place]))
            if any(bool(np.any(row[place])) != before for row in lam):
                return True
    return False


def plain_advance(run: PlainRun, index: int) -> None:
    """Advance by base step `index`, halving where a step fails or a wall opens or closes."""
    finest = 2 ** (run.levels - 1)
    position = quiet = 0
    while position < finest:
        level = run.level
        good, u, lam, end = _try(run, (index + position / finest) * run.base_step_s, level)
        if not good and level < run.levels - 1:
            run.level, quiet, run.rejected = level + 1, 0, run.rejected + 1
            continue
        run.history = np.vstack([_start(run)[0], u])
        run.node_forces, run.state, run.last_level = lam, end, level
        run.history[-1] = _start(run)[0]
        stride = finest >> level
        position, quiet = position + stride, quiet + 1
        if level > 0 and good and quiet >= 2 and position % (2 * stride) == 0:
            run.level, quiet = level - 1, 0
