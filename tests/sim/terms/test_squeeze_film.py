"""Squeeze film: closed forms of the short cavitated film, the integral of its pressure, and what it does to a rotor."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sim.core.spec import TermSpec
from sim.presets import preset
from sim.solve.api import simulate
from sim.solve.plain import plain_force
from sim.solve.settings import Settings
from sim.terms.squeeze_film import LEAST_FILM, TERM
from tests.strategies.bearings import bearing_with, element_of
from tests.strategies.systems import with_terms

DAMPING, FILM_M = 5e3, 1e-4
_, ELEMENT = element_of(bearing_with(("squeeze_film", {"damping": DAMPING, "film": FILM_M})), "bearing1.film")


def film_force(u, v):
    return plain_force(ELEMENT, 0, np.asarray(u, dtype=float), np.asarray(v, dtype=float), np.zeros(1)).force


@pytest.mark.parametrize("ratio", [0.0, 0.1, 0.4, 0.7, 0.8])
def test_circular_orbits_give_the_closed_forms(ratio):
    # radial displacement along x, velocity along y
    fx, fy = film_force([ratio * FILM_M, 0.0], [0.0, 1e-2])
    allowed = TERM.validation[0].deviation
    assert fy == pytest.approx(DAMPING * 1e-2 / (1.0 - ratio**2) ** 1.5, rel=allowed)
    assert fx == pytest.approx(DAMPING * 1e-2 * 4.0 / np.pi * ratio / (1.0 - ratio**2) ** 2, rel=allowed, abs=1e-12)


NODES, WEIGHTS = np.polynomial.legendre.leggauss(400)


def written_anew(u, v):
    """Force of the pressure where the film is squeezed: over half the circle, where it is smooth, by Gauss's rule."""
    angle = np.arctan2(v[1], v[0]) + 0.5 * np.pi * NODES
    n = np.array([np.cos(angle), np.sin(angle)])
    push = 2.0 / np.pi * DAMPING * FILM_M**3 * np.maximum(v @ n, 0.0) / (FILM_M - u @ n) ** 3
    return 0.5 * np.pi * (n * push) @ WEIGHTS


@settings(max_examples=30, deadline=None)
@given(ratio=st.floats(0.0, 0.8), place=st.floats(0.0, 6.28), speed=st.floats(1e-4, 1.0), heading=st.floats(0.0, 6.28))
def test_any_motion_gives_the_integral_of_the_pressure(ratio, place, speed, heading):
    u = ratio * FILM_M * np.array([np.cos(place), np.sin(place)])
    v = speed * np.array([np.cos(heading), np.sin(heading)])
    expected = written_anew(u, v)
    assert film_force(u, v) == pytest.approx(expected, abs=TERM.validation[1].deviation * np.hypot(*expected))


@given(u=st.tuples(*[st.floats(-3e-4, 3e-4)] * 2), v=st.tuples(*[st.floats(-1.0, 1.0)] * 2))
def test_it_takes_energy_even_beyond_its_bore(u, v):
    force = film_force(u, v)
    assert np.all(np.isfinite(force))
    assert force @ np.array(v) >= 0.0
    assert np.hypot(*force) <= 2.0 * DAMPING * np.hypot(*v) / LEAST_FILM**3


def test_without_motion_there_is_no_force():
    assert np.all(film_force([5e-5, 0.0], [0.0, 0.0]) == 0.0)


def test_a_small_motion_is_damped_as_by_a_dashpot():
    plain = preset("rotor")
    bearings = [
        b.model_copy(
            update={"support": b.support.model_copy(update={"damping_x_ns_per_m": 4e3, "damping_y_ns_per_m": 4e3})}
        )
        for b in plain.bearings
    ]
    dashpot = plain.model_copy(update={"bearings": bearings})
    films = [TermSpec(term="squeeze_film", site=b.name, parameters={"damping": 2e3, "film": 1e-3}) for b in bearings]
    runs = [
        simulate(machine, duration_s=0.1, output_rate_hz=12_000.0, settings=Settings(estimate_error=False)).signals
        for machine in (dashpot, with_terms(plain, *films))
    ]
    assert runs[1] == pytest.approx(runs[0], abs=0.02 * np.max(np.abs(runs[0])))
