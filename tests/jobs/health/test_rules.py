"""Rules of alarms: closed forms, and how often they are wrong where nothing has changed."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import norm

from jobs.health.rules import (
    ALARM_CHANCE,
    ALARM_FACTORS,
    COUNTS,
    FAMILY_ALARM_DB,
    FAMILY_WARNING_DB,
    LEAST_BASELINES,
    LEVEL_RISE_DB,
    MAD_TO_SIGMA,
    WARNING_CHANCE,
    WARNING_FACTORS,
    amplitude,
    baseline_of,
    decibel,
    judge,
)
from jobs.health.standard import ZONES, zones_for

LEVELS_DB = (-4.0, -3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0, 4.0)


def test_median_and_spread_are_those_of_the_levels() -> None:
    found = baseline_of([amplitude(x) for x in LEVELS_DB])
    assert found is not None and found.recordings == 9
    assert found.median_db == pytest.approx(0.0, abs=1e-12)
    assert found.sigma_db == pytest.approx(MAD_TO_SIGMA * 2.0)


def test_fewer_than_eight_give_no_baseline() -> None:
    values = [1.0, 1.1, 0.9, 1.05, 0.95, 1.0, 1.02]
    assert baseline_of(values) is None and len(values) == LEAST_BASELINES - 1
    assert baseline_of([*values, 0.0]) is None, "a level of zero is no level"
    assert baseline_of([*values, 1.0]) is not None


def test_a_step_of_known_size_is_told_and_one_below_the_limit_is_not() -> None:
    base = baseline_of([amplitude(x / 10) for x in LEVELS_DB])  # sigma 0.2965 dB, nine recordings: factor 9.52
    assert base is not None
    limit = WARNING_FACTORS[0] * MAD_TO_SIGMA * 0.2
    assert limit > LEVEL_RISE_DB
    assert judge(amplitude(limit - 0.01), base, family=False).severity is None
    assert judge(amplitude(limit + 0.01), base, family=False).severity == "warning"
    grave = ALARM_FACTORS[0] * MAD_TO_SIGMA * 0.2
    assert judge(amplitude(grave - 0.01), base, family=False).severity == "warning"
    told = judge(amplitude(grave + 0.01), base, family=False)
    assert told.severity == "alarm" and told.rise_db == pytest.approx(grave + 0.01)
    assert decibel(told.warning) == pytest.approx(limit) and decibel(told.alarm) == pytest.approx(grave)


def test_equal_baselines_leave_the_least_rises() -> None:
    base = baseline_of([2.0] * 20)
    assert base is not None and base.sigma_db == 0.0
    assert judge(2.0 * amplitude(LEVEL_RISE_DB - 0.01), base, family=False).severity is None
    assert judge(2.0 * amplitude(LEVEL_RISE_DB + 0.01), base, family=False).severity == "alarm"
    assert judge(2.0 * amplitude(FAMILY_WARNING_DB - 0.01), base, family=True).severity is None
    assert judge(2.0 * amplitude(FAMILY_WARNING_DB + 0.01), base, family=True).severity == "warning"
    assert judge(2.0 * amplitude(FAMILY_ALARM_DB + 0.01), base, family=True).severity == "alarm"


def test_a_drift_within_the_spread_is_never_told() -> None:
    rng = np.random.default_rng(1)
    baselines = rng.normal(0.0, 1.0, 32)
    base = baseline_of([amplitude(x) for x in baselines])
    assert base is not None
    for level in np.linspace(base.median_db, base.median_db + 3.0 * base.sigma_db, 50):
        assert judge(amplitude(level), base, family=False).severity is None


@pytest.mark.slow
@pytest.mark.parametrize(("count", "warning", "alarm"), list(zip(COUNTS, WARNING_FACTORS, ALARM_FACTORS, strict=True)))
def test_false_alarms_on_gaussian_baselines_are_as_rare_as_stated(count: int, warning: float, alarm: float) -> None:
    """P(x > median + k sigma), the average over baselines, with the tail of x exact: draws other than the table's."""
    draws = np.random.default_rng(20 + count).standard_normal((100_000, count))
    median = np.median(draws, axis=1)
    sigma = MAD_TO_SIGMA * np.median(np.abs(draws - median[:, None]), axis=1)
    assert np.mean(norm.sf(median + warning * sigma)) == pytest.approx(WARNING_CHANCE, rel=0.12)
    assert np.mean(norm.sf(median + alarm * sigma)) == pytest.approx(ALARM_CHANCE, rel=0.5)


def test_between_two_counts_the_factor_of_the_smaller_holds() -> None:
    for count, expected in ((8, WARNING_FACTORS[0]), (9, WARNING_FACTORS[0]), (11, WARNING_FACTORS[1]), (5000, 3.35)):
        base = baseline_of([amplitude(10 * x) for x in np.random.default_rng(0).standard_normal(count)])
        assert base is not None
        limit = base.limit_db(WARNING_FACTORS, 0.0)
        assert (limit - base.median_db) / base.sigma_db == pytest.approx(expected)


@pytest.mark.slow
@given(st.lists(st.floats(1e-6, 1e3), min_size=8, max_size=60), st.floats(1e-3, 1e3), st.booleans())
def test_a_gain_common_to_all_changes_no_verdict(values: list[float], gain: float, family: bool) -> None:
    base, scaled = baseline_of(values), baseline_of([gain * v for v in values])
    assert base is not None and scaled is not None
    assert scaled.sigma_db == pytest.approx(base.sigma_db, abs=1e-6)
    one, other = judge(max(values), base, family=family), judge(gain * max(values), scaled, family=family)
    assert other.rise_db == pytest.approx(one.rise_db, abs=1e-6)


def test_silence_rises_above_nothing() -> None:
    base = baseline_of([1.0] * 8)
    assert base is not None
    told = judge(0.0, base, family=False)
    assert told.severity is None and told.rise_db == -math.inf


@pytest.mark.parametrize(
    ("name", "a_b", "b_c", "c_d"),
    [
        ("group1-rigid", 2.3, 4.5, 7.1),
        ("group1-flexible", 3.5, 7.1, 11.0),
        ("group2-rigid", 1.4, 2.8, 4.5),
        ("group2-flexible", 2.3, 4.5, 7.1),
    ],
)
def test_zones_of_the_standard(name: str, a_b: float, b_c: float, c_d: float) -> None:
    """ISO 10816-3:2009, tables A.1 and A.2, mm/s."""
    zones = ZONES[name]
    limits = [x * 1e-3 for x in (a_b, b_c, c_d)]
    assert [zones.zone(x * 0.999) for x in limits] == ["A", "B", "C"] and zones.zone(limits[2] * 1.001) == "D"
    assert zones.severity(limits[1] * 0.999) is None
    assert zones.severity(limits[1] * 1.001) == "warning" and zones.severity(limits[2] * 1.001) == "alarm"


def test_the_standard_is_applied_only_where_it_is_said_to_fit() -> None:
    assert zones_for(None, 25.0) is None and zones_for("group2-rigid", None) is None
    assert zones_for("group2-rigid", 5.0) is None, "below 600 r/min its band begins at 2 Hz"
    assert zones_for("group2-rigid", 25.0) is ZONES["group2-rigid"]
