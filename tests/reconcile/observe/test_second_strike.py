"""The angle between a ball's two strikes, of signals made of strikes that are so far apart."""

from __future__ import annotations

import numpy as np
import pytest
import scipy
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import fft

from reconcile.observe import second_strike as module
from reconcile.observe.second_strike import Struck, second_strike
from signals.series import FloatArray

RATE_HZ, COUNT = 20000.0, 24000
ORDER = 2.6
"""Balls that pass the pit, a turn of the shaft."""


def ringing(strikes_s: FloatArray, heights: FloatArray, seed: int) -> FloatArray:
    """Strikes that excite two resonances of a structure, in white noise."""
    impulses = np.zeros(COUNT)
    np.add.at(impulses, np.rint(strikes_s * RATE_HZ).astype(int) % COUNT, heights)
    time = np.arange(400) / RATE_HZ
    rings = sum(np.exp(-time * 2500.0) * np.sin(2.0 * np.pi * hz * time) for hz in (2300.0, 5100.0))
    sound = scipy.signal.fftconvolve(impulses, np.asarray(rings))[:COUNT]
    return np.asarray(sound + np.random.default_rng(seed).normal(size=COUNT) * 0.3)


def passes(speed_hz: float, seed: int) -> FloatArray:
    """Times of balls that slip a little."""
    rng = np.random.default_rng(seed)
    count = int(COUNT / RATE_HZ * ORDER * speed_hz)
    return np.asarray((np.arange(count) + rng.normal(size=count) * 0.01) / (ORDER * speed_hz))


def point(
    speed_hz: float, share: float | None = None, fall_s: float | None = None, *, old: bool = False, teeth: float = 0.0
) -> Struck:
    """A speed at which balls strike twice: a share of their period apart, or a time; `old`: in the baseline as well;
    `teeth`: strength of strikes of 23 teeth a turn in both."""
    hz, seed = ORDER * speed_hz, int(speed_hz * 10)
    at = passes(speed_hz, seed)
    later = share / hz if share is not None else fall_s or 0.0
    times, heights = np.concatenate([at, at + later]), np.concatenate([np.full(at.size, 6.0), np.full(at.size, 5.0)])
    mesh = np.arange(int(23 * speed_hz * COUNT / RATE_HZ)) / (23.0 * speed_hz)

    def heard(pit: bool, noise: int) -> FloatArray:
        if not pit:
            return ringing(mesh, np.full(mesh.size, teeth), noise)
        strikes = np.concatenate([heights, np.full(mesh.size, teeth)])
        return ringing(np.concatenate([times, mesh]), strikes, noise)

    test, baseline = heard(True, seed + 1), heard(old, seed + 2)
    white = [fft.rfft(x)[None] / np.sqrt(0.3**2 * 2.0 / RATE_HZ) for x in (test, baseline)]
    return Struck(
        test=white[0], baseline=white[1], count=COUNT, rate_hz=RATE_HZ, test_hz=hz, baseline_hz=hz,
        speed_hz=speed_hz, teeth_hz=(23.0 * speed_hz,),
    )  # fmt: skip


SPEEDS = (22.5, 30.0, 39.0)


@settings(max_examples=8, deadline=None)
@given(share=st.floats(0.05, 0.19).filter(lambda s: abs(s / (ORDER / 23) - 1.0) > 0.1))
def test_the_share_of_the_period_between_two_strikes_is_found(share: float) -> None:
    assert second_strike([point(hz, share) for hz in SPEEDS]) == pytest.approx(share, rel=0.06)


def test_it_is_found_beside_strikes_of_teeth() -> None:
    assert second_strike([point(hz, 0.07, teeth=3.0) for hz in SPEEDS]) == pytest.approx(0.07, rel=0.08)


def test_a_ring_that_falls_back_after_the_same_time_is_no_edge() -> None:
    assert second_strike([point(hz, fall_s=0.0015) for hz in (20.0, 30.0, 45.0)]) is None


def test_a_single_strike_has_no_second() -> None:
    assert second_strike([point(hz, 0.0) for hz in SPEEDS]) is None


def test_what_the_baseline_shows_alike_is_none_of_the_tests() -> None:
    assert second_strike([point(hz, 0.1, old=True) for hz in SPEEDS]) is None


def test_one_speed_does_not_part_a_length_from_a_time() -> None:
    assert second_strike([]) is None
    assert second_strike([point(30.0, 0.1)]) is None
    assert second_strike([point(hz, 0.1) for hz in (30.0, 30.0 * (module.FASTER - 0.01))]) is None
    assert second_strike([point(hz, 0.1) for hz in (30.0, 30.0 * (module.FASTER + 0.01))]) is not None


def test_a_speed_at_which_nothing_strikes_says_nothing() -> None:
    quiet = point(22.5, 0.1)
    silent = Struck(**{**vars(quiet), "test": np.zeros_like(quiet.test)})
    assert second_strike([silent, point(39.0, 0.1)]) is None


def test_strikes_nearer_than_the_widest_band_parts_are_one() -> None:
    least = module.APART / (9400.0 - 300.0) * ORDER * 150.0
    assert least > 0.07 > module.FIRST
    assert second_strike([point(hz, 0.07) for hz in (100.0, 150.0)]) is None


def test_a_low_sampling_rate_leaves_no_band() -> None:
    slow = point(30.0, 0.1)
    coarse = Struck(**{**vars(slow), "rate_hz": 4000.0})
    assert second_strike([coarse, Struck(**{**vars(coarse), "speed_hz": 60.0})]) is None


def test_a_rise_of_the_teeths_period_is_theirs(monkeypatch: pytest.MonkeyPatch) -> None:
    share = ORDER / 23
    strong = [point(hz, share) for hz in SPEEDS]
    assert second_strike(strong) is None
    monkeypatch.setattr(module, "BESIDE_TEETH", 0.0)
    assert second_strike(strong) == pytest.approx(share, rel=0.06)


@pytest.mark.parametrize("seed", range(6))
def test_noise_of_the_same_balls_strikes_once(seed: int) -> None:
    assert second_strike([point(hz + 0.1 * seed, 0.0) for hz in SPEEDS]) is None
