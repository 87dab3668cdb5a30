import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from learn import features, unknown
from learn.bank import bank, tree
from learn.combs import Comb, away_from, grid, logs, scores, search, tail
from learn.features import NAMES, find, vector
from learn.orders import of_ratio

RATE, SPEED = 20_000.0, 25.0


def spectra_of(x):
    return bank([x], RATE, SPEED)


@pytest.mark.parametrize("family", ["outer", "inner"])
def test_impacts_at_a_families_order_are_found_there_and_not_elsewhere(impacts, bearing, family):
    order = getattr(bearing, family)
    found = find(spectra_of(impacts(order, weight=0.8 if family == "inner" else 0.0)), bearing)
    assert max(found.values(), key=lambda f: f.z).family == family
    assert found[family].chance > 2.0
    assert found[family].order == pytest.approx(order, rel=4e-3)
    assert found[family].depth > 0.3


def test_slip_is_found_and_told(impacts, bearing):
    found = find(spectra_of(impacts(bearing.outer * 0.988)), bearing)["outer"]
    assert found.slip == pytest.approx(-0.012, abs=2e-3)


def test_shaft_sidebands_tell_a_turning_defect(impacts, bearing):
    turning, _ = vector(spectra_of(impacts(bearing.inner, weight=0.8)), bearing)
    still, _ = vector(spectra_of(impacts(bearing.inner, weight=0.0)), bearing)
    at = NAMES.index("side_inner")
    assert turning[at] > still[at] + 0.5


def test_features_do_not_know_the_unit(impacts, bearing):
    x = impacts(bearing.outer)
    a, _ = vector(spectra_of(x), bearing)
    b, _ = vector(spectra_of(1e-3 * x + 7.0), bearing)
    np.testing.assert_allclose(a, b, atol=1e-4)


@pytest.mark.slow
@settings(max_examples=12, deadline=None)
@given(seed=st.integers(0, 10_000), turns=st.sampled_from([10.0, 25.0, 60.0]))
def test_noise_of_any_length_looks_alike(seed, turns):
    """The chance of the best of a search on noise is seldom small, however many turns there are."""
    rng = np.random.default_rng(seed)
    x = rng.standard_normal(int(turns / SPEED * RATE))
    found = find(spectra_of(x), of_ratio(9, 0.2034))
    assert all(f.chance < 3.5 for f in found.values())
    assert all(f.z < 9.0 for f in found.values())


@pytest.mark.slow
def test_the_chance_level_of_the_search_is_uniform_on_noise(bearing):
    """Over many noises the smoothed rank of BPFO's search is below 0.1 in about a tenth of them."""
    rng = np.random.default_rng(5)
    small = [find(spectra_of(rng.standard_normal(8000)), bearing)["outer"].chance > 1.0 for _ in range(60)]
    assert np.mean(small) < 0.3


def test_comb_scores_are_sums_over_their_lines():
    values = np.zeros((1, 500))
    values[0, [40, 80, 120]] = 2.0
    found = scores(values, 0.1, np.array([4.0, 5.0]), Comb(harmonics=3))
    assert found[0, 0] == pytest.approx(2 * (1 + 2**-0.5 + 3**-0.5))
    assert found[0, 1] == 0.0


def test_tail_falls_with_the_value_and_ends():
    controls = np.random.default_rng(0).exponential(1.0, 2000)
    chances = [tail(controls, v) for v in (0.5, 2.0, 5.0, 9.0, 100.0)]
    assert chances == sorted(chances, reverse=True)
    assert tail(controls, 4.6) == pytest.approx(-2.0, abs=0.15)
    assert chances[-1] == -12.0
    assert tail(np.zeros(0), 3.0) == 0.0


def test_lines_of_the_shaft_count_nothing():
    spectra = spectra_of(np.random.default_rng(1).standard_normal(40_000))
    values = logs(spectra)
    orders = np.arange(values.shape[1]) * spectra.step
    assert np.all(values[:, np.abs(orders - np.rint(orders)) < 0.4 * spectra.step] == 0.0)


def test_controls_keep_away_from_the_parts(bearing):
    spectra = spectra_of(np.random.default_rng(1).standard_normal(20_000))
    base = grid(spectra)
    away = away_from(base, features.known_orders(bearing))
    assert not np.any(away[np.abs(base / bearing.outer - 1) < 0.03])
    found = search(logs(spectra), spectra.step, base, Comb(harmonics=4), away)
    assert np.median(found.z[:, away]) == pytest.approx(0.0, abs=0.3)


def test_bands_cover_the_axis_and_are_wide_enough():
    bands = np.array(tree(48_000.0, 30.0))
    assert bands.min() == pytest.approx(480.0)
    assert bands.max() == pytest.approx(23_280.0)
    assert np.all(np.diff(bands, axis=1) >= 0.5 * 16 * 30.0)


def test_unknown_geometry_finds_the_comb_and_what_usually_makes_it(impacts, bearing):
    for family in ("outer", "inner"):
        order = getattr(bearing, family)
        row, comb = unknown.vector(spectra_of(impacts(order, weight=0.8 if family == "inner" else 0.0)))
        assert comb["order"] == pytest.approx(order, rel=5e-3)
        priors = {f: row[unknown.NAMES.index(f"u_prior_{f}")] for f in ("outer", "inner", "ball")}
        assert max(priors, key=priors.get) == family
    assert len(row) == len(unknown.NAMES)


def test_an_impulsive_signal_without_period_is_erratic(impacts, bearing):
    rng = np.random.default_rng(3)
    x = 0.05 * rng.standard_normal(32_000)
    x[rng.integers(0, x.size, 300)] += rng.standard_normal(300) * 3
    free, _ = vector(spectra_of(x), bearing)
    quiet, _ = vector(spectra_of(rng.standard_normal(32_000)), bearing)
    assert free[NAMES.index("erratic")] > quiet[NAMES.index("erratic")] + 0.5
