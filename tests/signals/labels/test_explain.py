"""Displaced peaks are explained as the peaks themselves are, thousands at once."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from signals.labels.combinations import Grid
from signals.labels.explain import (
    PLACES,
    Displaced,
    bounded_chance,
    displaced,
    displaced_peaks,
    explained_by,
    gather,
)
from signals.peaks import FoundPeaks

TOP_HZ, RESOLUTION_HZ = 5000.0, 0.5


def sums_of(rng: np.random.Generator, count: int):
    frequency = rng.uniform(1.0, TOP_HZ, count).round(1)  # some are equal, some equally near
    rank = rng.choice([1, 2, 3, 1001, 1002, 2003], count)
    return gather([Grid(carrier=None, modulators=(), orders=np.ones((count, 1)), frequency_hz=frequency, rank=rank)])


def peaks_at(frequency_hz: np.ndarray) -> FoundPeaks:
    ones = np.ones(frequency_hz.size)
    fields = dict.fromkeys(FoundPeaks.__dataclass_fields__, ones)
    return FoundPeaks(**{**fields, "frequency_hz": frequency_hz})


@given(count=st.integers(1, 400), peaks=st.integers(1, 30), seed=st.integers(0, 2**32 - 1))
@settings(max_examples=25)
def test_they_go_to_the_sums_that_single_peaks_go_to(count, peaks, seed):
    rng = np.random.default_rng(seed)
    sums, found = sums_of(rng, count), peaks_at(np.sort(rng.uniform(5.0, TOP_HZ - 5.0, peaks)))
    reach = rng.uniform(0.1, 2.0, peaks)
    together = displaced_peaks(sums, found, reach, resolution_hz=RESOLUTION_HZ, top_hz=TOP_HZ)
    moved = displaced(found, RESOLUTION_HZ, TOP_HZ)
    assert moved.size >= PLACES and moved.shape == together.first.shape
    for limit in (0.05, 0.3):
        hits = []
        for k in range(3):
            owners, chance = explained_by(
                sums, moved[k % len(moved)], reach, resolution_hz=RESOLUTION_HZ, max_chance=limit
            )
            row = k % len(moved)
            named = (together.first[row] >= 0) & (together.chance[row] <= limit)
            assert [o[0] for o in owners if o] == together.first[row][named].tolist()
            assert [bool(o) for o in owners] == named.tolist()
            assert chance[named] == pytest.approx(together.chance[row][named])
            hits.append(named)
        assert 0.0 <= together.share(limit) <= 1.0


def test_the_share_counts_what_is_within_the_limit_and_proven():
    found = Displaced(first=np.array([[0, 1, -1, 1], [1, 0, 0, -1]]), chance=np.array([[0.1, 0.2, 1, 0.3], [0.2] * 4]))
    assert found.share(1.0) == pytest.approx(6 / 8)
    assert found.share(0.2) == pytest.approx(5 / 8)
    assert found.share(0.2, np.array([False, True])) == pytest.approx(2 / 8)
    assert Displaced(first=np.zeros((0, 0), dtype=np.int64), chance=np.zeros((0, 0))).share(1.0) == 0.0


def test_the_limit_is_lowered_until_no_more_than_that_share_is_explained():
    chance = np.linspace(0.001, 0.05, 100).reshape(1, -1)
    crowded = Displaced(first=np.zeros((1, 100), dtype=np.int64), chance=chance)
    limit, share = bounded_chance(crowded, 0.05)
    assert limit < 0.05 and 0.0 < share <= 0.05
    assert bounded_chance(Displaced(first=np.full((1, 5), -1), chance=np.ones((1, 5))), 0.05) == (0.05, 0.0)
