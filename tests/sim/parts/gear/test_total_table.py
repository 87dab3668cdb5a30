"""Total tables: the independent reference, the user's own."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from sim.core.errors import SpecError
from sim.parts.gear import GearPair, TotalTable, mesh_summary, total_table

MakePair = Callable[..., GearPair]
REFERENCE = Path(__file__).resolve().parents[4].parent / "shared" / "reference" / "tabled_healthy.npz"


@pytest.fixture
def reference() -> TotalTable:
    """Table of the independent calculation."""
    if not REFERENCE.exists():
        pytest.skip("the reference solutions are not beside the project")
    with np.load(REFERENCE) as data:
        return TotalTable(centre_distance_error_m=data["centre_distance_error"], stiffness_n_per_m=data["mesh_table"])


def test_agrees_with_the_independent_table(reference: TotalTable, paper_pair: MakePair) -> None:
    """Table 3's 216 GPa: every cell within 4.5 %, a nearly constant factor, and every jump in the same column."""
    ours = total_table(paper_pair(), reference.centre_distance_error_m, 400).stiffness_n_per_m
    share = ours / reference.stiffness_n_per_m
    assert np.abs(share - 1).max() < 0.045
    assert np.ptp(share) < 0.01
    for row, other in zip(ours, reference.stiffness_n_per_m, strict=True):
        assert np.argmin(np.diff(row)) == np.argmin(np.diff(other))


def test_slope_over_the_centre_distance_agrees(reference: TotalTable, paper_pair: MakePair) -> None:
    """Mean, least, largest and d mean/da within 5 % of the reference's."""
    rows = reference.stiffness_n_per_m
    summary = mesh_summary(paper_pair())
    slope = (rows[6].mean() - rows[2].mean()) / 2e-4
    wanted = {
        "mean_n_per_m": rows[4].mean(),
        "min_n_per_m": rows[4].min(),
        "max_n_per_m": rows[4].max(),
        "d_mean_d_centre_distance": slope,
    }
    for key, want in wanted.items():
        assert summary[key] == pytest.approx(want, rel=0.05), key


def test_bore_effect_agrees_with_the_reading_notes(paper_pair: MakePair) -> None:
    """Bore 0.5 r instead of 0.3 r: +14 % in the independent calculation."""
    assert mesh_summary(paper_pair())["bore_0.5r_over_0.3r"] == pytest.approx(1.14, abs=0.015)


@pytest.mark.slow
def test_summary_matches_a_fine_sample(paper_pair: MakePair) -> None:
    """Mean, extremes and root effect against a table of 20 000 columns."""
    pair = paper_pair()
    row = total_table(pair, np.zeros(1), 20_000).stiffness_n_per_m[0]
    summary = mesh_summary(pair)
    assert summary["mean_n_per_m"] == pytest.approx(row.mean(), rel=1e-4)
    assert summary["min_n_per_m"] == pytest.approx(row.min(), rel=1e-4)
    assert summary["max_n_per_m"] == pytest.approx(row.max(), rel=1e-6)
    rooted = total_table(paper_pair(root_model="true_root"), np.zeros(1), 2000).stiffness_n_per_m.mean()
    assert summary["true_root_over_clamped_at_base"] == pytest.approx(rooted / row.mean(), rel=1e-3)


def test_users_table_interpolates_as_stated() -> None:
    """Bilinear, periodic in phase, clamped in the centre distance."""
    table = TotalTable(
        centre_distance_error_m=np.array([0.0, 1e-4]), stiffness_n_per_m=np.array([[1.0, 3.0], [2.0, 4.0]])
    )
    np.testing.assert_allclose(table.total_n_per_m(np.array([0.0, 0.25, 0.75, 1.25])), [1, 2, 2, 2])
    np.testing.assert_allclose(table.total_n_per_m(np.array([0.5]), 5e-5), [3.5])
    np.testing.assert_allclose(table.total_n_per_m(np.array([0.5]), 1.0), [4.0])


@pytest.mark.parametrize(
    ("errors", "rows", "field"),
    [
        ([0.0, 0.0], [[1.0, 1.0], [1.0, 1.0]], "table.centre_distance_error_m"),
        ([1e-4, 0.0], [[1.0, 1.0], [1.0, 1.0]], "table.centre_distance_error_m"),
        ([float("nan")], [[1.0, 1.0]], "table.centre_distance_error_m"),
        ([], [[1.0, 1.0]], "table.centre_distance_error_m"),
        ([0.0], [[1.0, -1.0]], "table.stiffness_n_per_m"),
        ([0.0], [[1.0, float("inf")]], "table.stiffness_n_per_m"),
        ([0.0], [[1.0]], "table.stiffness_n_per_m"),
        ([0.0, 1.0], [[1.0, 1.0]], "table.stiffness_n_per_m"),
    ],
)
def test_bad_tables_are_refused(errors: list[float], rows: list[list[float]], field: str) -> None:
    """Not rising, not finite, not positive, wrong shape."""
    with pytest.raises(SpecError) as caught:
        TotalTable(centre_distance_error_m=np.array(errors), stiffness_n_per_m=np.array(rows))
    assert field in {p.field for p in caught.value.problems}
