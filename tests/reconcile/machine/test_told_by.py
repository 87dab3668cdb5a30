"""Impacts beside an effect that does not strike: which are asked, and what they add to a second one."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from reconcile.machine import left_pairs, told_by
from reconcile.machine.asked import LEAST_GAIN
from reconcile.machine.direct import HEARD
from reconcile.machine.told_by import HALF_HEARD, heard
from tests.reconcile.machine.rubs import found_in
from tests.reconcile.machine.test_leftover import seen

GEAR = "eccentricity@gear"


@pytest.mark.parametrize(("name", "least"), [("outer_spall@bearing1", HALF_HEARD), ("tooth_crack@pinion", HEARD)])
def test_teeth_must_be_heard_better_than_balls(name: str, least: float) -> None:
    for evidence, told in ((least, True), (least - 0.1, False)):
        setting = SimpleNamespace(direct=SimpleNamespace(evidence={name: evidence}))
        assert heard(setting, name) is told  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("evidence", "told"),
    [
        ({"outer_spall@bearing4": 6.0}, False),
        ({"outer_spall@bearing4": 1.0}, True),
        ({"outer_spall@bearing4": 6.0, "outer_spall@bearing1": 0.8}, False),
        ({"outer_spall@bearing4": 6.0, "outer_spall@bearing1": 6.0}, True),
    ],
    ids=["heard", "hardly heard", "and next to nothing at the loose ring", "at the lines of the loose ring's bearing"],
)
def test_impacts_of_a_second_put_it_before_what_brings_none(evidence: dict[str, float], told: bool) -> None:
    setting, _ = found_in(seen(5e6))
    setting.machine.gears, setting.direct.evidence = ("gear",), evidence
    pit, off_centre = (SimpleNamespace(beside=SimpleNamespace(names=(n,))) for n in ("outer_spall@bearing4", GEAR))
    pit.gain, off_centre.gain = 35.1, 38.5
    asked = SimpleNamespace(setting=setting, first="fit_clearance@bearing1")
    near = left_pairs._rivals(asked, pit, [off_centre], {"outer_spall@bearing4": 46.3, GEAR: 29.0})  # type: ignore[arg-type]
    assert near == [GEAR] * told


@pytest.mark.parametrize(
    ("first", "second", "parts", "so"),
    [
        ("unbalance@gear", "pedestal_looseness@bearing2", (74.0, 6.0, -10.0), True),
        ("unbalance@gear", "pedestal_looseness@bearing2", (74.0, 6.0, -30.0), False),
        ("radial_clearance@bearing4", "torque_ripple@output", (-1.0, 172.0, -2.0), False),
        ("radial_clearance@bearing4", "unbalance@gear", (-1.0, 72.0, 3.0), True),
        ("radial_clearance@bearing4", "outer_spall@bearing1", (-1.0, 172.0, -2.0), True),  # as its impacts are heard
        ("outer_spall@bearing1", "unbalance@gear", (50.0, -40.0), True),  # of whose lines only the teeth's are asked
        ("unbalance@pinion", "rub@gear", (-0.1, 39.4, 1.7), False),
        ("unbalance@pinion", "rub@gear", (-0.1, 39.4, 4.7), True),
        ("unbalance@pinion", "rub@gear", (-0.1, 61.4, 1.7), True),
        ("radial_clearance@bearing4", "unbalance@gear", (20.0,), True),  # at one operating point nothing else is known
    ],
)
def test_a_second_is_not_one_operating_points_alone(
    first: str, second: str, parts: tuple[float, ...], so: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(told_by, "by_play", lambda *_: False)
    setting = SimpleNamespace(direct=SimpleNamespace(evidence={"outer_spall@bearing1": 9.0}))
    assert told_by.repeats(setting, first, second, parts, LEAST_GAIN) is so  # type: ignore[arg-type]
