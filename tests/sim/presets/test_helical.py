"""A helical gearbox: thrust as a couple on flexible shafts, quieter mesh, refusals."""

from __future__ import annotations

import math

import numpy as np
import pytest

from sim.assembly.assemble import assemble
from sim.core.errors import SpecError
from sim.presets import preset
from sim.solve.api import simulate
from sim.solve.settings import Settings

ALPHA = math.radians(20.0)
RATE_HZ = 24_000.0
FAST = Settings(estimate_error=False)


def helical(angle_deg, width_m=0.02):
    """The overhung gearbox with helical teeth of the same transverse section, without weight and run-out."""
    machine = preset("overhung")
    hands = {"pinion": angle_deg, "gear": -angle_deg}
    gears = [g.model_copy(update={"helix_angle_deg": hands[g.name], "face_width_m": width_m}) for g in machine.gears]
    return machine.model_copy(update={"gears": gears, "gravity_m_per_s2": 0.0, "terms": []})


@pytest.mark.slow
def test_ratio_and_thrust_are_reported():
    derived = assemble(helical(15.0)).derived
    overlap = 0.02 * math.tan(math.radians(15.0)) / (math.pi * 0.0025)
    assert f"overlap {overlap:.6g}" in derived["mesh1.contact_ratio"]
    thrust = 25.0 / (0.5 * 0.0025 * 21) * math.tan(math.radians(15.0))
    assert derived["mesh1.axial_force_n"].startswith(f"derived: {thrust:.6g} N")


@pytest.mark.slow
def test_more_pairs_than_are_summed_are_refused_and_one_total_curve_is_not():
    machine = helical(35.0, width_m=0.03)
    with pytest.raises(SpecError, match="tooth_pairs"):
        assemble(machine)
    meshes = [m.model_copy(update={"tooth_pairs": False}) for m in machine.meshes]
    assert assemble(machine.model_copy(update={"meshes": meshes})).elements


@pytest.mark.slow
@pytest.mark.parametrize("angle_deg", [15.0, -15.0])
def test_the_thrust_tilts_the_shafts(angle_deg):
    """Couple of the axial force at the pitch radius over the bearing span, beside the levers of tooth force.

    A right-handed driver that turns from y to x is pushed along -z (right-hand rule).
    """
    machine = helical(angle_deg)
    bearings = [b.name for b in machine.bearings]
    wanted = tuple(f"{b}.outer.{a}.displacement" for b in bearings for a in "xy")
    run = simulate(machine, duration_s=0.8, output_rate_hz=RATE_HZ, channels=wanted, settings=FAST)
    turns = round(6 / 30.0 * RATE_HZ)
    stiffness = machine.bearings[0].support.stiffness_x_n_per_m
    found = -stiffness * np.array([[run.signal(w)[-turns:].mean() for w in wanted[i : i + 2]] for i in (0, 2, 4, 6)])
    radii = 0.5 * 0.0025 * 21, 0.5 * 0.0025 * 64
    tangential = 25.0 / radii[0]
    thrust = -tangential * math.tan(math.radians(angle_deg))
    force = np.array([-tangential * math.tan(ALPHA), tangential])
    expected = []
    for load, at, bearing, couple in (
        (force, 0.17, (0.015, 0.125), -radii[0] * thrust),
        (-force, 0.08, (0.01, 0.15), -radii[1] * thrust),
    ):
        # moments in the xz and yz planes about the first bearing; the couple acts in xz only
        span = bearing[1] - bearing[0]
        second = -(load * (at - bearing[0]) + np.array([couple, 0.0])) / span
        expected += [-load - second, second]
    assert found == pytest.approx(np.array(expected), abs=3e-3 * tangential)


@pytest.mark.slow
def test_an_overlap_of_one_silences_the_mesh():
    """The stiffness no longer varies; what remains is the transmission error, off here."""
    width = math.pi * 0.0025 / math.tan(math.radians(20.0))
    levels = []
    for angle in (0.0, 20.0):
        machine = helical(angle, width_m=width)
        quiet = machine.meshes[0].transmission_error.model_copy(update={"amplitude_m": 0.0})
        machine = machine.model_copy(
            update={"meshes": [machine.meshes[0].model_copy(update={"transmission_error": quiet})]}
        )
        run = simulate(machine, duration_s=1.0, output_rate_hz=RATE_HZ, settings=FAST)
        assert run.quality.energy.acceptable
        levels.append(run.signals[:, -12_000:].std(axis=1).max())
    assert levels[1] < 0.05 * levels[0]
