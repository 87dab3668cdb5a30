"""Angular misalignment against the exact kinematics and statics of Hooke's joint."""

from __future__ import annotations

import numpy as np
import pytest

from sim.assembly.assemble import assemble
from sim.core.errors import SpecError
from sim.core.spec import TermSpec
from sim.presets import preset
from sim.terms.angular_misalignment import TERM, bending_harmonics, twist_harmonics
from tests.strategies.harmonic import allowed
from tests.strategies.systems import with_terms

GEARBOX = preset("paper-lightly-damped")
PHI = np.linspace(0.0, 2.0 * np.pi, 721)


def evaluated(waves, phi, omega=0.0):
    total = 0.0
    for h in waves:
        cosine, sine = np.array(h.cosine), np.array(h.sine)
        if h.cosine_rate:
            cosine = cosine + omega * np.array(h.cosine_rate)
            sine = sine + omega * np.array(h.sine_rate)
        total = total + np.outer(cosine, np.cos(h.order * phi)) + np.outer(sine, np.sin(h.order * phi))
    return total


@pytest.mark.parametrize("angle", [0.01, 0.2, 0.52])
def test_twist_is_that_of_hookes_joint(angle):
    psi = PHI + 0.3
    driven = np.arctan2(np.sin(psi), np.cos(psi) * np.cos(angle))
    twist = np.angle(np.exp(1j * (driven - psi)))
    found = evaluated(twist_harmonics(angle, 0.3, 1.0, 0.0), PHI)[0]
    limit = allowed(TERM, "test_twist_is_that_of_hookes_joint")
    assert np.max(np.abs(found - twist)) < limit * np.max(np.abs(twist)) + 1e-16


def test_the_damper_sees_the_rate_of_the_twist():
    waves, omega, step = twist_harmonics(0.4, 0.3, 1.0, 0.0), 190.0, 1e-7
    rate = (evaluated(waves, PHI + omega * step) - evaluated(waves, PHI - omega * step)) / (2.0 * step)
    found = evaluated(twist_harmonics(0.4, 0.3, 0.0, 1.0), PHI, omega)
    assert found == pytest.approx(rate, abs=1e-6 * np.max(np.abs(rate)))


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_bending_is_the_torque_along_the_normal_of_the_cross(sense):
    angle, direction, phase, torque, length = 0.3, 0.5, -0.2, 40.0, 0.26
    psi = sense * PHI + phase
    fork = np.array([np.cos(psi), np.sin(psi), 0.0 * psi])
    other = np.array([np.sin(angle) * np.cos(direction), np.sin(angle) * np.sin(direction), np.cos(angle)])
    normal = np.cross(fork.T, np.cross(other, fork.T))
    couple = torque * normal / normal[:, 2:]
    # the bearing at +z feels F with F_x L = m_y and F_y L = -m_x, the one at -z the opposite
    exact = np.array([couple[:, 1], -couple[:, 0]]) / length
    found = evaluated(bending_harmonics(torque * np.tan(angle) / length, direction, phase, sense), PHI)
    assert found == pytest.approx(exact, abs=1e-12 * np.max(np.abs(exact)))


def test_elements_twist_the_spring_and_load_both_bearings():
    system = assemble(with_terms(GEARBOX, TermSpec(term="angular_misalignment", site="output")))
    twist, bending = (next(e for e in system.elements if e.name == f"output.joint.{k}") for k in ("twist", "bending"))
    assert dict(twist.coordinates[0].weights) == {"gear.theta": 1.0, "output.theta": -1.0}
    assert dict(bending.coordinates[0].weights) == {"bearing4.inner.x": 1.0, "bearing3.inner.x": -1.0}


def test_torque_of_the_driven_shaft_comes_from_the_balance():
    system = assemble(with_terms(GEARBOX, TermSpec(term="angular_misalignment", site="output")))
    element = next(e for e in system.elements if e.name == "output.joint.bending")
    load = system.load[system.index("output.theta")]
    # orders 0 (row 2..10) and 2: the steady force is half the couple over the length
    assert abs(element.parameters[7]) == pytest.approx(0.5 * abs(load) * np.tan(0.02) / 0.26, rel=1e-9)


def test_a_shaft_with_neither_is_refused():
    with pytest.raises(SpecError, match="angular_misalignment cannot act here"):
        assemble(with_terms(preset("gear-pair"), TermSpec(term="angular_misalignment", site="input")))
