"""Internal clearance as an effect: the load distribution of the textbook, preload, and cautions."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq

from sim.assembly.assemble import assemble
from sim.terms.radial_clearance import TERM
from tests.strategies.bearings import bearing_with, context_at, element_of, force_at


def test_the_gap_is_the_sum_of_specified_and_changed():
    _, element = element_of(bearing_with(("radial_clearance", {"change": 4e-6}), radial_clearance_m=3e-6))
    assert element.parameters[2] == pytest.approx(7e-6)


def test_the_largest_ball_load_is_that_of_sjovalls_integral():
    # zero clearance in all: epsilon = 0.5, so F = Z Q_max J_r with J_r = 0.2288, on average over the cage's angle
    machine = bearing_with(("radial_clearance", {"change": -5e-6}), radial_clearance_m=5e-6)
    system, element = element_of(machine)
    depth = 1e-5
    forces = [
        force_at(element, context_at(system, element, t), [0.0, -depth])[1]
        for t in np.arange(64) / 64 / system.bases_hz["f_o1"]
    ]
    largest = element.parameters[1] * depth**1.5
    integral = -np.mean(forces) / (9.0 * largest)
    assert integral == pytest.approx(0.2288, rel=TERM.validation[0].deviation)


def test_clearance_lets_the_ring_move_free_and_preload_stiffens():
    forces = {}
    for change in (-1e-5, 0.0, 1e-5):
        system, element = element_of(bearing_with(("radial_clearance", {"change": change})))
        row = context_at(system, element, 0.0)
        forces[change] = brentq(lambda x, e=element, r=row: force_at(e, r, [0.0, -x])[1] + 50.0, 0.0, 1e-4)
    assert forces[-1e-5] < forces[0.0] < forces[1e-5]
    assert forces[1e-5] > 1e-5


def test_a_clearance_beyond_the_loosest_class_is_mentioned():
    system = assemble(bearing_with(("radial_clearance", {"change": 1e-4})))
    assert any("C5" in text and "with its change" in text for text in system.warnings)
    assert not any(
        "with its change" in t for t in assemble(bearing_with(("radial_clearance", {"change": 5e-6}))).warnings
    )
