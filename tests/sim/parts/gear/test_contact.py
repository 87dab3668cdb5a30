"""Path of contact at the current centre distance."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sim.core.errors import SpecError
from sim.parts.gear import ContactGeometry, GearGeometry, GearPair, standard_centre_distance_m
from sim.parts.gear.contact import centre_distances_m


def gear(teeth: int, shift: float = 0.0, addendum: float = 1.0) -> GearGeometry:
    """Module 2 mm."""
    return GearGeometry(
        teeth=teeth,
        module_m=2e-3,
        face_width_m=0.02,
        bore_radius_m=0.3e-3 * teeth,
        youngs_modulus_pa=2.06e11,
        profile_shift_coefficient=shift,
        addendum_coefficient=addendum,
    )


def test_contact_ratio_of_the_seeds_pair(paper_pair: Callable[..., GearPair]) -> None:
    """The textbook formula by tip pressure angles gives 1.71."""
    tips = [z * math.acos(z * math.cos(math.radians(20)) / (z + 2)) for z in (23, 81)]
    direct = sum(
        z * (math.tan(tip / z) - math.tan(math.radians(20))) for z, tip in zip((23, 81), tips, strict=True)
    ) / (2 * math.pi)
    assert paper_pair().contact().contact_ratio == pytest.approx(direct, rel=1e-12)
    assert direct == pytest.approx(1.71, abs=0.005)


@given(st.integers(20, 120), st.integers(20, 120), st.floats(-0.05, 0.1))
def test_working_angle_and_contact_ratio_follow_the_distance(z1: int, z2: int, share: float) -> None:
    """cos a' = (Rb1 + Rb2)/a; wider apart: larger angle, shorter path; the ends lie on the tip circles."""
    one, two = gear(z1), gear(z2)
    a0 = standard_centre_distance_m(one, two)
    near = ContactGeometry.between(one, two, a0)
    far = ContactGeometry.between(one, two, a0 + share * one.module_m)
    assert math.cos(far.working_angle_rad) * far.centre_distance_m == pytest.approx(
        one.base_radius_m + two.base_radius_m, rel=1e-13
    )
    assert (far.contact_ratio - near.contact_ratio) * share <= 0
    assert math.hypot(far.end_m, one.base_radius_m) == pytest.approx(one.tip_radius_m, rel=1e-12)
    assert math.hypot(far.line_length_m - far.start_m, two.base_radius_m) == pytest.approx(two.tip_radius_m, rel=1e-12)
    assert far.start_m < far.pitch_point_m < far.end_m
    assert 1 <= far.contact_ratio < 2


def test_standard_distance_with_profile_shift() -> None:
    """Shifts of opposite sign keep m (z1+z2)/2; a positive sum opens it, without backlash on the working circles."""
    assert standard_centre_distance_m(gear(20, 0.3), gear(40, -0.3)) == pytest.approx(0.06)
    one, two = gear(20, 0.3), gear(40, 0.2)
    a = standard_centre_distance_m(one, two)
    working = math.acos((one.base_radius_m + two.base_radius_m) / a)
    pitch = 2 * math.pi * one.base_radius_m / math.cos(working) / one.teeth
    inv = math.tan(working) - working
    thickness = sum(2 * g.base_radius_m / math.cos(working) * (g.base_half_angle_rad - inv) for g in (one, two))
    assert a > 0.06
    assert thickness == pytest.approx(pitch, rel=1e-10)


@pytest.mark.parametrize(
    ("pinion", "wheel", "distance_m", "message"),
    [
        (gear(12), gear(80), None, "interference: the tip of the gear"),
        (gear(80), gear(12), None, "interference: the tip of the pinion"),
        (gear(30, addendum=0.4), gear(30, addendum=0.4), None, "contact ratio below 1"),
        (gear(30), gear(30), 0.0640, "contact ratio below 1"),
        (gear(30), gear(30), 0.05, "too small: the teeth reach into each other"),
        (gear(30), gear(30), 0.0594, "too small: the teeth reach into each other"),
    ],
)
def test_pairs_that_cannot_work(
    pinion: GearGeometry, wheel: GearGeometry, distance_m: float | None, message: str
) -> None:
    """Interference, contact ratio below 1, impossible distances."""
    with pytest.raises(SpecError, match=message):
        GearPair(pinion=pinion, gear=wheel, centre_distance_m=distance_m)


@pytest.mark.parametrize(("z1", "z2"), [(23, 81), (30, 30), (18, 60)])
def test_the_distances_that_work_are_told_and_work(z1: int, z2: int) -> None:
    """Within the bounds the pair is legal, a micrometre beyond it is not; the message has them, rounded inwards."""
    one, two = gear(z1), gear(z2)
    least, most = centre_distances_m(one, two)
    assert least < standard_centre_distance_m(one, two) < most
    widest = GearPair(pinion=one, gear=two, centre_distance_m=most - 1e-9)
    assert widest.contact().contact_ratio == pytest.approx(1.0, abs=1e-5)
    GearPair(pinion=one, gear=two, centre_distance_m=least + 1e-9)
    for distance in (least - 1e-6, most + 1e-6, 1e-320, 1.0):
        with pytest.raises(SpecError) as caught:
            GearPair(pinion=one, gear=two, centre_distance_m=distance)
        (problem,) = caught.value.problems
        low, high = map(float, problem.allowed.split(" to "))
        assert (problem.field, problem.unit) == ("centre_distance_m", "m")
        assert least <= low <= least + 1e-7 and most - 1e-7 <= high <= most


def test_unequal_modules_are_refused() -> None:
    """The base pitches must agree."""
    with pytest.raises(SpecError) as caught:
        GearPair(pinion=gear(30), gear=replace(gear(30), module_m=2.5e-3))
    assert caught.value.problems[0].field == "gear.module_m"


def test_undercut_is_a_warning() -> None:
    """At 20 degrees and ha* = 1 a rack undercuts below 17.1 teeth."""
    assert any("undercut" in w for w in GearPair(pinion=gear(17), gear=gear(17)).warnings)
    assert not any("undercut" in w for w in GearPair(pinion=gear(18), gear=gear(18)).warnings)
