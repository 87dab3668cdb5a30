"""Helical pairs: contact ratios, thrust and the smoothing of the mesh stiffness, in closed form."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sim.core.errors import SpecError
from sim.core.spec import GearSpec, MeshSpec
from sim.parts.gear import GearPair, build_pair_table, interpolation_error, mesh_summary, total_table
from sim.parts.gear.from_spec import gear_from_spec, pair_from_spec
from sim.parts.gear.helix import Helix, base_helix_rad, cumulative, helix_of, spread
from sim.parts.gear.pair import pair_stiffness_n_per_m
from sim.parts.gear.summary import mean_stiffness_n_per_m


def spec(name, teeth, helix_deg, width_m=0.024):
    return GearSpec(name=name, shaft=name, teeth=teeth, module_m=0.002, face_width_m=width_m, helix_angle_deg=helix_deg)


def pair(helix_deg, width_m=0.024):
    gears = spec("pinion", 23, helix_deg, width_m), spec("gear", 81, -helix_deg, width_m)
    return pair_from_spec(*gears, MeshSpec(name="mesh1", pinion="pinion", gear="gear")).pair


def with_overlap(overlap, helix_deg=15.0):
    """A pair whose width makes the overlap ratio."""
    return pair(helix_deg, overlap * math.pi * 0.002 / math.tan(math.radians(helix_deg)))


@given(
    helix_deg=st.floats(1.0, 40.0),
    normal_module=st.floats(1e-3, 1e-2),
    width=st.floats(5e-3, 0.2),
    normal_angle_deg=st.floats(14.0, 25.0),
)
def test_overlap_and_base_helix_from_the_normal_section(helix_deg, normal_module, width, normal_angle_deg):
    """ISO 21771: eps_beta = b sin(beta)/(pi m_n), sin(beta_b) = sin(beta) cos(alpha_n)."""
    helix, normal = math.radians(helix_deg), math.radians(normal_angle_deg)
    transverse = math.atan(math.tan(normal) / math.cos(helix))
    found = helix_of(helix, transverse, normal_module / math.cos(helix), width)
    assert found.overlap_ratio == pytest.approx(width * math.sin(helix) / (math.pi * normal_module))
    assert math.sin(found.base_angle_rad) == pytest.approx(math.sin(helix) * math.cos(normal))
    assert base_helix_rad(-helix, transverse) == -found.base_angle_rad


def test_heights_are_in_normal_modules_and_radii_in_transverse_ones():
    gear = gear_from_spec(spec("pinion", 23, 20.0)).geometry
    normal_module = 0.002 * math.cos(math.radians(20.0))
    assert gear.pitch_radius_m == pytest.approx(0.023)
    assert gear.tip_radius_m - gear.pitch_radius_m == pytest.approx(normal_module)
    assert gear.pitch_radius_m - gear.root_radius_m == pytest.approx(1.25 * normal_module)


def test_a_helix_of_nothing_is_a_spur_gear():
    spur, nearly = pair(0.0), pair(1e-4)
    position = np.linspace(0.01, 1.5, 40)
    expected = pair_stiffness_n_per_m(spur, position)
    assert pair_stiffness_n_per_m(nearly, position) == pytest.approx(expected, rel=1e-3)
    assert nearly.engagement() == pytest.approx(spur.contact().contact_ratio, abs=1e-4)


def test_mates_need_opposite_hands():
    right = gear_from_spec(spec("pinion", 23, 15.0)).geometry
    with pytest.raises(SpecError, match="opposite hands"):
        GearPair(pinion=right, gear=gear_from_spec(spec("gear", 81, 15.0)).geometry)


def test_cumulative_integral_is_simpsons():
    x = np.linspace(0.0, 2.0, 1025)
    assert cumulative(np.exp(x)[None], float(x[1]))[0] == pytest.approx(np.exp(x) - 1.0, abs=1e-9)


def test_a_constant_pair_becomes_a_trapezium():
    """The overlap of two boxes, 1 and 0.6 long: rises over 0.6, stays, falls."""
    helix = Helix(overlap_ratio=0.6, base_angle_rad=0.0)
    position = np.array([-0.1, 0.0, 0.3, 0.6, 0.8, 1.0, 1.3, 1.6, 1.7])
    found = spread(np.ones(65), 1.0, helix, position)
    assert found == pytest.approx([0.0, 0.0, 0.5, 1.0, 1.0, 1.0, 0.5, 0.0, 0.0], abs=1e-12)


@pytest.mark.parametrize("overlap", [1.0, 2.0])
def test_a_whole_overlap_ratio_makes_the_total_stiffness_constant(overlap):
    """The average of a periodic curve over a whole number of periods."""
    helical = with_overlap(overlap)
    total = total_table(helical, np.zeros(1), columns=200).stiffness_n_per_m[0]
    assert np.ptp(total) < 1e-4 * total.mean()
    straight = replace(
        helical, pinion=replace(helical.pinion, helix_rad=0.0), gear=replace(helical.gear, helix_rad=0.0)
    )
    factor = math.cos(helical.helix.base_angle_rad)
    assert total.mean() == pytest.approx(factor * mean_stiffness_n_per_m(straight), rel=1e-5)
    assert mean_stiffness_n_per_m(helical) == pytest.approx(total.mean(), rel=1e-5)


def test_half_an_overlap_smooths_the_jumps_to_ramps():
    spur, half = pair(0.0, 0.02), with_overlap(0.5)
    jumps = [np.abs(np.diff(total_table(p, np.zeros(1), columns=500).stiffness_n_per_m[0])) for p in (spur, half)]
    means = [mean_stiffness_n_per_m(p) for p in (spur, half)]
    assert jumps[0].max() / means[0] > 0.3
    assert jumps[1].max() / means[1] < 0.005


@pytest.mark.slow
def test_slices_one_by_one_give_the_same_curve():
    """200 thin slices of one width, each a spur pair that starts later by its share of the overlap."""
    helical = with_overlap(0.7)
    straight = replace(
        helical, pinion=replace(helical.pinion, helix_rad=0.0), gear=replace(helical.gear, helix_rad=0.0)
    )
    position = np.linspace(0.0, helical.engagement(), 97)[1:-1]
    late = 0.7 * (np.arange(200) + 0.5) / 200
    slices = pair_stiffness_n_per_m(straight, position[:, None] - late[None, :]).mean(axis=1)
    factor = math.cos(helical.helix.base_angle_rad)
    found = pair_stiffness_n_per_m(helical, position)
    assert found == pytest.approx(factor * slices, abs=5e-3 * found.max())


@pytest.mark.slow
def test_the_table_of_a_helical_pair_is_as_good_as_its_corners():
    helical = with_overlap(0.7)
    table = build_pair_table(helical, centre_distance_errors_m=np.linspace(-1e-4, 1e-4, 9), points=257)
    assert table.contact_ratio[4] == pytest.approx(helical.contact().contact_ratio + 0.7)
    xi = (np.arange(255) + 1.5) / 256
    exact = pair_stiffness_n_per_m(helical, xi * helical.engagement())
    found = table.pair_n_per_m(xi * helical.engagement())
    assert np.abs(found - exact).max() < 2e-3 * exact.max()
    assert interpolation_error(table, helical).contact_ratio_absolute < 1e-4


def test_the_summary_says_both_ratios():
    found = mesh_summary(with_overlap(0.7))
    assert found["overlap_ratio"] == pytest.approx(0.7)
    assert found["min_n_per_m"] > 0.8 * found["mean_n_per_m"]
