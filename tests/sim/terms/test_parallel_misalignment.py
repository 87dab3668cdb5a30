"""Parallel misalignment: the series against the force of the two elements, and where it acts."""

from __future__ import annotations

import numpy as np
import pytest

from sim.assembly.assemble import assemble
from sim.core.elements import STAGES
from sim.core.errors import SpecError
from sim.core.spec import TermSpec
from sim.presets import preset
from sim.solve.collocation import collocation
from sim.solve.plain import plain_context, step_array
from sim.terms.parallel_misalignment import HIGHEST, TERM, harmonics
from tests.strategies.harmonic import allowed, element_of
from tests.strategies.systems import with_terms

GEARBOX = preset("paper-lightly-damped")
POINTS = 2**16


def directly(force, odd, direction, phase, sense, phi):
    """Force of the two elements, (2, points): each presses where the offset brings it nearer."""
    psi = sense * phi + phase
    offset = np.array([np.cos(direction), np.sin(direction)])
    total = np.zeros((2, phi.size))
    for angle, stiffness in ((psi, 1.0), (psi + np.pi, 1.0 - odd)):
        n = np.array([np.cos(angle), np.sin(angle)])
        total -= force * stiffness * np.maximum(offset @ n, 0.0) * n
    return total


@pytest.mark.parametrize("odd", [0.0, 0.3, 1.0])
@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_series_is_the_force_of_the_elements(odd, sense):
    phi = 2.0 * np.pi * np.arange(POINTS) / POINTS
    settings = {"force": 2.0, "odd": odd, "direction": 0.8, "phase": -0.3, "sense": sense}
    waves = harmonics(**settings)
    series = sum(np.outer(h.cosine, np.cos(h.order * phi)) + np.outer(h.sine, np.sin(h.order * phi)) for h in waves)
    found = np.fft.rfft(series, axis=1)[:, :HIGHEST] / POINTS
    exact = np.fft.rfft(directly(**settings, phi=phi), axis=1)[:, :HIGHEST] / POINTS
    assert np.max(np.abs(found - exact)) < 2.0 * allowed(TERM, "test_series_is_the_force_of_the_elements")


def test_second_order_is_a_quarter_of_stiffness_times_offset_each_way():
    wave = next(h for h in harmonics(force=4.0, odd=0.0, direction=0.0, phase=0.0, sense=1.0) if h.order == 2)
    assert wave.cosine == pytest.approx((-2.0, 0.0)) and wave.sine == pytest.approx((0.0, -2.0))


def test_the_element_acts_on_the_first_bearing_with_the_series():
    element = element_of(GEARBOX, "parallel_misalignment", "input", offset=1e-4, stiffness=1e6, odd=0.4)
    assert [c.weights[0][0] for c in element.coordinates] == ["bearing1.inner.x", "bearing1.inner.y"]
    rule = collocation(STAGES)
    step = step_array(0.0, 1e-4, rule.c, rule.lagrange, rule.b)
    phi = np.array([0.3, 1.1, 2.7, 4.0])
    shafts = np.array([phi, np.full(4, 190.0), phi, np.full(4, 190.0)])
    row = plain_context(element, step, shafts, np.zeros(2), np.zeros(2))[:STAGES]
    exact = directly(100.0, 0.4, 0.0, 0.0, 1.0, phi[1:])
    # the series ends at order 15
    assert row == pytest.approx(exact.T, abs=1.5)


def test_a_shaft_whose_gear_cannot_move_is_refused():
    with pytest.raises(SpecError, match="moves in x and y"):
        assemble(with_terms(preset("gear-pair"), TermSpec(term="parallel_misalignment", site="input")))
