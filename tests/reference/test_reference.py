"""The reference solutions are met: instantaneous accelerations of the four resonators, after 50 ms."""

from __future__ import annotations

import numpy as np
import pytest

from sim.solve.api import simulate
from sim.solve.settings import Settings
from tests.reference.cases import load

RATE_HZ = 30_000.0
LIMIT = 1e-3
REGULAR = ("tabled_healthy", "lightly_damped_healthy", "tabled_clearance_20um", "lightly_damped_clearance_20um")
SENSORS = tuple(f"resonator{i}.y" for i in range(1, 5))


def errors(case, ours, theirs, dofs, start_s, end_s):
    chosen = slice(round(start_s * RATE_HZ), round(end_s * RATE_HZ))
    found = []
    for k, dof in enumerate(dofs):
        reference = theirs[chosen, case.column(dof)]
        found.append(np.linalg.norm(ours[k, chosen] - reference) / np.linalg.norm(reference))
    return found


def run(case, channels, steps_per_output=2, duration_s=0.2):
    settings = Settings(anti_alias=False, estimate_error=False, steps_per_output=steps_per_output)
    return simulate(
        case.machine, duration_s=duration_s, output_rate_hz=RATE_HZ, channels=channels, settings=settings
    ).signals


@pytest.mark.slow
@pytest.mark.parametrize("steps_per_output", [1, 2])
@pytest.mark.parametrize("name", REGULAR)
def test_accelerations_of_the_sensors(name, steps_per_output):
    case = load(name)
    ours = run(case, tuple(f"{dof}.acceleration" for dof in SENSORS), steps_per_output)
    assert max(errors(case, ours, case.a, SENSORS, 0.05, 0.2)) <= LIMIT


@pytest.mark.parametrize("name", REGULAR[1::2])
def test_displacement_of_every_degree_of_freedom(name):
    case = load(name)
    dofs = ("pinion.y", "gear.y", "bearing1.inner.y", "bearing1.outer.y", "resonator1.y", "input.theta")
    ours = run(case, tuple(f"{dof}.displacement" for dof in dofs))
    assert max(errors(case, ours, case.q, dofs, 0.05, 0.2)) <= LIMIT


def test_rattle_follows_for_twenty_milliseconds():
    case = load("rattle_light_torque")
    ours = run(case, tuple(f"{dof}.acceleration" for dof in SENSORS), 2, 0.02)
    assert max(errors(case, ours, case.a, SENSORS, 0.0, 0.02)) <= 4e-3


def test_rattle_has_the_level_of_the_reference():
    case = load("rattle_light_torque")
    ours = run(case, tuple(f"{dof}.acceleration" for dof in SENSORS))
    chosen = slice(1500, 6000)
    for k, dof in enumerate(SENSORS):
        theirs = case.a[chosen, case.column(dof)]
        assert np.std(ours[k, chosen]) == pytest.approx(np.std(theirs), rel=0.1)
