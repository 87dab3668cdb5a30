"""Torque ripple against the closed form of two inertias on a spring."""

from __future__ import annotations

import numpy as np
import pytest

from sim.assembly.assemble import assemble
from sim.core.errors import SpecError
from sim.core.spec import TermSpec
from sim.presets import preset
from sim.terms.torque_ripple import TERM
from tests.strategies.harmonic import allowed, element_of, small_system, steady_error
from tests.strategies.systems import with_terms

GEARBOX = preset("paper-lightly-damped")
PART = np.array([[1.0, -1.0], [-1.0, 1.0]])


@pytest.mark.parametrize("order", [1.0, 6.0, 30.0])
def test_steady_state_of_two_inertias(order):
    element = element_of(GEARBOX, "torque_ripple", "input", amplitude=3.0, order=order, phase=0.9)
    inertias, hz = [2.1e-3, 4.4e-4], 30.0
    system = small_system(
        ["input.theta", "pinion.theta"],
        inertias,
        (element,),
        {"input": hz},
        stiffness=4.4e2 * PART,
        damping=0.05 * PART,
    )
    omega = 2.0 * np.pi * hz * order
    error = steady_error(system, 3.0 * np.exp(0.9j) * np.array([1.0, 0.0]), omega, step_s=1e-5, steps=4000)
    assert error < allowed(TERM, "test_steady_state_of_two_inertias")


def test_an_order_is_a_whole_number():
    term = TermSpec(term="torque_ripple", site="input", parameters={"order": 2.5})
    with pytest.raises(SpecError) as caught:
        assemble(with_terms(GEARBOX, term))
    assert caught.value.problems[0].field == "terms.0.parameters.order"


def test_a_shaft_on_which_nothing_turns_is_refused():
    with pytest.raises(SpecError, match="nothing on this shaft can turn"):
        assemble(with_terms(preset("rotor"), TermSpec(term="torque_ripple", site="input")))
