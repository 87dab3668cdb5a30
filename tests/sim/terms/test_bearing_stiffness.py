"""A support that hardens: its free period, its rest, and where it stands."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.special import ellipk

from sim.assembly.assemble import assemble
from sim.core.errors import SpecError
from sim.core.spec import TermSpec
from sim.presets import preset
from sim.terms.bearing_stiffness import TERM, rest_m
from tests.strategies.bearings import bearing_with, element_of
from tests.strategies.running import drive
from tests.strategies.systems import bare_system, with_terms


def test_the_free_period_is_the_elliptic_integral():
    # x'' + w0^2 x + a x^3 = 0 from rest at A: T = 4 K(m) / sqrt(w0^2 + a A^2), m = a A^2 / (2 (w0^2 + a A^2))
    _, element = element_of(bearing_with(("bearing_stiffness", {})), "bearing1.hardening")
    amplitude, mass, linear = 3e-5, 0.2, 5e7
    cubic = float(element.parameters[0])
    assert cubic == pytest.approx(5e7 * 0.5 / 1e-5**2)
    moved = tuple(
        replace(c, weights=((f"ring.{axis}", 1.0),)) for c, axis in zip(element.coordinates, "xy", strict=True)
    )
    system = bare_system(
        ("ring.x", "ring.y"),
        (mass, mass),
        stiffness=np.eye(2) * linear,
        elements=(replace(element, coordinates=moved, shafts=("", "")),),
    )
    step = 2e-6
    run = drive(system, step_s=step, steps=1200, start=np.array([amplitude, 0.0, 0.0, 0.0]))
    x = run.states[:, 0]
    down = np.flatnonzero((x[:-1] > 0.0) & (x[1:] <= 0.0))
    # linear between two steps of 1/200 period, around a zero without curvature
    crossings = step * (down + x[down] / (x[down] - x[down + 1]))
    stiff = linear / mass + cubic / mass * amplitude**2
    expected = 4.0 * ellipk(0.5 * cubic / mass * amplitude**2 / stiff) / np.sqrt(stiff)
    assert crossings.size > 3
    assert np.mean(np.diff(crossings)) == pytest.approx(expected, rel=TERM.validation[0].deviation)


@pytest.mark.parametrize("load", [0.0, 1.0, 500.0])
@pytest.mark.parametrize("cubic", [0.0, 1e15, 1e21])
def test_rest_carries_the_load(load, cubic):
    x = rest_m(load, 5e7, cubic)
    assert 5e7 * x + cubic * x**3 == pytest.approx(load, rel=1e-9)


def test_in_a_series_fit_the_housing_is_what_the_support_holds():
    machine = with_terms(
        preset("rotor"),
        TermSpec(term="fit_clearance_series", site="bearing1"),
        TermSpec(term="bearing_stiffness", site="bearing1"),
    )
    element = next(e for e in assemble(machine).elements if e.name == "bearing1.hardening")
    assert element.coordinates[0].weights == (("bearing1.housing.x", 1.0),)


def test_a_released_ring_has_no_support_to_harden():
    machine = with_terms(
        preset("rotor"),
        TermSpec(term="fit_clearance", site="bearing1"),
        TermSpec(term="bearing_stiffness", site="bearing1"),
    )
    with pytest.raises(SpecError, match="cannot act together"):
        assemble(machine)
