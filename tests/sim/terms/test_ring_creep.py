"""Creep of the outer ring: kinematics of two turning rings, and the comb of lines around the outer-race frequency."""

from __future__ import annotations

import numpy as np
import pytest

from sim.assembly.assemble import assemble
from sim.parts.bearing.frequencies import bearing_speeds
from sim.parts.bearing.geometry import from_diameters
from sim.terms.ring_creep import TERM
from tests.strategies.bearings import bearing_with, element_of, gaps_at

GEOMETRY = from_diameters(balls=9, ball_diameter_m=0.00794, pitch_diameter_m=0.03904)


@pytest.mark.parametrize("ratio", [1e-3, 0.05, 0.1])
def test_cage_and_ball_passes_are_those_of_two_turning_rings(ratio):
    bases = assemble(bearing_with(("ring_creep", {"ratio": ratio}))).bases_hz
    expected = bearing_speeds(GEOMETRY, inner=30.0, outer=30.0 * ratio)
    allowed = TERM.validation[0].deviation
    assert bases["f_c1"] == pytest.approx(expected.cage, rel=allowed)
    assert bases["f_i1"] == pytest.approx(expected.inner_pass, rel=allowed)
    assert bases["f_b1"] == pytest.approx(expected.ball_spin, rel=allowed)
    assert bases["f_o1"] - 9 * bases["f_e1"] == pytest.approx(expected.outer_pass, rel=allowed)


def test_slip_and_creep_act_together():
    bases = assemble(bearing_with(("ring_creep", {"ratio": 0.05}), ("cage_slip", {"share": 0.02}))).bases_hz
    cage = bearing_speeds(GEOMETRY, inner=30.0, outer=1.5).cage
    assert bases["f_c1"] == pytest.approx(0.98 * cage, rel=1e-12)


@pytest.mark.slow
def test_balls_pass_the_mark_at_the_predicted_rate():
    machine = bearing_with(("ring_creep", {"ratio": 0.05}), ("outer_spall", {"width": 1e-3}))
    system, element = element_of(machine)
    line = next(line for line in system.lines if line.mechanism == TERM.key)
    rate = line.frequency_hz(system.bases_hz)
    times = np.linspace(0.0, 40.0 / rate, 4001)
    deepest = np.array([np.max(gaps_at(system, element, t, 9)[0]) for t in times])
    passes = np.sum((deepest[1:] > 0.0) & (deepest[:-1] == 0.0))
    assert passes == pytest.approx(40, abs=1)
