"""Unbalance against the closed form of a Jeffcott rotor."""

from __future__ import annotations

import numpy as np
import pytest

from sim.assembly.assemble import assemble
from sim.core.errors import SpecError
from sim.core.spec import BodySpec, TermSpec
from sim.presets import preset
from sim.terms.unbalance import TERM
from tests.strategies.harmonic import allowed, element_of, small_system, steady_error
from tests.strategies.systems import with_terms

ROTOR = preset("rotor")
MASS, STIFFNESS, DAMPING, MOMENT = 5.0, 8e5, 40.0, 3e-4
CRITICAL_HZ = np.sqrt(STIFFNESS / MASS) / (2.0 * np.pi)


@pytest.mark.parametrize("ratio", [0.3, 1.0, 2.5])
def test_steady_state_of_a_jeffcott_rotor(ratio):
    element = element_of(ROTOR, "unbalance", "disc", moment=MOMENT, phase=0.7)
    hz = ratio * CRITICAL_HZ
    system = small_system(
        ["disc.x", "disc.y"],
        [MASS, MASS],
        (element,),
        {"disc": hz},
        stiffness=STIFFNESS * np.eye(2),
        damping=DAMPING * np.eye(2),
    )
    omega = 2.0 * np.pi * hz
    force = MOMENT * omega**2 * np.exp(0.7j) * np.array([1.0, -1.0j])
    assert steady_error(system, force, omega, step_s=1.0 / (400.0 * hz), steps=1200) < allowed(
        TERM, "test_steady_state_of_a_jeffcott_rotor"
    )


def test_a_body_that_does_not_turn_has_no_unbalance():
    machine = preset("oscillator")
    still = machine.model_copy(update={"bodies": [BodySpec(name="mass", mass_kg=1.0, stiffness_y_n_per_m=1e5)]})
    with pytest.raises(SpecError, match="does not turn"):
        assemble(with_terms(still, TermSpec(term="unbalance", site="mass")))
