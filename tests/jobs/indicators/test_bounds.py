"""Bounds of indicators: what the default server allows passes, what would stop it is refused."""

from __future__ import annotations

import pytest

from jobs.indicators.bounds import MAX_SAMPLES, MAX_SECONDS, Stretch, check_bounds, expected_seconds
from jobs.indicators.documents import KINDS
from jobs.limits import Limits
from jobs.request import DEFAULT_RATE_HZ
from sim.core.errors import SpecError


def stretch(seconds: float, rate_hz: float = DEFAULT_RATE_HZ) -> Stretch:
    return Stretch(samples=int(seconds * rate_hz), rate_hz=rate_hz)


@pytest.mark.parametrize("kind", KINDS)
def test_the_longest_default_run_passes_with_every_kind(kind: str) -> None:
    longest = stretch(Limits().duration_s)
    for rotation in ("known", "tacholess"):
        check_bounds(kind, [longest], rotation=rotation, alpha_hz=1000.0)  # type: ignore[arg-type]


def test_samples_are_bounded_over_all_records() -> None:
    records = [stretch(60.0)] * 3
    with pytest.raises(SpecError) as caught:
        check_bounds("gear", records, rotation="known", alpha_hz=1.0)
    (problem,) = caught.value.problems
    assert (problem.given, problem.allowed, problem.unit) == (5_400_000, f"<= {MAX_SAMPLES}", "samples")
    assert "2 earlier" in problem.message and "start_s" in problem.message


def test_a_wide_coherence_is_bounded_by_time() -> None:
    long = stretch(120.0)
    assert expected_seconds("cyclic", [long], rotation="known", alpha_hz=5000.0) > MAX_SECONDS
    with pytest.raises(SpecError, match=f"<= {MAX_SECONDS:g} s"):
        check_bounds("cyclic", [long], rotation="known", alpha_hz=5000.0)
    check_bounds("cyclic", [stretch(2.0)], rotation="known", alpha_hz=5000.0)


def test_the_time_grows_with_the_record() -> None:
    for kind in KINDS:
        short, long = (expected_seconds(kind, [stretch(s)], rotation="known", alpha_hz=300.0) for s in (10.0, 40.0))
        assert 3.5 < long / short < 5.0
