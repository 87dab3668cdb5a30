"""The bow of a shaft against closed forms: how the orbit depends on the speed."""

from __future__ import annotations

import numpy as np
import pytest

from sim.assembly.assemble import assemble
from sim.core.errors import SpecError
from sim.core.spec import TermSpec
from sim.presets import preset
from sim.terms.bent_shaft import TERM
from tests.strategies.harmonic import allowed, element_of, small_system, steady_amplitude, steady_error
from tests.strategies.systems import with_terms

ROTOR = preset("rotor")
BOW, DISC, RING = 2e-5, 5.0, 0.3
SHAFT = ROTOR.bearings[0].shaft_stiffness_n_per_m
LOSS = ROTOR.bearings[0].shaft_damping_ns_per_m
CRITICAL_HZ = np.sqrt(2.0 * SHAFT / DISC) / (2.0 * np.pi)


def bowed(hz: float, support: float):
    """Disc and two rings on supports, x and y apart; and the complex force of the bow per axis."""
    names = ["disc", "bearing1.inner", "bearing2.inner"]
    part = np.array([[2.0, -1.0, -1.0], [-1.0, 1.0, 0.0], [-1.0, 0.0, 1.0]])
    stiffness = SHAFT * part + support * np.diag([0.0, 1.0, 1.0])
    damping = LOSS * part
    system = small_system(
        [f"{n}.{a}" for a in "xy" for n in names],
        [DISC, RING, RING] * 2,
        (element_of(ROTOR, "bent_shaft", "disc", bow=BOW, phase=-0.4),),
        {"disc": hz},
        stiffness=np.kron(np.eye(2), stiffness),
        damping=np.kron(np.eye(2), damping),
    )
    omega = 2.0 * np.pi * hz
    # the springs and dampers act on q - d, d = bow exp(i (omega t + phase)) of the disc alone
    along = (SHAFT + 1j * omega * LOSS) * part @ np.array([1.0, 0.0, 0.0]) * BOW * np.exp(-0.4j)
    return system, np.concatenate([along, -1j * along]), omega


@pytest.mark.parametrize("ratio", [0.2, 0.7, 2.0])
def test_steady_state_is_the_closed_form(ratio):
    system, force, omega = bowed(ratio * CRITICAL_HZ, 3e8)
    step = 1.0 / (400.0 * max(ratio, 1.0) * CRITICAL_HZ)
    assert steady_error(system, force, omega, step_s=step, steps=1500) < allowed(
        TERM, "test_steady_state_is_the_closed_form"
    )


@pytest.mark.parametrize("ratio", [0.1, 0.5, 3.0])
def test_on_rigid_bearings_the_orbit_is_that_of_the_textbook(ratio):
    system, force, omega = bowed(ratio * CRITICAL_HZ, 1e15)
    orbit = steady_amplitude(system.mass, 0.0 * system.damping, system.stiffness, force.round(300), omega)[0]
    undamped = SHAFT / (SHAFT + 1j * omega * LOSS)
    assert abs(orbit * undamped) == pytest.approx(BOW / abs(1.0 - ratio**2), rel=1e-4)


def test_a_gear_without_bearings_has_no_bow():
    with pytest.raises(SpecError, match="bearings"):
        assemble(with_terms(preset("gear-pair"), TermSpec(term="bent_shaft", site="pinion")))
