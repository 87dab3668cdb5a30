"""One tooth pair: parts, symmetry, legal gears, published single stiffness."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from sim.core.errors import SpecError
from sim.parts.gear import GearGeometry, GearPair
from sim.parts.gear.pair import pair_compliance, pair_stiffness_n_per_m

MakePair = Callable[..., GearPair]


def test_equal_gears_are_symmetric_about_the_middle() -> None:
    """z1 = z2: entering looks like leaving in reverse."""
    gear = GearGeometry(teeth=40, module_m=3e-3, face_width_m=0.03, bore_radius_m=0.018, youngs_modulus_pa=2.06e11)
    for model in ("clamped_at_base", "true_root"):
        pair = GearPair(pinion=gear, gear=gear, root_model=model)
        ratio = pair.contact().contact_ratio
        u = np.linspace(0.01, 0.99, 41) * ratio
        np.testing.assert_allclose(pair_stiffness_n_per_m(pair, u), pair_stiffness_n_per_m(pair, ratio - u), rtol=1e-10)


def test_exchanging_the_gears_reverses_the_path(paper_pair: MakePair) -> None:
    """The pair doesn't know which gear drives."""
    pair = paper_pair()
    other = replace(pair, pinion=pair.gear, gear=pair.pinion)
    ratio = pair.contact().contact_ratio
    u = np.linspace(0.01, 0.99, 41) * ratio
    np.testing.assert_allclose(pair_stiffness_n_per_m(pair, u), pair_stiffness_n_per_m(other, ratio - u), rtol=1e-10)


def test_zero_outside_engagement(paper_pair: MakePair) -> None:
    """Sharp ends, at any centre distance."""
    pair = paper_pair()
    for error in (-2e-4, 0.0, 2e-4):
        ratio = pair.contact(error).contact_ratio
        found = pair_stiffness_n_per_m(pair, np.array([-1e-9, 0.0, ratio - 1e-9, ratio, 5.0]), error)
        np.testing.assert_array_equal(found > 0, [False, True, True, False, False])


def test_offset_angle_enters_by_cosine_and_arm(paper_pair: MakePair) -> None:
    """Even in the tilt, softer when tilted; at a tilt without torsion only cos^2 on the beam parts."""
    pair = paper_pair(mean_deflection_m=1.0)  # a bed so soft that the load's centre stays
    u, tilt = np.array([0.3, 0.9, 1.5]), 0.2
    parts = pair_compliance(pair, pair.contact(), u)
    beam = parts.bending + parts.shear + parts.axial
    want = parts.hertz + parts.foundation + math.cos(tilt) ** 2 * beam
    np.testing.assert_allclose(1 / pair_stiffness_n_per_m(pair, u, 0.0, tilt), want, rtol=1e-6)
    real = paper_pair()
    tilted = pair_stiffness_n_per_m(real, u, 0.0, 1e-3)
    np.testing.assert_allclose(tilted, pair_stiffness_n_per_m(real, u, 0.0, -1e-3), rtol=1e-14)
    assert np.all(tilted < pair_stiffness_n_per_m(real, u))


def test_stiffness_scales_with_the_modulus_and_not_with_the_size(paper_pair: MakePair) -> None:
    """Plane problem: k/(E W) depends on shape only; a gear enlarged in its plane keeps its stiffness."""
    u = np.array([0.2, 0.8, 1.6])
    one = pair_stiffness_n_per_m(paper_pair(), u)
    np.testing.assert_allclose(pair_stiffness_n_per_m(paper_pair(youngs_modulus_pa=1.08e11), u), one / 2, rtol=1e-12)
    pair = paper_pair()
    big = [replace(g, module_m=3 * g.module_m, bore_radius_m=3 * g.bore_radius_m) for g in (pair.pinion, pair.gear)]
    np.testing.assert_allclose(pair_stiffness_n_per_m(replace(pair, pinion=big[0], gear=big[1]), u), one, rtol=1e-12)


@given(
    z1=st.integers(12, 150),
    z2=st.integers(12, 150),
    module=st.floats(3e-4, 2e-2),
    shift=st.floats(-0.3, 0.6),
    angle=st.floats(14.5, 27),
    bore=st.floats(0, 0.8),
    model=st.sampled_from(["clamped_at_base", "true_root"]),
)
def test_every_legal_pair_has_a_finite_positive_stiffness(
    z1: int, z2: int, module: float, shift: float, angle: float, bore: float, model: str
) -> None:
    """Either a SpecError or a sane curve: finite, positive, below the Hertz stiffness, contact ratio 1 to 3."""

    def gear(teeth: int, x: float) -> GearGeometry:
        return GearGeometry(
            teeth=teeth,
            module_m=module,
            pressure_angle_rad=math.radians(angle),
            profile_shift_coefficient=x,
            face_width_m=10 * module,
            bore_radius_m=bore * module * (teeth / 2 - 1.25 + x),
            youngs_modulus_pa=2.06e11,
        )

    try:
        pair = GearPair(pinion=gear(z1, shift), gear=gear(z2, -shift), root_model=model)  # type: ignore[arg-type]
    except SpecError:
        assume(False)
    ratio = pair.contact().contact_ratio
    assert 1 <= ratio < 3
    k = pair_stiffness_n_per_m(pair, np.linspace(0, 0.999, 25) * ratio)
    assert np.all(np.isfinite(k))
    assert np.all(k > 0)
    assert np.all(k < math.pi * 2.06e11 * 10 * module / (4 * 0.91))


def test_single_stiffness_near_the_standards(paper_pair: MakePair) -> None:
    """ISO 6336-1:2006, 9.3: c' = 0.8/q, q = 0.04723 + 0.15551/z1 + 0.25791/z2 = 14.0 N/(mm um) for solid steel discs.

    The largest single stiffness over the width must be of that size; the ring clamped at a 0.3 r bore is softer
    than the standard's disc, the true root stiffer than the tooth clamped on the base circle.
    """
    q = 0.04723 + 0.15551 / 23 + 0.25791 / 81
    standard = 0.8 / q * 1e9
    u = np.linspace(0, 0.999, 200) * paper_pair().contact().contact_ratio
    shares = []
    for model in ("clamped_at_base", "true_root"):
        pair = paper_pair(youngs_modulus_pa=2.06e11, root_model=model)
        shares.append(float(pair_stiffness_n_per_m(pair, u).max()) / 0.024 / standard)
    assert standard == pytest.approx(13.99e9, rel=1e-3)
    assert 0.65 < shares[0] < shares[1] < 1.1
