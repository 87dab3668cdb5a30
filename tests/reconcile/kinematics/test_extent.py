"""A size, and a bound of one, is told of two near strikes only; strikes half a pass apart are no other speed's."""

from __future__ import annotations

import numpy as np
import pytest

from reconcile.kinematics import read_kinematic_spec, reconcile_kinematics
from reconcile.kinematics.answer import BOUND
from reconcile.kinematics.extent import Extent, told_extent
from reconcile.kinematics.families import ties
from reconcile.kinematics.observe import observe
from reconcile.kinematics.octaves import odd_lines
from reconcile.verdict import Report
from signals.series import FloatArray
from tests.strategies.brief import SPEED_HZ, N, recorded, shaft_lines, sound, train

SPEC = read_kinematic_spec(
    {
        "kinematics": {
            "shafts": [{"name": "shaft"}],
            "bearings": [{"name": "bearing1", "shaft": "shaft", "catalogue": "6205"}],
        }
    }
)
ORDER = 3.5848 * 0.992
PERIOD_S = 1 / (ORDER * SPEED_HZ)


def struck(*shares: float) -> Report:
    """An outer race struck again after such shares of the period."""
    rng = np.random.default_rng(8)
    x: FloatArray = 0.3 * rng.standard_normal(N) + shaft_lines(rng)
    for share in shares or (0.0,):
        x = x + train(np.random.default_rng(9), ORDER, 1.0, pair_s=share * PERIOD_S)
    return reconcile_kinematics(SPEC, [recorded(x)], [recorded(sound(1))], seed=0)


@pytest.mark.slow
def test_the_bound_is_told_of_single_strikes_only() -> None:
    assert BOUND in struck().causes[0].values
    for share in (0.48, 0.55):
        report = struck(share)
        assert report.verdict == "explained" and report.causes[0].term == "outer_spall"
        assert BOUND not in report.causes[0].values and report.causes[0].severity is None
        assert "degrees" not in report.sentence


@pytest.mark.slow
def test_many_strikes_a_pass_are_no_size() -> None:
    assert struck(0.24).causes[0].severity is not None
    many = struck(0.24, 0.5)
    assert many.causes[0].term == "outer_spall" and many.causes[0].severity is None
    assert BOUND not in many.causes[0].values


def extent(degrees: float, *, resolved: bool = True) -> Extent:
    return Extent(degrees=degrees, low_deg=0.75 * degrees, high_deg=1.5 * degrees, lag_s=1e-3, resolved=resolved)


def test_a_size_is_told_of_one_angle_at_speeds_that_differ() -> None:
    told = told_extent([(20.0, extent(8.0)), (30.0, extent(8.4)), (25.0, extent(8.8))])
    assert told is not None and told.resolved and told.degrees == 8.4


@pytest.mark.parametrize("found", [[(20.0, 8.0)], [(20.0, 8.0), (20.0, 8.0)], [(20.0, 8.0), (24.0, 8.0)]])
def test_at_one_speed_it_may_be_a_rebound(found: list[tuple[float, float]]) -> None:
    told = told_extent([(hz, extent(degrees)) for hz, degrees in found])
    assert told is not None and told.resolved and told.struck
    assert (told.degrees, told.low_deg, told.high_deg) == (8.0, 0.0, 12.0)


@pytest.mark.parametrize(
    "found",
    [
        [(20.0, 8.0), (30.0, 12.0)],  # one time: a fall
        [(20.0, 8.0), (30.0, 8.0), (40.0, 12.0)],
    ],
)
def test_what_is_no_angle_bounds_it(found: list[tuple[float, float]]) -> None:
    told = told_extent([(hz, extent(degrees)) for hz, degrees in found])
    assert told is not None and not told.resolved and told.struck
    assert (told.low_deg, told.high_deg) == (0.0, 12.0)


def test_the_tightest_bound_is_told() -> None:
    told = told_extent([(20.0, extent(8.0)), (30.0, extent(4.0, resolved=False))])
    assert told == extent(4.0, resolved=False)
    assert told_extent([]) is None


@pytest.mark.slow
def test_odd_lines_of_the_shaft_confirm_its_speed() -> None:
    rng = np.random.default_rng(8)
    for factor, told in ((1.0, True), (0.5, False), (2.0, False)):
        recording = recorded(shaft_lines(rng) + 0.3 * rng.standard_normal(N), factor * SPEED_HZ)
        seen = observe(recording, ties(SPEC), "test 1", stated_hz=None, seed=0)
        assert odd_lines([seen]) is told
