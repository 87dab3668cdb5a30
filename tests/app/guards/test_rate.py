"""Token buckets: never more than allowed, and nobody waits longer than told."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.guards.rate import Bucket, Buckets, take

GAPS = st.lists(st.floats(0.0, 40.0), min_size=1, max_size=80)


@pytest.mark.slow
@given(gaps=GAPS, per_minute=st.integers(1, 200))
def test_no_stretch_of_time_has_more_calls_than_a_full_bucket_and_its_refill(
    gaps: list[float], per_minute: int
) -> None:
    bucket: Bucket | None = None
    now, calls = 100.0, []
    for gap in gaps:
        now += gap
        bucket, wait = take(bucket, per_minute, now)
        if wait == 0.0:
            calls.append(now)
    for i, begin in enumerate(calls):
        for j in range(i, len(calls)):
            assert j - i + 1 <= per_minute + (calls[j] - begin) * per_minute / 60.0 + 1e-6


@given(per_minute=st.integers(1, 1000), tokens=st.floats(0.0, 0.999))
def test_who_waits_as_told_is_let_in_and_who_comes_before_is_not(per_minute: int, tokens: float) -> None:
    bucket, wait = take(Bucket(tokens=tokens, at_s=0.0), per_minute, 0.0)
    assert wait > 0.0
    assert take(bucket, per_minute, 0.9 * wait)[1] > 0.0
    assert take(bucket, per_minute, wait * (1 + 1e-9) + 1e-9)[1] == 0.0


def test_a_smaller_limit_holds_at_once_and_time_that_goes_back_gives_nothing() -> None:
    bucket, _ = take(None, 100, 0.0)
    assert take(bucket, 2, 0.0)[0].tokens == 1.0
    assert take(Bucket(tokens=0.0, at_s=50.0), 60, 10.0)[1] == 1.0


def test_as_many_holders_as_are_allowed_are_kept() -> None:
    buckets = Buckets(most=3, clock=lambda: 0.0)
    for name in "abcd":
        assert buckets.take(name, 1) == 0.0
    assert len(buckets) == 3 and buckets.take("d", 1) > 0.0 and buckets.take("a", 1) == 0.0
