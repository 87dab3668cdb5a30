"""Cubic stiffness: Duffing's backbone, rest under a load, a sensor on a ring, and where it may act."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.special import ellipk

from sim.assembly.assemble import assemble
from sim.core.errors import SpecError
from sim.core.spec import TermSpec
from sim.parts.seat import SENSOR
from sim.presets import preset
from sim.solve.api import simulate
from sim.solve.settings import Settings
from sim.terms.cubic_support import TERM
from tests.strategies.harmonic import allowed, element_of, small_system
from tests.strategies.running import drive
from tests.strategies.systems import with_terms

OSCILLATOR = preset("oscillator")
MASS, STIFFNESS = OSCILLATOR.bodies[0].mass_kg, OSCILLATOR.bodies[0].stiffness_y_n_per_m
CUBIC = 1e13
GEARBOX = preset("paper-lightly-damped")


def spec(site, **values):
    return TermSpec(term="cubic_support", site=site, parameters=values)


@pytest.mark.parametrize("share", [0.1, 1.0, 10.0])
def test_backbone_of_duffings_oscillator(share):
    """`share`: cubic over linear force at the largest displacement."""
    element = element_of(OSCILLATOR, "cubic_support", "mass", cubic=CUBIC)
    system = small_system(["mass.y"], [MASS], (element,), {}, stiffness=[[STIFFNESS]])
    largest = np.sqrt(share * STIFFNESS / CUBIC)
    # x'' + a x + b x^3 = 0: T = 4 K(m) / sqrt(a + b X^2), m = b X^2 / (2 (a + b X^2))  (Nayfeh & Mook, ch. 2)
    sharp = STIFFNESS * (1.0 + share) / MASS
    period = 4.0 * ellipk(0.5 * share / (1.0 + share)) / np.sqrt(sharp)
    states = drive(system, step_s=period / 400.0, steps=1100, start=np.array([largest, 0.0])).states
    limit = allowed(TERM, "test_backbone_of_duffings_oscillator")
    assert abs(states[1100, 0]) < limit * largest
    assert states[800] == pytest.approx([largest, 0.0], abs=limit * largest * np.sqrt(sharp))


def test_a_load_pushes_as_far_as_the_cubic_equation_says():
    run = simulate(
        with_terms(OSCILLATOR, spec("mass", cubic=CUBIC)),
        duration_s=1.5,
        output_rate_hz=1_000.0,
        channels=("mass.y.displacement",),
        settings=Settings(estimate_error=False, anti_alias=False),
    )
    load = OSCILLATOR.loads[0].constant_n
    exact = brentq(lambda x: STIFFNESS * x + CUBIC * x**3 - load, 0.0, load / STIFFNESS, xtol=1e-18)
    assert exact < 0.8 * load / STIFFNESS
    limit = allowed(TERM, "test_a_load_pushes_as_far_as_the_cubic_equation_says")
    assert run.signals[0, -1] == pytest.approx(exact, rel=limit)


@pytest.mark.slow
def test_sensor_on_a_ring_equals_scipy():
    machine = with_terms(GEARBOX, spec("bearing2", cubic=3e17), spec("bearing2", cubic=8e17, spring=SENSOR))
    elements = tuple(e for e in assemble(machine).elements if ".cubic." in e.name)
    assert [e.name for e in elements] == ["bearing2.cubic.y", "resonator2.cubic.y"]
    masses, k, mount, largest = np.array([0.1, 0.5]), 1e8, 2.5e8, 2e-5
    stiffness = np.array([[k + mount, -mount], [-mount, mount]])
    dofs = ["bearing2.outer.y", "resonator2.y"]
    system = small_system(dofs, masses, elements, {}, stiffness=stiffness)
    start = np.array([largest, 0.3 * largest, 0.0, 0.0])
    states = drive(system, step_s=1e-6, steps=2000, start=start).states

    def slope(_, z):
        stretch = z[1] - z[0]
        pull = mount * stretch + 8e17 * stretch**3
        return [z[2], z[3], (pull - k * z[0] - 3e17 * z[0] ** 3) / masses[0], -pull / masses[1]]

    found = solve_ivp(slope, (0.0, 2e-3), start, method="DOP853", rtol=1e-11, atol=1e-16).y[:, -1]
    assert states[-1, :2] == pytest.approx(found[:2], abs=allowed(TERM, "test_sensor_on_a_ring_equals_scipy") * largest)


def test_it_acts_on_the_housing_where_the_ring_has_one():
    machine = with_terms(GEARBOX, spec("bearing2"), TermSpec(term="fit_clearance_series", site="bearing2"))
    element = next(e for e in assemble(machine).elements if e.name == "bearing2.cubic.y")
    assert element.coordinates[0].weights == (("bearing2.housing.y", 1.0),)


def test_both_directions_of_a_gear():
    machine = with_terms(GEARBOX, spec("gear", spring=0.0), spec("gear", spring=1.0))
    names = {e.name for e in assemble(machine).elements}
    assert {"gear.cubic.x", "gear.cubic.y"} <= names


@pytest.mark.parametrize(
    ("machine", "terms", "said"),
    [
        (OSCILLATOR, [spec("mass", spring=0.0)], "does not move along x"),
        (OSCILLATOR, [spec("mass", spring=SENSOR)], "no sensor"),
        (preset("rotor"), [spec("bearing1", spring=SENSOR)], "no sensor"),
        (preset("gear-pair"), [spec("pinion")], "does not move along y"),
        (GEARBOX, [spec("bearing1"), TermSpec(term="fit_clearance", site="bearing1")], "lost its support"),
    ],
)
def test_refusals(machine, terms, said):
    with pytest.raises(SpecError, match=said):
        assemble(with_terms(machine, *terms))
