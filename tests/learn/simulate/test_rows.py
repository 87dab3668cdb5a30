from itertools import islice

import numpy as np
import pytest
from learn.simulate.machines import CLASSES, families, recipe
from learn.simulate.rows import Variant, rows
from learn.simulate.visible import SHOWS_DB, visible_db

from learn.orders import of_ratio
from learn.simulate.background import free_axis, knocks, neighbours, rolling_noise, warped
from sideband_datasets import make_plan


@pytest.mark.slow
def test_each_machine_is_recorded_once_in_every_class():
    plan = make_plan(recipe(30, fast=True))
    for m in range(len(plan.machines)):
        assert sorted(plan.kind[plan.machine == m]) == [0, 1, 2, 3]


@pytest.mark.slow
def test_every_family_of_bearings_has_a_machine():
    plan = make_plan(recipe(30, fast=False))
    assert {m.family for m in plan.machines} == {f.name for f in families()}


@pytest.mark.slow
def test_no_two_machines_are_alike():
    plan = make_plan(recipe(40, fast=True))
    assert len({m.content for m in plan.machines}) == len(plan.machines)


def test_a_fault_as_strong_as_the_background_shows_and_none_does_not():
    rng = np.random.default_rng(0)
    sound = rng.standard_normal(4096)
    assert visible_db(sound, sound) < -100
    assert visible_db(sound, sound + rng.standard_normal(4096)) > SHOWS_DB
    assert visible_db(sound, sound + 0.05 * rng.standard_normal(4096)) < SHOWS_DB


def test_backgrounds_have_the_level_they_are_scaled_from():
    angle = 2 * np.pi * 25 / 48_000 * np.arange(48_000)
    noise = rolling_noise(np.random.default_rng(0), angle, of_ratio(9, 0.2))
    assert np.std(noise) == pytest.approx(1.0, rel=1e-6)
    some = [knocks(np.random.default_rng(k), 48_000, 48_000.0) for k in range(40)]
    levels = [float(np.sqrt(np.mean(s**2))) for s in some]
    assert {round(v, 6) for v in levels} == {0.0, 1.0}


def test_a_free_axis_adds_nothing_of_its_own():
    fault = np.random.default_rng(0).standard_normal((2, 20_000))
    moved = free_axis(np.random.default_rng(1), fault, 48_000.0, 60.0, 10.0)
    assert moved.shape == fault.shape
    assert np.std(moved) <= np.std(fault)
    assert not np.any(free_axis(np.random.default_rng(1), 0 * fault, 48_000.0, 60.0, 10.0))


def test_a_wandering_speed_moves_a_line_by_its_share():
    t = np.arange(48_000) / 48_000
    x = np.stack([np.sin(2 * np.pi * 500 * t)] * 2)
    still = warped(x, 48_000.0, 1e-9, 0.5, 3)
    np.testing.assert_allclose(still, x, atol=1e-4)
    spread = np.abs(np.fft.rfft(warped(x, 48_000.0, 5e-3, 0.3, 3)[0])) ** 2
    assert spread[500] < 0.9 * np.sum(spread)


@pytest.mark.slow
def test_rows_are_reproducible_and_labelled():
    first = list(islice(rows(18, 3, 0, 24), 3))
    again = list(islice(rows(18, 3, 0, 24), 3))
    assert [r.label for r in first] == [r.label for r in again]
    assert all(np.array_equal(a.samples, b.samples) for a, b in zip(first, again, strict=True))
    assert {r.label for r in first} <= set(CLASSES)
    assert all(np.all(np.isfinite(r.samples)) for r in first)


@pytest.mark.slow
def test_chain_and_background_are_left_out_apart():
    """The sound recording of one machine: the chain brings the rate, the background what the bare motion lacks."""

    def sound(**left_out):
        return next(r for r in rows(18, 3, 0, 24, Variant(**left_out)) if r.label == CLASSES[0])

    whole, no_chain, no_background = sound(), sound(chain=False), sound(background=False)
    neither = sound(chain=False, background=False)
    assert no_chain.rate_hz == neither.rate_hz == 48_000.0
    assert no_background.rate_hz == whole.rate_hz
    assert whole.samples.size == no_background.samples.size
    assert not np.allclose(whole.samples, no_background.samples, rtol=0.1)
    lost = no_chain.samples - neither.samples[-no_chain.samples.size :]
    assert np.std(lost) > 0.03 * np.std(neither.samples)
    assert (Variant(chain=False).hearings, Variant(chain=False, background=False).hearings) == (2, 1)


def test_neighbours_are_regular_impulses_in_some_machines():
    found = [neighbours(np.random.default_rng(k), 48_000, 48_000.0, 30.0) for k in range(40)]
    some = [x for x in found if np.any(x)]
    assert 6 < len(some) < 30
    assert all(np.sqrt(np.mean(x**2)) == pytest.approx(1.0) for x in some)
    np.testing.assert_array_equal(found[3], neighbours(np.random.default_rng(3), 48_000, 48_000.0, 30.0))
    assert not np.any(neighbours(np.random.default_rng(1), 48_000, 48_000.0, 30.0, share=0.0))
