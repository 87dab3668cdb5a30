"""Curves of the pictures against closed forms written here."""

from __future__ import annotations

import math

import numpy as np
import pytest

from sim.core.spec import MachineSpec, TermSpec
from sim.presets import preset
from sim.solve.law_picture import Panel, law_picture

PAPER = preset("paper-lightly-damped")
PAIR = preset("gear-pair")


def picture(machine: MachineSpec, term: str, site: str, **values: float) -> tuple[Panel, ...]:
    spec = TermSpec(term=term, site=site, parameters=values)
    return law_picture(machine.model_copy(update={"terms": [*machine.terms, spec]}), machine, site=site)


@pytest.mark.slow
def test_a_loose_ring_flies_free_and_meets_palmgrens_line_contact():
    gap, length_mm = 3e-5, 12.0
    panel = picture(PAPER, "fit_clearance", "bearing1", gap=gap, length=length_mm)[0]
    depth_mm = 1e3 * np.clip(np.abs(panel.values) - gap, 0.0, None)
    expected = np.sign(panel.values) * (depth_mm * length_mm**0.8 / 3.83e-5) ** (1 / 0.9)
    (curve,) = panel.curves
    assert panel.values[-1] > 1.2 * gap
    assert curve.here == pytest.approx(expected, rel=1e-6, abs=1e-6 * expected.max())
    support = PAPER.bearings[0].support.stiffness_x_n_per_m
    assert curve.without == pytest.approx(support * panel.values, rel=1e-9)


@pytest.mark.slow
def test_clearance_in_series_carries_what_the_support_carries():
    gap = 2e-5
    panel = picture(PAPER, "fit_clearance_series", "bearing1", gap=gap)[0]
    (curve,) = panel.curves
    free = np.abs(panel.values) < gap * (1 - 1e-9)
    assert np.all(curve.here[free] == 0.0)
    support = PAPER.bearings[0].support.stiffness_x_n_per_m
    held = np.clip(np.abs(panel.values[~free]) - gap, 0.0, None) * support
    # the contact itself gives way too, by far less than the support
    assert np.abs(curve.here[~free]) == pytest.approx(held, rel=0.35, abs=0.02 * held.max())
    assert np.all(np.abs(curve.here[~free]) <= held * (1 + 1e-9) + 1e-9)


@pytest.mark.slow
def test_a_loose_pedestal_is_soft_on_one_side():
    panel = picture(PAPER, "pedestal_looseness", "bearing1", loss=0.7)[0]
    k = PAPER.bearings[0].support.stiffness_y_n_per_m
    (curve,) = panel.curves
    expected = np.where(panel.values > 0.0, 0.3 * k, k) * panel.values
    assert curve.here == pytest.approx(expected, rel=1e-9, abs=1e-9)


@pytest.mark.slow
def test_unbalance_turns_with_the_shaft():
    (panel,) = picture(PAPER, "unbalance", "pinion", moment=4e-4, phase=0.3)
    omega = 2 * math.pi * PAPER.operating.speed_hz
    by_name = {curve.name: curve.here for curve in panel.curves}
    size = 4e-4 * omega**2
    assert np.hypot(by_name["x"], by_name["y"]) == pytest.approx(size, rel=1e-9)
    assert by_name["x"] == pytest.approx(size * np.cos(panel.values + 0.3), abs=1e-6 * size)


@pytest.mark.slow
def test_run_out_moves_the_mesh_once_a_turn_by_its_radius():
    panel = picture(PAPER, "eccentricity", "pinion", radius=1e-5)[0]
    (curve,) = panel.curves
    assert panel.y.unit == "m" and panel.values[-1] > 6.2
    once = 2 * abs(np.mean(curve.here * np.exp(-1j * panel.values)))
    # the centre distance changes the stiffness under the load as well
    assert once == pytest.approx(1e-5, rel=0.12)


@pytest.mark.slow
def test_backlash_leaves_a_dead_zone_of_its_width():
    width = 4e-5
    panel = picture(PAIR, "backlash", "mesh1", width=width)[0]
    (curve,) = panel.curves
    open_ = panel.values[np.abs(curve.here) < 1e-9]
    assert open_.min() == pytest.approx(-width, abs=2 * np.diff(panel.values)[0])
    assert open_.max() == pytest.approx(0.0, abs=2 * np.diff(panel.values)[0])
    assert np.all(curve.without[np.abs(panel.values) > 1e-9] != 0.0)


@pytest.mark.slow
def test_a_crack_softens_one_pair_and_the_mesh_around_it_only():
    pair, mesh, error = picture(PAPER, "tooth_crack", "pinion", depth=0.4)
    (curve,) = pair.curves
    assert pair.y.unit == mesh.y.unit == "N/m" and error.y.unit == "m"
    assert np.all(curve.here <= curve.without * (1 + 1e-12))
    lost = mesh.curves[0].without - mesh.curves[0].here
    assert np.count_nonzero(lost > 1e-6 * lost.max()) < 0.5 * lost.size
    # a softer pair in parallel: no more than that pair alone can lose
    assert 0.0 < lost.max() <= np.max(curve.without - curve.here) * (1 + 1e-3)


@pytest.mark.slow
def test_tooth_friction_turns_round_at_the_pitch_point_and_is_mu_n():
    found = picture(PAPER, "tooth_friction", "mesh1", coefficient=0.08, speed=0.01)
    panel = next(p for p in found if p.y.unit == "N" and p.x.unit == "rad")
    (curve,) = panel.curves
    torque = next(load.torque_nm for load in PAPER.loads if load.kind == "torque" and load.shaft == "input")
    pinion = PAPER.gears[0]
    base_m = 0.5 * pinion.module_m * pinion.teeth * math.cos(math.radians(pinion.pressure_angle_deg))
    assert np.max(np.abs(curve.here)) == pytest.approx(0.08 * abs(torque) / base_m, rel=0.03)
    assert curve.here.min() < 0.0 < curve.here.max()


def test_an_added_mass_pushes_back_most_at_its_own_frequency():
    mass, hz, ratio = 0.2, 600.0, 0.05
    values = {"mass": mass, "frequency": hz, "damping_ratio": ratio}
    panel, spring = picture(PAPER, "support_mode", "bearing1", **values)
    r = panel.values / hz
    k = mass * (2 * math.pi * hz) ** 2
    joined = 1 + 2j * ratio * r
    expected = np.abs(k * r**2 * joined / (joined - r**2))
    (curve,) = panel.curves
    assert curve.here == pytest.approx(expected, rel=1e-6, abs=1e-6 * k)
    assert spring.curves[0].here == pytest.approx(k * spring.values, rel=1e-9)


@pytest.mark.slow
def test_a_spall_is_drawn_where_it_lies_and_as_deep_as_it_is():
    rotor = preset("rotor")
    panel, force = picture(rotor, "outer_spall", "bearing1", width=1.5e-3, angle=-1.0)
    (curve,) = panel.curves
    middle = panel.values[curve.here > 0.5 * curve.here.max()].mean()
    assert middle == pytest.approx(-1.0, abs=0.01)
    assert force.x.label == "Angle of disc" and np.ptp(force.curves[0].here - force.curves[0].without) > 0


def test_machines_that_are_alike_have_nothing_to_show():
    assert law_picture(PAPER, PAPER, site="pinion") == ()
