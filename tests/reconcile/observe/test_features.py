"""Simulated statistics behind a sensor: gains scale, noise dilutes, and noise that buries hides."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from reconcile.calibrate.chain import Chain
from reconcile.observe.features import Layout, changed, scale_of, soft_features, through
from reconcile.observe.phases import HALF_TURN_DB
from reconcile.observe.statistics import LOBE, SHAPE_BANDS_HZ, third_octaves

BANDS = third_octaves().size - 1
SHAPES = len(SHAPE_BANDS_HZ)
LINES_HZ = np.array([50.0, 333.0, 2345.0])
WIDTHS = np.array([high - low for low, high in SHAPE_BANDS_HZ])
RESOLUTION_HZ = 1.5
TURNS = np.array([18.0, 5.0])
PHASES = 2


def bank(seed: int, n: int = 2, modulations: int = 4) -> SimpleNamespace:
    rng = np.random.default_rng(seed)
    return SimpleNamespace(
        line=rng.uniform(0.1, 2.0, (n, 1, LINES_HZ.size)),
        floor=rng.uniform(1e-4, 1e-2, (n, 1, BANDS)),
        total=rng.uniform(0.1, 2.0, (n, 1, BANDS)),
        band=rng.uniform(0.1, 2.0, (n, 1, SHAPES)),
        depth=rng.uniform(0.0, 0.5, (n, 1, SHAPES, modulations)),
        turn=rng.uniform(0.0, 0.5, (n, 1, SHAPES, TURNS.size)),
        kurtosis=rng.uniform(-1.0, 20.0, (n, 1, SHAPES)),
        skewness=rng.uniform(-2.0, 2.0, (n, 1, SHAPES)),
        phase=rng.uniform(-3.0, 3.0, (n, 1, PHASES)),
    )


def chain(gain_db: float, noise: float) -> Chain:
    return Chain(gain_db=np.full((1, BANDS), gain_db), noise=np.full((1, BANDS), noise))


@settings(max_examples=25)
@given(seed=st.integers(0, 1000), gain_db=st.floats(-60.0, 60.0))
def test_a_noiseless_chain_scales_powers_and_keeps_shapes(seed: int, gain_db: float) -> None:
    here = bank(seed)
    passed = through(chain(gain_db, 1e-30), here, LINES_HZ, RESOLUTION_HZ)
    g = 10 ** (gain_db / 10)
    for name in ("line", "floor", "total", "turn"):
        np.testing.assert_allclose(getattr(passed, name), g * getattr(here, name), rtol=1e-9)
    np.testing.assert_allclose(passed.depth, here.depth, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(passed.kurtosis, here.kurtosis, rtol=1e-9)
    np.testing.assert_allclose(passed.skewness, here.skewness, rtol=1e-9)


@settings(max_examples=25)
@given(seed=st.integers(0, 1000), noise=st.floats(1e-8, 1e-1), louder=st.floats(0.1, 10.0))
def test_noise_adds_powers_and_dilutes_shapes(seed: int, noise: float, louder: float) -> None:
    here = bank(seed)
    passed = through(chain(0.0, noise), here, LINES_HZ, RESOLUTION_HZ, louder)
    density = noise * louder
    np.testing.assert_allclose(passed.line, here.line + density * LOBE * RESOLUTION_HZ)
    np.testing.assert_allclose(passed.floor, here.floor + density)
    np.testing.assert_allclose(passed.total, here.total + density * np.diff(third_octaves()))
    share = here.band / (here.band + density * WIDTHS)
    np.testing.assert_allclose(passed.kurtosis, here.kurtosis * share**2)
    np.testing.assert_allclose(passed.skewness, here.skewness * share**1.5)
    flat = (1 - share**2) * 2 * LOBE * RESOLUTION_HZ / WIDTHS
    np.testing.assert_allclose(passed.depth, here.depth * share[..., None] ** 2 + flat[..., None])


def test_each_draw_and_channel_may_have_noise_of_its_own() -> None:
    here = bank(1)
    passed = through(chain(0.0, 1e-3), here, LINES_HZ, RESOLUTION_HZ, np.array([[1.0], [4.0]]))
    np.testing.assert_allclose((passed.floor - here.floor)[:, 0, 0], [1e-3, 4e-3])


@pytest.mark.slow
def test_the_dilution_of_moments_is_that_of_sums_of_independent_signals() -> None:
    rng = np.random.default_rng(2)
    n = 1_000_000
    signal = rng.exponential(size=n) - 1.0
    noisy = signal + rng.normal(0.0, 0.8, n)
    share = 1 / (1 + 0.8**2)
    assert np.mean(noisy**4) / np.var(noisy) ** 2 - 3 == pytest.approx(6.0 * share**2, rel=0.05)
    assert np.mean(noisy**3) / np.var(noisy) ** 1.5 == pytest.approx(2.0 * share**1.5, rel=0.05)


def test_what_noise_buries_changes_no_feature() -> None:
    here = chain(0.0, 1e-3)
    scale = scale_of(here, LINES_HZ, RESOLUTION_HZ, TURNS)
    one, two = bank(3), bank(3)
    one.turn, two.turn = np.full_like(one.turn, 1e-7), np.full_like(one.turn, 1e-6)
    one.line, two.line = np.full_like(one.line, 1e-9), np.full_like(one.line, 1e-7)
    features = [through(here, b, LINES_HZ, RESOLUTION_HZ).features(scale) for b in (one, two)]
    assert np.abs(features[0] - features[1]).max() < 1e-3


def test_features_are_laid_out_as_declared() -> None:
    layout = Layout(lines=LINES_HZ.size, bands=BANDS, shapes=SHAPES, modulations=4, shafts=TURNS.size, phases=PHASES)
    here = chain(0.0, 1e-9)
    scale = scale_of(here, LINES_HZ, RESOLUTION_HZ, TURNS)
    base = bank(4)
    first = through(here, base, LINES_HZ, RESOLUTION_HZ).features(scale)
    assert first.shape == (2, 1, layout.size)
    base.depth = base.depth * 0.5 + 0.3
    changed = np.any(through(here, base, LINES_HZ, RESOLUTION_HZ).features(scale) != first, axis=(0, 1))
    assert set(np.flatnonzero(changed)) <= set(range(*layout.slices()["depth"].indices(layout.size)))
    assert sum(s.stop - s.start for s in layout.slices().values()) == layout.size


def test_nothing_measured_stays_nan() -> None:
    here = bank(5)
    here.line[0, 0, 1] = np.nan
    scale = scale_of(chain(0.0, 1e-6), LINES_HZ, RESOLUTION_HZ, TURNS)
    parts = (here.line, here.floor, here.total, here.depth, here.turn, here.kurtosis, here.skewness, here.phase)
    found = soft_features(*parts, scale)
    assert np.isnan(found).sum() == 1 and np.isnan(found[0, 0, 1])


def test_changes_of_phases_are_known_up_to_whole_turns() -> None:
    half = HALF_TURN_DB
    before, after = np.array([[10.0, half - 1.0]]), np.array([[10.0 + 2.0 * half, 1.0 - half]])
    np.testing.assert_allclose(changed(after, before, 1), [[2.0 * half, 2.0]])
    np.testing.assert_allclose(changed(after, before, 2), [[0.0, 2.0]], atol=1e-9)
    np.testing.assert_allclose(changed(after, before, 0), after - before)
