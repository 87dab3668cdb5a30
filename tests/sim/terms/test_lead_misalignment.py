"""Thin slices against a wedge on a bed of springs, and what the shifted load does to the shafts."""

from __future__ import annotations

import numpy as np
import pytest

from sim.assembly.assemble import assemble
from sim.core.spec import TermSpec
from sim.presets import preset
from sim.solve.api import simulate
from sim.solve.settings import Settings
from sim.terms import REGISTRY
from tests.strategies.meshes import at_phase, element_of
from tests.strategies.systems import with_terms

PLAIN = preset("paper-lightly-damped")
MESH = PLAIN.meshes[0].model_copy(update={"transmission_error": type(PLAIN.meshes[0].transmission_error)()})
MACHINE = PLAIN.model_copy(update={"meshes": [MESH]})
WIDTH_M, LENGTH_M = 0.024, 0.26
ALLOWED = REGISTRY.get("lead_misalignment").validation[0].deviation


def misaligned(angle):
    return assemble(with_terms(MACHINE, TermSpec(term="lead_misalignment", site="mesh1", parameters={"angle": angle})))


@pytest.mark.parametrize("angle", [1e-4, -3e-4, 1e-3, 3e-3])
@pytest.mark.parametrize("deflection", [5e-6, 2e-5])
def test_load_of_a_wedge_on_a_bed_of_springs(angle, deflection):
    """All touch: F = k d. In part, b = (d + |t| W/2)/|t|: F = k |t| b^2 / (2 W), W/2 - b/3 off the middle."""
    system = misaligned(angle)
    u = np.array([deflection, 0.0, 0.0, 0.0, 0.0])
    found = at_phase(element_of(system, "mesh1"), 23, 0.85, u, np.zeros(5))
    own = np.array([0.0, 0.0, 0.0, 0.0, deflection, 0.0, 0.0])
    tilting = at_phase(element_of(system, "mesh1.tilting"), 23, 0.85, own, np.zeros(7))
    whole = at_phase(element_of(assemble(MACHINE), "mesh1"), 23, 0.85, u, np.zeros(5))
    k, steep = whole.outputs[3], abs(angle)
    touching = (deflection + 0.5 * steep * WIDTH_M) / steep
    if touching >= WIDTH_M:
        load, moment = k * deflection, k * steep * WIDTH_M**2 / 12.0
    else:
        load = 0.5 * k * steep * touching**2 / WIDTH_M
        moment = load * (0.5 * WIDTH_M - touching / 3.0)
    # a cut of the slices' width at most half a slice off, whose load is small there
    assert found.force[0] == pytest.approx(load, rel=ALLOWED)
    assert tilting.outputs[4] == pytest.approx(-np.sign(angle) * moment, rel=ALLOWED)
    assert tilting.force[3] == pytest.approx(np.sign(angle) * moment / LENGTH_M, rel=ALLOWED)


def test_tilt_of_the_shafts_counts_as_the_angle_does():
    """A tilt of the shafts by the angle lacking gives the same load as the whole angle."""
    element, other = (element_of(misaligned(a), "mesh1") for a in (6e-4, 2e-4))
    given = at_phase(element, 23, 0.85, np.array([1e-5, 0, 0, 0, 0.0]), np.zeros(5))
    tilted = at_phase(other, 23, 0.85, np.array([1e-5, 0, 0, 0, 4e-4 * LENGTH_M]), np.zeros(5))
    assert tilted.force[0] == pytest.approx(given.force[0], rel=1e-9)


@pytest.mark.slow
def test_the_moment_loads_the_bearings_of_a_shaft_unequally():
    term = TermSpec(term="lead_misalignment", site="mesh1", parameters={"angle": 1e-3})
    channels = tuple(f"bearing{i}.inner.y.displacement" for i in range(1, 5))
    run = {"duration_s": 0.1, "output_rate_hz": 12_000.0, "channels": channels}
    settings = Settings(estimate_error=False)
    plain = simulate(MACHINE, settings=settings, **run).signals[:, 600:].mean(axis=1)
    bent = simulate(with_terms(MACHINE, term), settings=settings, **run)
    moved = bent.signals[:, 600:].mean(axis=1) - plain
    assert bent.quality.energy.acceptable
    # opposite couples on the two shafts
    assert moved[0] * moved[1] < 0.0
    assert moved[2] * moved[3] < 0.0
    assert moved[0] * moved[2] < 0.0


def test_the_stiffness_reported_is_that_of_the_slices_that_touch():
    """5 um of deflection at 1e-3 rad: b = (d + |t| W/2)/|t| = 17 mm of 24."""
    u = np.array([5e-6, 0, 0, 0, 0.0])
    whole = at_phase(element_of(assemble(MACHINE), "mesh1"), 23, 0.85, u, np.zeros(5)).outputs[3]
    part = at_phase(element_of(misaligned(1e-3), "mesh1"), 23, 0.85, u, np.zeros(5)).outputs[3]
    assert part == pytest.approx(whole * 17.0 / 24.0, abs=whole / 15.0)


def test_the_tilt_reported_has_a_sign():
    element = element_of(misaligned(3e-4), "mesh1")
    tilts = [
        at_phase(element, 23, 0.85, np.array([1e-5, 0, 0, 0, side * 4e-4 * LENGTH_M]), np.zeros(5)).outputs[5]
        for side in (1.0, -1.0)
    ]
    assert tilts == pytest.approx([4e-4, -4e-4], rel=1e-9)
