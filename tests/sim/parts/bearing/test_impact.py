"""Closed forms of a single impact against direct integration."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from sim.parts.bearing.impact import elastic_impact, restitution_linear


def _fly_through(mass_kg: float, speed: float, k: float, exponent: float, damping: float) -> tuple[float, float, float]:
    """Duration, deepest point and rebound speed by integration until the contact force would pull."""

    def force(x: float, v: float) -> float:
        return float(k * max(x, 0.0) ** exponent + damping * v)

    def release(_: float, y: np.ndarray) -> float:
        return force(y[0], y[1]) if y[1] < 0 else 1.0

    release.terminal = True  # type: ignore[attr-defined]
    guess = elastic_impact(mass_kg=mass_kg, speed_m_per_s=speed, stiffness=k, exponent=exponent).duration_s
    run = solve_ivp(
        lambda _, y: [y[1], -force(y[0], y[1]) / mass_kg],
        (0, 4 * guess),
        [0.0, speed],
        rtol=1e-10,
        atol=1e-14,
        events=release,
        max_step=guess / 50,
    )
    return float(run.t[-1]), float(run.y[0].max()), float(-run.y[1, -1])


def test_hertz_impact_closed_form() -> None:
    mass, speed, k = 0.3, 0.05, 1e10
    ours = elastic_impact(mass_kg=mass, speed_m_per_s=speed, stiffness=k, exponent=1.5)
    duration, depth, rebound = _fly_through(mass, speed, k, 1.5, 0.0)
    assert ours.peak_penetration_m == pytest.approx(depth, rel=1e-3)
    assert ours.duration_s == pytest.approx(duration, rel=1e-3)
    assert rebound == pytest.approx(speed, rel=1e-6)
    assert ours.duration_s * speed / ours.peak_penetration_m == pytest.approx(2.9432, abs=1e-3)
    assert ours.peak_force_n == pytest.approx(k * depth**1.5, rel=2e-3)


def test_linear_impact_is_a_half_sine() -> None:
    mass, speed, k = 2.0, 0.1, 1e8
    ours = elastic_impact(mass_kg=mass, speed_m_per_s=speed, stiffness=k, exponent=1.0)
    assert ours.duration_s == pytest.approx(math.pi * math.sqrt(mass / k))
    assert ours.peak_penetration_m == pytest.approx(speed * math.sqrt(mass / k))


@pytest.mark.parametrize("ratio", [0.02, 0.1, 0.3, 0.8])
def test_restitution_of_a_damped_wall_without_adhesion(ratio: float) -> None:
    mass, speed, k = 1.0, 0.2, 1e7
    damping = 2 * ratio * math.sqrt(k * mass)
    _, _, rebound = _fly_through(mass, speed, k, 1.0, damping)
    assert restitution_linear(ratio) == pytest.approx(rebound / speed, rel=1e-3)


def test_restitution_limits() -> None:
    assert restitution_linear(0.0) == 1.0
    with pytest.raises(ValueError, match="damping ratio"):
        restitution_linear(1.0)
