"""Sizes and clearances of bearings against the catalogue and published tables."""

from __future__ import annotations

import pytest

from sim.core.spec import BallGeometry
from sim.parts.bearing.catalogue import catalogue
from sim.parts.bearing.clearances import largest_internal_clearance_m, loosest_seat_m, tolerance_unit_m
from sim.parts.bearing.size import RING_SHARE, bearing_size
from sim.presets import preset

BEARING = preset("rotor").bearings[0]


def test_a_designation_brings_its_own_sizes():
    size = bearing_size(BEARING.model_copy(update={"catalogue": "6205", "geometry": None}))
    assert (size.bore_m, size.outside_m) == pytest.approx((0.025, 0.052))
    assert not size.estimated


def test_a_ratio_alone_has_no_size():
    geometry = BallGeometry(balls=7, diameter_ratio=0.2647)
    assert bearing_size(BEARING.model_copy(update={"geometry": geometry})) is None


def test_estimates_agree_with_the_catalogue():
    rows = [r for r in catalogue().values() if r.bore_m and r.outside_m]
    assert len(rows) > 20
    for row in rows:
        reach = RING_SHARE * row.ball_diameter_m
        assert row.pitch_diameter_m - reach == pytest.approx(row.bore_m, rel=0.1), row.designation
        assert row.pitch_diameter_m + reach == pytest.approx(row.outside_m, rel=0.04), row.designation


@pytest.mark.parametrize(
    ("bore_mm", "um"),
    [(8, 37), (10, 37), (12, 45), (20, 48), (25, 53), (35, 64), (50, 73), (60, 105), (70, 105), (100, 120)],
)
def test_class_c5(bore_mm, um):
    assert largest_internal_clearance_m(1e-3 * bore_mm) == pytest.approx(1e-6 * um)


def test_bores_beyond_the_table_are_not_judged():
    assert largest_internal_clearance_m(0.12) is None


@pytest.mark.parametrize(
    # geometric means of the steps 18-30, 50-80 and 120-180 mm; IT6 = 10 i, IT7 = 16 i, IT11 = 100 i as tabulated
    ("low_mm", "high_mm", "factor", "um", "rounding"),
    [(18, 30, 10, 13, 0.5), (50, 80, 16, 30, 0.5), (50, 80, 100, 190, 5), (120, 180, 100, 250, 5)],
)
def test_tolerances_of_iso_286(low_mm, high_mm, factor, um, rounding):
    assert 1e6 * factor * tolerance_unit_m(1e-3 * (low_mm * high_mm) ** 0.5) == pytest.approx(um, abs=rounding)


def test_the_loosest_seat_is_two_tolerances_across_the_diameter():
    assert 2.0 * loosest_seat_m(0.052) == pytest.approx(2 * 180e-6, rel=0.06)
