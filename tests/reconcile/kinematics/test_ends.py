"""A bearing whose lines are loudest at another one's sensor is named with that doubt; one that is heard at home is not.

Two bearings of unlike types with a sensor each; a pit makes the orders of the first.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reconcile.kinematics import KinematicSpec, read_kinematic_spec, reconcile_kinematics
from reconcile.report.action import BY_LOUDNESS, LOUDEST, UNIT_OR_GAIN, to_do
from reconcile.verdict import Report
from signals.recording import Recording
from tests.strategies.brief import N, recorded, sound, train

pytestmark = pytest.mark.slow
OUTER_6205 = 3.5848


def spec(first: str, second: str) -> KinematicSpec:
    bearings = [
        {"name": name, "shaft": "shaft", "catalogue": size}
        for name, size in (("bearing1", first), ("bearing2", second))
    ]
    return read_kinematic_spec({"kinematics": {"shafts": [{"name": "shaft"}], "bearings": bearings}})


def two(heights: tuple[float, float], seed: int) -> Recording:
    rng = np.random.default_rng(seed)
    blows = train(rng, OUTER_6205 * 0.992, 1.0) if any(heights) else np.zeros(N)
    return recorded(np.array([sound(seed + 10 * k) + h * blows for k, h in enumerate(heights)]))


def asked(heights: tuple[float, float], machine: KinematicSpec, unit: str = "m/s^2") -> Report:
    both = [
        replace(one, channels=tuple(replace(c, unit=unit) for c in one.channels))
        for one in (two(heights, 2), two((0.0, 0.0), 5))
    ]
    report = reconcile_kinematics(machine, both[:1], both[1:], seed=1)
    assert report.verdict == "explained" and report.causes[0].term == "outer_spall", report.sentence
    return report


@pytest.mark.parametrize("heights", [(8.0, 2.0), (5.0, 5.0)])
def test_a_bearing_that_its_own_sensor_hears_as_loud_is_named_without_a_word(heights: tuple[float, float]) -> None:
    report = asked(heights, spec("6205", "6203"))
    assert LOUDEST not in report.sentence and not any(LOUDEST in text for text in report.where.limits)
    assert to_do(report).startswith("inspect bearing1") and "Before that" not in to_do(report)


def test_exchanged_sensors_and_a_wrong_type_are_doubted_but_stay_named() -> None:
    for heights, machine, named, heard in (
        ((2.0, 8.0), spec("6205", "6203"), "bearing1", "bearing2"),  # exchanged sensors
        ((8.0, 2.0), spec("6203", "6205"), "bearing2", "bearing1"),  # exchanged types
    ):
        report = asked(heights, machine)
        assert {c.site for c in report.causes if c.named} == {named}
        assert f"{LOUDEST} {heard}" in report.sentence
        assert any(text.startswith(f"the lines of {named} are {LOUDEST} {heard}") for text in report.where.limits)
        assert f"may be exchanged, the {UNIT_OR_GAIN} of one wrong, or the types" in report.sentence
        assert "which sensor is which channel, unit and gain of each, and the types of the bearings" in to_do(report)


def test_levels_that_cannot_be_compared_say_nothing() -> None:
    report = asked((2.0, 8.0), spec("6205", "6203"), unit="uncalibrated")
    assert LOUDEST not in report.sentence and "Before that" not in to_do(report)


def test_of_equal_bearings_the_sensors_are_to_be_checked_first() -> None:
    report = asked((8.0, 2.0), spec("6205", "6205"))
    assert [c.site for c in report.causes if c.named] == ["bearing1"]
    assert any(BY_LOUDNESS in text for text in report.where.limits) and LOUDEST not in report.sentence
    assert "Before that check which sensor is which channel" in to_do(report)
