"""Static load distribution among the balls of a radially loaded bearing.

The balls share the load as springs Q = k eps^1.5 with eps_i = x cos(theta_i) + y sin(theta_i) - c_o, seed eqs
(9)-(12); the equilibrium is the minimum of a convex energy, so a damped Newton iteration always finds it.
Classical results: Stribeck's Q_max = 4.37 F/Z and Sjoevall's integrals (Harris & Kotzalas, Rolling Bearing Analysis,
5th ed., 2006, chapter 7).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sim.parts.bearing.hertz import EXPONENT

FloatArray = NDArray[np.float64]
_MAX_ITERATIONS = 200
_FORCE_TOLERANCE = 1e-10
"""Force residual over the load at which the iteration stops."""


@dataclass(frozen=True, kw_only=True)
class BallRow:
    """What the load distribution needs: balls, k in N/m^1.5, gap of each ball when centred (m, negative: preload)."""

    balls: int
    stiffness_n_per_m15: float
    clearance_m: float = 0.0

    def angles_rad(self, cage_phase_rad: float = 0.0) -> FloatArray:
        """Ball angles, shape (balls,)."""
        return cage_phase_rad + 2 * np.pi * np.arange(self.balls) / self.balls


@dataclass(frozen=True, kw_only=True)
class BallLoads:
    """Equilibrium of a ball row: displacement (2,) m, ball loads (balls,) N, tangent stiffness (2, 2) N/m."""

    displacement_m: FloatArray
    ball_loads_n: FloatArray
    stiffness_n_per_m: FloatArray


def ring_state(row: BallRow, displacement_m: FloatArray, cage_phase_rad: float = 0.0) -> BallLoads:
    """Ball loads and tangent stiffness at a given displacement of the inner against the outer ring, shape (2,)."""
    angles = row.angles_rad(cage_phase_rad)
    normals = np.stack([np.cos(angles), np.sin(angles)])
    squeeze = np.maximum(normals.T @ displacement_m - row.clearance_m, 0.0)
    loads = row.stiffness_n_per_m15 * squeeze**EXPONENT
    slopes = EXPONENT * row.stiffness_n_per_m15 * squeeze ** (EXPONENT - 1)
    return BallLoads(
        displacement_m=np.asarray(displacement_m, dtype=np.float64),
        ball_loads_n=loads,
        stiffness_n_per_m=(normals * slopes) @ normals.T,
    )


def ring_force_n(row: BallRow, state: BallLoads, cage_phase_rad: float = 0.0) -> FloatArray:
    """Load the balls carry at this state, shape (2,), N: equal to the external load at equilibrium."""
    angles = row.angles_rad(cage_phase_rad)
    return np.array([state.ball_loads_n @ np.cos(angles), state.ball_loads_n @ np.sin(angles)])


def _energy_j(row: BallRow, state: BallLoads, load_n: FloatArray) -> float:
    """Strain energy less the work of the load."""
    k, n = row.stiffness_n_per_m15, EXPONENT
    stored = k / (n + 1) * np.sum((state.ball_loads_n / k) ** ((n + 1) / n))
    return float(stored - load_n @ state.displacement_m)


def static_equilibrium(row: BallRow, load_n: FloatArray, cage_phase_rad: float = 0.0) -> BallLoads:
    """Equilibrium under a radial load (2,) N; without load the centred position."""
    force = float(np.hypot(*load_n))
    if force == 0.0:
        return ring_state(row, np.zeros(2), cage_phase_rad)
    depth_m = (force / row.stiffness_n_per_m15) ** (1 / EXPONENT)
    # Twice the gap and a full single-ball depth along the load puts at least one ball in contact.
    state = ring_state(row, load_n / force * (2 * max(row.clearance_m, 0.0) + depth_m), cage_phase_rad)
    floor = 1e-6 * force / depth_m
    for _ in range(_MAX_ITERATIONS):
        residual = load_n - ring_force_n(row, state, cage_phase_rad)
        if float(np.hypot(*residual)) <= _FORCE_TOLERANCE * force:
            return state
        # One loaded ball leaves the row without stiffness across it: a small floor keeps the step finite.
        step = np.linalg.solve(state.stiffness_n_per_m + floor * np.eye(2), residual)
        state = _line_search(row, state, step, load_n, cage_phase_rad)
    raise ArithmeticError(f"no static equilibrium of {row} under {load_n} N within {_MAX_ITERATIONS} steps")


def _line_search(
    row: BallRow, state: BallLoads, step_m: FloatArray, load_n: FloatArray, cage_phase_rad: float
) -> BallLoads:
    """Halve a Newton step until the energy falls; the last halving when rounding hides the fall."""
    before = _energy_j(row, state, load_n)
    best = state
    for halving in range(40):
        best = ring_state(row, state.displacement_m + step_m * 0.5**halving, cage_phase_rad)
        if _energy_j(row, best, load_n) <= before + 1e-14 * abs(before):
            break
    return best


def _states(
    row: BallRow, normals: FloatArray, displacements_m: FloatArray, load_n: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Force (p, 2) N, stiffness (p, 2, 2) N/m and energy less the load's work (p,) J at p cage angles at once."""
    squeeze = np.maximum(np.einsum("pbi,pi->pb", normals, displacements_m) - row.clearance_m, 0.0)
    loads = row.stiffness_n_per_m15 * squeeze**EXPONENT
    slopes = EXPONENT * row.stiffness_n_per_m15 * squeeze ** (EXPONENT - 1)
    force = np.einsum("pb,pbi->pi", loads, normals)
    stiffness = np.einsum("pb,pbi,pbj->pij", slopes, normals, normals)
    energy = (loads * squeeze).sum(axis=1) / (EXPONENT + 1) - displacements_m @ load_n
    return force, stiffness, energy


def mean_stiffness_n_per_m(row: BallRow, load_n: FloatArray, phases: int = 16) -> FloatArray:
    """Tangent stiffness (2, 2) N/m under a load, averaged over `phases` cage angles within one ball spacing.

    The Newton iteration of `static_equilibrium`, at all angles at once.
    """
    cage = 2 * np.pi / row.balls * np.arange(phases) / phases
    angles = np.stack([row.angles_rad(float(angle)) for angle in cage])
    normals = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    force = float(np.hypot(*load_n))
    if force == 0.0:
        return np.asarray(_states(row, normals, np.zeros((phases, 2)), load_n)[1].mean(axis=0))
    depth_m = (force / row.stiffness_n_per_m15) ** (1 / EXPONENT)
    at = np.tile(load_n / force * (2 * max(row.clearance_m, 0.0) + depth_m), (phases, 1))
    floor = 1e-6 * force / depth_m * np.eye(2)
    carried, stiffness, energy = _states(row, normals, at, load_n)
    for _ in range(_MAX_ITERATIONS):
        residual = load_n - carried
        if np.all(np.hypot(*residual.T) <= _FORCE_TOLERANCE * force):
            return np.asarray(stiffness.mean(axis=0))
        step = np.linalg.solve(stiffness + floor, residual[..., None])[..., 0]
        before, share = energy, np.ones(phases)
        for _halving in range(40):
            trial = at + share[:, None] * step
            carried, stiffness, energy = _states(row, normals, trial, load_n)
            worse = energy > before + 1e-14 * np.abs(before)
            if not np.any(worse):
                break
            share[worse] *= 0.5
        at = trial
    raise ArithmeticError(f"no static equilibrium of {row} under {load_n} N within {_MAX_ITERATIONS} steps")
