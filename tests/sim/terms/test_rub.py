"""The rub against a rotor in a ring whose force law is written separately and integrated by SciPy."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from sim.assembly.assemble import assemble
from sim.core.errors import SpecError
from sim.core.spec import TermSpec
from sim.presets import preset
from sim.solve.plain import plain_context, plain_force
from sim.terms.rub import TERM
from tests.strategies.harmonic import allowed, element_of, small_system
from tests.strategies.kernels import trials
from tests.strategies.running import drive
from tests.strategies.systems import with_terms

ROTOR, GEARBOX = preset("rotor"), preset("paper-lightly-damped")
MASS, STIFFNESS, DAMPING, HZ, MOMENT = 5.0, 8e5, 200.0, 60.0, 1.5e-3
RUB = {"stiffness": 4e6, "gap": 1e-4, "loss": 0.8, "friction": 0.15, "friction_speed": 0.05, "radius": 0.03}


def separately(t, state):
    """Right-hand side in complex numbers, z = x + i y."""
    z, rate = complex(state[0], state[1]), complex(state[2], state[3])
    total = -STIFFNESS * z - DAMPING * rate
    total += MOMENT * (2.0 * np.pi * HZ) ** 2 * np.exp(2j * np.pi * HZ * t)
    depth = abs(z) - RUB["gap"]
    if depth > 0.0:
        outward = z / abs(z)
        normal, slip = (rate / outward).real, (rate / outward).imag
        load = max(RUB["stiffness"] * depth * (1.0 + RUB["loss"] * normal), 0.0)
        speed = slip + RUB["radius"] * 2.0 * np.pi * HZ
        total -= load * outward * (1.0 + 1j * RUB["friction"] * np.tanh(speed / RUB["friction_speed"]))
    return [rate.real, rate.imag, total.real / MASS, total.imag / MASS]


@pytest.mark.slow
def test_jeffcott_rotor_in_a_ring_equals_scipy():
    step, steps = 5e-6, 24_000
    system = small_system(
        ["disc.x", "disc.y"],
        [MASS, MASS],
        (element_of(ROTOR, "unbalance", "disc", moment=MOMENT), element_of(ROTOR, "rub", "disc", **RUB)),
        {"disc": HZ},
        stiffness=STIFFNESS * np.eye(2),
        damping=DAMPING * np.eye(2),
    )
    found = drive(system, step_s=step, steps=steps).states[:, :2]
    times = step * np.arange(steps + 1)
    run = solve_ivp(separately, (0.0, times[-1]), np.zeros(4), "DOP853", times, rtol=1e-10, atol=1e-14, max_step=1e-4)
    exact = run.y[:2].T
    touching = np.hypot(*run.y[:2]) > RUB["gap"]
    assert 0.05 < np.mean(touching) < 0.95 and np.sum(np.diff(touching.astype(int)) == 1) >= 3
    limit = allowed(TERM, "test_jeffcott_rotor_in_a_ring_equals_scipy")
    assert np.max(np.abs(found - exact)) < limit * np.max(np.abs(exact))


def test_friction_brakes_the_shaft_and_its_heat_comes_from_the_rotation():
    element = element_of(GEARBOX, "rub", "gear", gap=1e-6)
    system = assemble(with_terms(GEARBOX, TermSpec(term="rub", site="gear", parameters={"gap": 1e-6})))
    touched = 0
    for trial in trials(system, element, count=40):
        row = plain_context(element, trial.step, trial.shafts, trial.u, trial.ud)[0]
        found = plain_force(element, 2, trial.u, trial.ud, row)
        stored, lost, supplied = found.outputs[:3]
        dt = 1e-9
        ends = [plain_force(element, 2, trial.u + s * dt * trial.ud, trial.ud, row).outputs[0] for s in (-1, 1)]
        growth = (ends[1] - ends[0]) / (2.0 * dt)
        balance = float(found.force @ trial.ud) + supplied - growth - lost
        assert abs(balance) <= 1e-4 * (abs(lost) + abs(growth)) + 1e-9
        assert stored >= 0.0 and lost >= 0.0 and supplied >= 0.0
        # the rotation of the gear is faster than any whirl here, so the shaft is always braked
        assert found.force[2] >= 0.0
        touched += found.outputs[4] > 0.0
    assert touched > 10


def test_a_radius_beyond_the_gear_is_refused():
    term = TermSpec(term="rub", site="pinion", parameters={"radius": 0.5})
    with pytest.raises(SpecError, match=r"outer radius is 0\.025 m"):
        assemble(with_terms(GEARBOX, term))
