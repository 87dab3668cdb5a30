"""SciPy as an oracle: the same machines through right-hand sides that share nothing with the stepping method."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from sim.assembly.assemble import assemble
from sim.presets import names, preset
from sim.solve.oracle import compiled_rhs, plain_rhs
from tests.strategies.running import drive
from tests.strategies.systems import every_term_machine, gear_pairs, rotors

MACHINES = {name: preset(name) for name in names()} | {"every term": every_term_machine()}
FEW = settings(max_examples=6, deadline=None, suppress_health_check=[HealthCheck.too_slow])


@pytest.mark.parametrize("name", MACHINES)
def test_compiled_right_hand_side_equals_the_plain_one(name):
    system = assemble(MACHINES[name])
    n = len(system.dofs)
    fast, slow = compiled_rhs(system), plain_rhs(system)
    rng = np.random.default_rng(3)
    for _ in range(5):
        y = np.concatenate([rng.normal(size=n) * 3e-5, rng.normal(size=n) * 1e-2])
        t = rng.uniform(0.0, 1.0)
        expected = slow(t, y)
        assert fast(t, y) == pytest.approx(expected, abs=1e-11 * np.max(np.abs(expected)))


def integrate(system, end_s, method):
    """To a twentieth of what is compared at least: a tolerance a hundred times finer changes the end by up to 4e-5."""
    rhs = compiled_rhs(system)
    n = len(system.dofs)
    atol = np.concatenate([np.full(n, 1e-13), np.full(n, 1e-10)])
    found = solve_ivp(lambda t, y: rhs(t, y).copy(), (0.0, end_s), np.zeros(2 * n), method=method, rtol=1e-6, atol=atol)
    assert found.success
    return found.y[:, -1]


def agree(machine, end_s, method):
    system = assemble(machine)
    n = len(system.dofs)
    ours = drive(system, step_s=end_s / 600, steps=600, rtol=1e-8).states[-1]
    theirs = integrate(system, end_s, method)
    for part in (slice(0, n), slice(n, 2 * n)):
        assert np.linalg.norm(ours[part] - theirs[part]) <= 1e-3 * np.linalg.norm(theirs[part])


@pytest.mark.slow
@given(machine=rotors(), method=st.sampled_from(["Radau", "LSODA"]))
@FEW
def test_random_rotors(machine, method):
    agree(machine, 0.00973, method)


@pytest.mark.slow
@given(machine=gear_pairs(), method=st.sampled_from(["Radau", "LSODA"]))
@FEW
def test_random_gear_pairs(machine, method):
    agree(machine, 0.00871, method)


@pytest.mark.parametrize("name", ["rotor", "gear-pair"])
def test_small_presets(name):
    agree(preset(name), 0.00631, "LSODA")
