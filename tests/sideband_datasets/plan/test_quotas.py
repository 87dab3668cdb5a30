from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from sideband_datasets.plan.quotas import interleaved, quotas, ranks

weights = st.lists(st.floats(0.01, 100), min_size=1, max_size=12)


@given(weights, st.integers(0, 5000))
def test_quotas_are_exact_to_one_and_add_up(shares, total):
    counts = quotas(shares, total)
    exact = np.array(shares) / sum(shares) * total
    assert sum(counts) == total
    assert np.all(np.abs(np.array(counts) - exact) < 1 + 1e-6)


@given(weights, st.integers(12, 500))
def test_everyone_gets_the_least(shares, total):
    assert min(quotas(shares, total, least=1)) >= 1
    assert sum(quotas(shares, total, least=1)) == total


@given(st.lists(st.integers(0, 60), min_size=1, max_size=8))
def test_every_stretch_of_the_mixed_order_has_nearly_the_shares(counts):
    order = interleaved(counts)
    total = sum(counts)
    assert [int(np.sum(order == k)) for k in range(len(counts))] == counts
    for k, count in enumerate(counts):
        seen = np.cumsum(order == k)
        ideal = np.arange(1, total + 1) * count / max(total, 1)
        assert np.all(np.abs(seen - ideal) <= len(counts) / 2 + 0.5)


def test_ranks_count_within_a_kind():
    assert ranks(np.array([0, 1, 0, 0, 1])).tolist() == [0, 0, 1, 2, 1]
