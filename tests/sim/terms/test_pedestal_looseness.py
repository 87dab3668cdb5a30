"""Pedestal looseness against the closed form of a bilinear oscillator."""

from __future__ import annotations

import numpy as np
import pytest

from sim.assembly.assemble import assemble
from sim.core.errors import SpecError
from sim.core.spec import SupportSpec, TermSpec
from sim.presets import preset
from sim.terms.pedestal_looseness import TERM
from tests.strategies.harmonic import allowed, element_of, small_system
from tests.strategies.running import drive
from tests.strategies.systems import with_terms

ROTOR = preset("rotor")
STIFFNESS, MASS = ROTOR.bearings[0].support.stiffness_y_n_per_m, 2.0


@pytest.mark.parametrize("loss", [0.2, 0.5, 0.95])
def test_natural_frequency_of_a_bilinear_oscillator(loss):
    element = element_of(ROTOR, "pedestal_looseness", "bearing1", loss=loss)
    system = small_system(["bearing1.outer.y"], [MASS], (element,), {}, stiffness=[[STIFFNESS]])
    pressed, lifted = (np.sqrt(k / MASS) / (2.0 * np.pi) for k in (STIFFNESS, (1.0 - loss) * STIFFNESS))
    period = (pressed + lifted) / (2.0 * pressed * lifted)
    fast = 0.1
    states = drive(system, step_s=period / 2000.0, steps=2000, start=np.array([0.0, fast])).states
    largest = np.max(states[:, 0])
    assert largest == pytest.approx(fast / (2.0 * np.pi * lifted), rel=1e-3)
    assert np.min(states[:, 0]) == pytest.approx(-fast / (2.0 * np.pi * pressed), rel=1e-3)
    limit = allowed(TERM, "test_natural_frequency_of_a_bilinear_oscillator")
    assert abs(states[-1, 0]) < limit * 2.0 * np.pi * largest


def test_it_acts_on_the_housing_where_the_ring_has_one():
    machine = with_terms(
        preset("paper-lightly-damped"),
        TermSpec(term="pedestal_looseness", site="bearing2"),
        TermSpec(term="fit_clearance_series", site="bearing2"),
    )
    element = next(e for e in assemble(machine).elements if e.name == "bearing2.looseness")
    assert element.coordinates[0].weights == (("bearing2.housing.y", 1.0),)


def test_a_support_without_stiffness_cannot_be_loose():
    free = SupportSpec(stiffness_x_n_per_m=5e7, stiffness_y_n_per_m=0.0)
    bearings = [ROTOR.bearings[0].model_copy(update={"support": free}), ROTOR.bearings[1]]
    machine = ROTOR.model_copy(update={"bearings": bearings})
    with pytest.raises(SpecError, match="no stiffness along y"):
        assemble(with_terms(machine, TermSpec(term="pedestal_looseness", site="bearing1")))
