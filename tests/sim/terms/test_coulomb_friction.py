"""Dry friction: shorter half swings, creep, stick-slip, and where it may act."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from sim.assembly.assemble import assemble
from sim.core.errors import SpecError
from sim.core.spec import TermSpec
from sim.parts.seat import SENSOR
from sim.presets import preset
from sim.solve.api import simulate
from sim.solve.settings import Settings
from sim.terms.coulomb_friction import TERM
from tests.strategies.harmonic import allowed, element_of, small_system
from tests.strategies.running import drive
from tests.strategies.systems import with_terms

OSCILLATOR = preset("oscillator")
MASS, STIFFNESS = 1.0, 1e5
STEP_S = 1.0 / 60_000.0


def friction(**values):
    return element_of(OSCILLATOR, "coulomb_friction", "mass", **values)


def test_every_half_swing_is_shorter_by_the_same_length():
    force, largest = 10.0, 0.95e-3
    element = friction(force=force, friction_speed=1e-6)
    system = small_system(["mass.y"], [MASS], (element,), {}, stiffness=[[STIFFNESS]])
    half = np.pi / np.sqrt(STIFFNESS / MASS)
    states = drive(system, step_s=STEP_S, steps=round(6.5 * half / STEP_S), start=np.array([largest, 0.0])).states
    lost = 2.0 * force / STIFFNESS
    # +0.95, -0.75, 0.55, -0.35, +0.15 mm, and from there to +0.05 mm, where the spring no longer overcomes it
    ends = [(-1) ** k * (largest - k * lost) for k in range(5)] + [largest - 4.5 * lost]
    found = [states[round(k * half / STEP_S), 0] for k in range(7)]
    limit = allowed(TERM, "test_every_half_swing_is_shorter_by_the_same_length")
    assert found == pytest.approx([*ends, ends[-1]], abs=limit * largest)


@pytest.mark.parametrize("load", [1.0, 4.0])
def test_what_should_stick_creeps(load):
    system = small_system(["mass.y"], [MASS], (friction(force=5.0),), {}, load=[load])
    speed = drive(system, step_s=STEP_S, steps=600, rtol=3e-4).states[-1, 1]
    assert speed == pytest.approx(1e-4 * np.arctanh(load / 5.0), rel=allowed(TERM, "test_what_should_stick_creeps"))


def test_stick_slip_equals_scipy():
    drawn, mass, span = 5e-3, 0.5, 0.1
    element = friction(force=5.0, rest_ratio=2.0, rest_speed=2e-3)
    part = np.array([[1.0, -1.0], [-1.0, 1.0]])
    system = small_system(["mass.y", "pull.y"], [mass, 1e9], (element,), {}, stiffness=STIFFNESS * part)
    steps = round(span / STEP_S)
    states = drive(system, step_s=STEP_S, steps=steps, start=np.array([0.0, 0.0, 0.0, drawn]), rtol=3e-4).states

    def slope(t, z):
        rubs = 5.0 * (1.0 + np.exp(-((z[1] / 2e-3) ** 2))) * np.tanh(z[1] / 1e-4)
        return [z[1], (STIFFNESS * (drawn * t - z[0]) - rubs) / mass]

    times = STEP_S * np.arange(steps + 1)
    exact = solve_ivp(slope, (0.0, times[-1]), [0.0, 0.0], method="LSODA", rtol=1e-10, atol=1e-14, t_eval=times).y
    assert 0.5 < np.mean(np.abs(exact[1]) < 5e-4) < 0.9  # it sticks most of the time
    assert np.max(exact[1]) > 4.0 * drawn  # and slips between
    stretch = np.max(drawn * times - exact[0])
    assert states[:, 0] == pytest.approx(exact[0], abs=allowed(TERM, "test_stick_slip_equals_scipy") * stretch)


def test_energy_is_kept_in_a_machine_that_rubs():
    machine = preset("paper-lightly-damped")
    terms = [TermSpec(term="coulomb_friction", site="bearing2", parameters={"joint": j}) for j in (0.0, 1.0, SENSOR)]
    run = simulate(
        with_terms(machine, *terms), duration_s=0.1, output_rate_hz=30_000.0, settings=Settings(estimate_error=False)
    )
    assert run.quality.unconverged_steps == 0
    assert run.quality.energy.relative_residual < 1e-3
    assert run.quality.energy.dissipated_j["bearing2.friction.y"] > 0.0


def test_the_sensor_rubs_on_its_ring():
    machine = with_terms(
        preset("paper-lightly-damped"),
        TermSpec(term="coulomb_friction", site="bearing3", parameters={"joint": SENSOR}),
    )
    element = next(e for e in assemble(machine).elements if ".friction." in e.name)
    assert element.coordinates[0].weights == (("resonator3.y", 1.0), ("bearing3.outer.y", -1.0))


def test_it_holds_nothing():
    bodies = [OSCILLATOR.bodies[0].model_copy(update={"stiffness_y_n_per_m": 0.0})]
    loose = OSCILLATOR.model_copy(update={"bodies": bodies})
    with pytest.raises(SpecError, match=r"nothing holds mass\.y"):
        assemble(with_terms(loose, TermSpec(term="coulomb_friction", site="mass")))


def test_a_released_ring_has_no_joint():
    terms = (
        TermSpec(term="coulomb_friction", site="bearing1"),
        TermSpec(term="fit_clearance", site="bearing1"),
    )
    with pytest.raises(SpecError, match="lost its support"):
        assemble(with_terms(preset("paper-lightly-damped"), *terms))
