"""Couplings with play and with a stiffening spring: periods of free motion in closed form."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.special import ellipk

from sim.assembly.assemble import assemble
from sim.core.errors import SpecError
from sim.core.spec import TermSpec
from sim.presets import preset
from sim.terms.coupling_backlash import TERM as BACKLASH
from sim.terms.coupling_nonlinearity import TERM as HARDENING
from sim.terms.coupling_nonlinearity import TWIST_RAD
from tests.strategies.harmonic import allowed, element_of, small_system
from tests.strategies.running import drive
from tests.strategies.systems import with_terms

GEARBOX = preset("paper-lightly-damped")
STIFFNESS = GEARBOX.shafts[0].torsional_stiffness_nm_per_rad
INERTIAS = (2.1e-3, 4.4e-4)
REDUCED = INERTIAS[0] * INERTIAS[1] / sum(INERTIAS)
PART = np.array([[1.0, -1.0], [-1.0, 1.0]])


def twist_after(element, time_s: float, twist: float, steps: int):
    """Twist and its rate after a time, from rest at `twist`; and the twist at every step."""
    system = small_system(["input.theta", "pinion.theta"], INERTIAS, (element,), {}, stiffness=STIFFNESS * PART)
    share = INERTIAS[1] / sum(INERTIAS)
    start = np.array([share * twist, (share - 1.0) * twist, 0.0, 0.0])
    states = drive(system, step_s=time_s / steps, steps=steps, start=start).states
    return states[:, 0] - states[:, 1], states[:, 2] - states[:, 3]


@pytest.mark.parametrize("twist", [3e-4, 2e-3])
def test_period_of_a_stiffening_spring(twist):
    element = element_of(GEARBOX, "coupling_nonlinearity", "input", hardening=2.0)
    linear, cubic = STIFFNESS / REDUCED, 2.0 * STIFFNESS / TWIST_RAD**2 / REDUCED
    # x'' + a x + b x^3 = 0: T = 4 K(m) / sqrt(a + b X^2), m = b X^2 / (2 (a + b X^2))  (Nayfeh & Mook, ch. 2)
    sharp = linear + cubic * twist**2
    period = 4.0 * ellipk(0.5 * cubic * twist**2 / sharp) / np.sqrt(sharp)
    found, _ = twist_after(element, 0.25 * period, twist, 400)
    assert abs(found[-1]) < allowed(HARDENING, "test_period_of_a_stiffening_spring") * twist


def test_period_with_a_gap():
    gap, twist = 2e-4, 5e-4
    element = element_of(GEARBOX, "coupling_backlash", "input", gap=gap)
    omega = np.sqrt(STIFFNESS / REDUCED)
    fastest = omega * (twist - 0.5 * gap)
    quarter = 0.5 * np.pi / omega + 0.5 * gap / fastest
    found, rate = twist_after(element, quarter, twist, 4000)
    limit = allowed(BACKLASH, "test_period_with_a_gap")
    assert abs(found[-1]) < limit * twist
    assert rate[-1] == pytest.approx(-fastest, rel=limit)


@pytest.mark.parametrize("key", ["coupling_backlash", "coupling_nonlinearity"])
def test_a_shaft_without_an_end_mass_has_no_coupling(key):
    with pytest.raises(SpecError, match="end mass"):
        assemble(with_terms(preset("gear-pair"), TermSpec(term=key, site="input")))
