"""The pair table: stated interpolation error, sharp ends, sums."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from sim.core.errors import SpecError
from sim.parts.gear import GearGeometry, GearPair, build_pair_table, interpolation_error
from sim.parts.gear.pair_table import legal_errors_m
from sim.parts.gear.total_table import total_row_n_per_m

MakePair = Callable[..., GearPair]


def test_interpolation_error_is_small_and_shrinks_as_second_order(paper_pair: MakePair) -> None:
    """Default table: 5e-5 aligned; four times the error with half the points and rows."""
    pair = paper_pair()
    fine = interpolation_error(build_pair_table(pair), pair)
    coarse = interpolation_error(build_pair_table(pair, points=65, rows=17), pair)
    assert fine.stiffness_relative < 5e-5
    assert fine.contact_ratio_absolute < 2e-6
    assert coarse.stiffness_relative / fine.stiffness_relative == pytest.approx(4, rel=0.1)


def test_interpolation_error_with_tilts(paper_pair: MakePair) -> None:
    """17 tilts over +-2 mrad: 2e-3, the arm bends near partial contact."""
    pair = paper_pair()
    table = build_pair_table(pair, tilts_rad=np.linspace(-2e-3, 2e-3, 17), points=65, rows=5)
    assert interpolation_error(table, pair).stiffness_relative < 2e-3


@pytest.mark.parametrize("error_m", [-1.37e-4, 0.0, 0.9e-4])
def test_total_is_sharp_between_rows(paper_pair: MakePair, error_m: float) -> None:
    """Sum over pairs equals the direct sum on both sides of the jump, off the grid of rows."""
    pair = paper_pair()
    table = build_pair_table(pair)
    jump = pair.contact(error_m).contact_ratio - 1
    phase = np.concatenate([np.linspace(0, 1, 257)[:-1], [jump - 1e-5, jump + 1e-5]])
    found = table.total_n_per_m(phase, error_m)
    np.testing.assert_allclose(found, total_row_n_per_m(pair, phase, error_m), rtol=1e-4)
    assert found[-2] > 1.7 * found[-1]


def test_total_is_periodic_and_clamped(paper_pair: MakePair) -> None:
    """Phase wraps, the centre distance is held at the table's ends."""
    table = build_pair_table(paper_pair(), points=33, rows=5)
    phase = np.linspace(0.05, 0.95, 7)
    np.testing.assert_allclose(table.total_n_per_m(phase), table.total_n_per_m(phase + 3), rtol=1e-9)
    np.testing.assert_array_equal(table.total_n_per_m(phase, 1.0), table.total_n_per_m(phase, 2e-4))


def test_rows_stay_within_working_distances() -> None:
    """A pair near interference gets a narrower table instead of an error; zero stays the middle row."""

    def gear(teeth: int) -> GearGeometry:
        return GearGeometry(
            teeth=teeth, module_m=2e-3, face_width_m=0.02, bore_radius_m=3e-3, youngs_modulus_pa=2.06e11
        )

    pair = GearPair(pinion=gear(15), gear=gear(30))
    errors = legal_errors_m(pair, 1e-3, 9)
    assert errors[4] == 0.0
    assert 0 < errors[-1] < 1e-3
    assert build_pair_table(pair, centre_distance_errors_m=errors).contact_ratio.min() >= 1
    with pytest.raises(SpecError, match="odd"):
        legal_errors_m(pair, 1e-3, 8)
