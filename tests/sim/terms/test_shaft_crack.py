"""The breathing crack against the textbook equation of a cracked Jeffcott rotor, integrated by SciPy."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from sim.assembly.assemble import assemble
from sim.core.errors import SpecError
from sim.core.spec import TermSpec
from sim.presets import preset
from sim.terms.shaft_crack import TERM
from tests.strategies.harmonic import allowed, element_of, on, small_system
from tests.strategies.running import drive
from tests.strategies.systems import with_terms

ROTOR = preset("rotor")
SHAFT = ROTOR.bearings[0].shaft_stiffness_n_per_m
MASS, RATIO, LOSS, CROSS, PHASE = 5.0, 0.01, 0.1, 0.2, 0.4
OMEGA = np.sqrt(SHAFT / MASS)
CRITICAL_HZ = OMEGA / (2.0 * np.pi)
DAMPING = 2.0 * RATIO * MASS * OMEGA
WEIGHT = MASS * 9.80665
DOFS = ["disc.x", "disc.y"]


def ours(hz: float, step_s: float, steps: int):
    element = element_of(ROTOR, "shaft_crack", "bearing1", loss=LOSS, cross=CROSS, phase=PHASE)
    system = small_system(
        DOFS,
        [MASS, MASS],
        (on(element, ((DOFS[0], 1.0),), ((DOFS[1], 1.0),)),),
        {"disc": hz},
        stiffness=SHAFT * np.eye(2),
        damping=DAMPING * np.eye(2),
        load=[0.0, -WEIGHT],
    )
    start = np.array([0.0, -WEIGHT / SHAFT, 0.0, 0.0])
    return drive(system, step_s=step_s, steps=steps, start=start).states


def textbook(hz: float, times):
    """m z'' + c z' + (k I - k loss b(t) (xi xi^T + cross eta eta^T)) z = weight, open where xi points down."""

    def rhs(t, state):
        angle = 2.0 * np.pi * hz * t + PHASE
        across = np.array([np.cos(angle), np.sin(angle)])
        along = np.array([-np.sin(angle), np.cos(angle)])
        opened = 0.5 * (1.0 - np.sin(angle))
        place, rate = state[:2], state[2:]
        lost = SHAFT * LOSS * opened * (across * (across @ place) + CROSS * along * (along @ place))
        return np.concatenate([rate, (np.array([0.0, -WEIGHT]) - SHAFT * place - DAMPING * rate + lost) / MASS])

    start = [0.0, -WEIGHT / SHAFT, 0.0, 0.0]
    return solve_ivp(rhs, (0.0, times[-1]), start, method="DOP853", t_eval=times, rtol=1e-11, atol=1e-16).y.T


@pytest.mark.slow
@pytest.mark.parametrize("part", [1.0 / 2.0, 1.0 / 3.0, 0.8])
def test_jeffcott_rotor_equals_scipy(part):
    step, steps = 2e-5, 5000
    found = ours(part * CRITICAL_HZ, step, steps)
    exact = textbook(part * CRITICAL_HZ, step * np.arange(steps + 1))
    scale = np.max(np.abs(exact[:, 0]))
    assert np.max(np.abs(found[:, :2] - exact[:, :2])) < allowed(TERM, "test_jeffcott_rotor_equals_scipy") * scale


def order_amplitude(hz: float, order: int) -> float:
    """Amplitude of the vertical motion at an order of the rotation, after the start has died away, m."""
    per_turn, turns = 200, 20
    settled = int(np.ceil(10.0 / (RATIO * OMEGA) * hz))
    y = ours(hz, 1.0 / (per_turn * hz), per_turn * (settled + turns))[-per_turn * turns :, 1]
    return float(2.0 * np.abs(np.fft.rfft(y)[order * turns]) / y.size)


@pytest.mark.slow
@pytest.mark.parametrize("order", [2, 3])
def test_resonates_where_its_order_meets_the_critical_speed(order):
    speeds = np.array([0.9, 0.95, 0.975, 0.985, 1.0, 1.05, 1.1]) * CRITICAL_HZ / order
    found = [order_amplitude(hz, order) for hz in speeds]
    # the half-open crack softens the rotor by loss (1 + cross) / 4 of its stiffness: 1.5 % of the critical speed
    assert np.argmax(found) == 3
    assert found[3] > 5.0 * max(found[0], found[-1])


def test_the_body_must_move():
    machine = preset("paper-lightly-damped")
    gears = [g.model_copy(update={"translates": False}) if g.name == "pinion" else g for g in machine.gears]
    with pytest.raises(SpecError, match="not a body of a shaft that moves"):
        still = machine.model_copy(update={"gears": gears})
        assemble(with_terms(still, TermSpec(term="shaft_crack", site="bearing1")))
