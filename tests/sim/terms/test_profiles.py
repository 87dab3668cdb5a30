"""Balls on profiles: gaps, their rates and the work of rolling, with everything a bearing can have at once."""

from __future__ import annotations

import numpy as np
import pytest

from sim.core.elements import STAGES
from sim.solve.plain import plain_context, plain_force
from tests.strategies.bearings import bearing_with, context_at, element_of, gaps_at
from tests.strategies.kernels import compiled_context, compiled_force, trials

EVERYTHING = (
    ("outer_spall", {"width": 2e-3}),
    ("inner_spall", {"width": 1.5e-3}),
    ("ball_spall", {"width": 2e-3}),
    ("outer_waviness", {"amplitude": 3e-6, "order": 11.0}),
    ("inner_waviness", {"amplitude": 2e-6, "order": 17.0}),
    ("ring_creep", {"ratio": 0.03}),
    ("cage_slip", {"share": 0.02}),
    ("radial_clearance", {"change": 4e-6}),
)
RACES = tuple(item for item in EVERYTHING if item[0] != "ball_spall")
SETS = {"everything": EVERYTHING, "races": RACES}
BALLS = 9
TIMES_S = (0.0, 0.0123, 0.31, 2.7)


@pytest.mark.parametrize("terms", SETS.values(), ids=SETS)
def test_compiled_equals_plain(terms):
    system, element = element_of(bearing_with(*terms))
    for trial in trials(system, element, count=6):
        plain = plain_context(element, trial.step, trial.shafts, trial.u, trial.ud)
        compiled = compiled_context(element, trial)
        scale = np.max(np.abs(plain), axis=0)
        assert np.all(np.abs(compiled - plain)[:STAGES] <= 1e-9 * scale)
        for mode in (0, 1, 2):
            expected = plain_force(element, mode, trial.u, trial.ud, plain[0])
            force, _ = compiled_force(element, mode, trial.u, trial.ud, plain[0])
            assert force == pytest.approx(expected.force, rel=1e-12)


def test_gaps_are_those_of_the_tables_at_the_angles_of_rolling():
    system, element = element_of(bearing_with(*EVERYTHING))
    gamma, creep, slip, speed = 0.00794 / 0.03904, 0.03, 0.02, 2.0 * np.pi * 30.0
    par = element.parameters
    n = int(par[0])
    outer, inner, ball = np.split(par[8 + 3 * n + 3 :], 3)
    grid = 2.0 * np.pi * np.arange(2049) / 2048
    tables = [np.append(t, t[0]) for t in (outer, inner, ball)]
    sense = float(np.sign(par[3]))
    for t in TIMES_S:
        phi = speed * t
        cage = sense * (0.5 * (1 - gamma) + 0.5 * creep * (1 + gamma)) * (1 - slip) * phi
        spin = (1 - gamma**2) / (2 * gamma) * (1 - slip) * (1 - creep) * phi
        angles = cage + 2.0 * np.pi * np.arange(BALLS) / BALLS
        expected = np.full(BALLS, 4e-6)
        expected += np.interp((angles - sense * creep * phi) % (2 * np.pi), grid, tables[0])
        expected += np.interp((angles - sense * phi) % (2 * np.pi), grid, tables[1])
        expected[0] += np.interp(spin % (2 * np.pi), grid, tables[2])
        gaps, _ = gaps_at(system, element, t, BALLS)
        assert gaps == pytest.approx(expected, abs=1e-12)


def test_rates_of_gaps_are_their_derivatives():
    system, element = element_of(bearing_with(*EVERYTHING))
    dt = 1e-9
    for t in (0.01, 0.2, 0.777):
        rates = gaps_at(system, element, t, BALLS)[1]
        sides = [gaps_at(system, element, t + s * dt, BALLS)[0] for s in (-1, 1)]
        assert (sides[1] - sides[0]) / (2 * dt) == pytest.approx(rates, abs=1e-4 * np.max(np.abs(rates)))


def test_stored_energy_changes_by_what_moves_the_ring_and_what_rolls():
    system, element = element_of(bearing_with(*EVERYTHING))
    rng = np.random.default_rng(4)
    dt = 1e-9
    for t in rng.uniform(0.0, 1.0, 8):
        u, ud = rng.normal(size=2) * 3e-5, rng.normal(size=2) * 1e-2
        now = plain_force(element, 2, u, ud, context_at(system, element, t))
        sides = [
            plain_force(element, 2, u + s * dt * ud, ud, context_at(system, element, t + s * dt)).outputs[0]
            for s in (-1, 1)
        ]
        rate = (sides[1] - sides[0]) / (2 * dt)
        put_in = float(now.force @ ud) + now.outputs[2]
        assert rate == pytest.approx(put_in, abs=1e-3 * (abs(float(now.force @ ud)) + abs(now.outputs[2])) + 1e-6)


def test_a_bearing_without_profiles_keeps_a_short_context():
    _, element = element_of(bearing_with(("cage_slip", {"share": 0.02})))
    assert element.context == 2 * int(element.parameters[0]) + 1
