"""What is compared with what, and which alarms a recording gets."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from jobs.health.alarms import assess
from jobs.health.baselines import Baselines, alike
from jobs.health.machines import Watched
from jobs.health.words import STATES
from tests.jobs.health.points import point, sound_points

CLIPPED = {"channel": "de", "kind": "clipping", "message": "the signal is cut off", "count": 3}
STUCK = {"channel": "de", "kind": "stuck", "message": "the signal holds one value", "count": 1}


def told(found: Any) -> list[tuple[str, str, str]]:
    return [(a.kind, a.feature, a.severity) for a in found.alarms]


def test_a_step_of_level_is_an_alarm_with_its_rule_and_numbers() -> None:
    found = assess(point("t", {"rms": 2.0, "bearing1.outer": 0.1}), Baselines(sound_points()))
    assert told(found) == [("level", "rms", "alarm")] and found.state == "alarm" and found.baselines == 12
    alarm = found.alarms[0]
    assert alarm.baselines == 12 and alarm.rise_db == pytest.approx(6.0, abs=0.5) and alarm.unit == "m/s^2"
    assert alarm.limit is not None and 1.0 < alarm.limit < 2.0
    assert "MAD" in alarm.rule and "at least 8 baseline recordings" in alarm.rule and "2 dB" in alarm.rule


def test_a_drift_within_the_spread_is_none() -> None:
    baselines = Baselines(sound_points())
    for k in range(20):
        assert assess(point("t", {"rms": 10 ** (0.03 * k / 20)}), baselines).state == "ok"


def test_a_family_needs_six_decibels_and_says_its_part() -> None:
    baselines = Baselines(sound_points())
    assert assess(point("t", {"bearing1.outer": 0.1 * 10 ** (5.0 / 20)}), baselines).alarms == ()
    found = assess(point("t", {"bearing1.outer": 0.1 * 10 ** (8.0 / 20)}), baselines)
    assert told(found) == [("family", "bearing1.outer", "warning")]
    assert "bearing1: outer race" in found.alarms[0].message and found.alarms[0].unit == "1"
    assert told(assess(point("t", {"bearing1.outer": 0.9}), baselines)) == [("family", "bearing1.outer", "alarm")]


@pytest.mark.parametrize(
    ("inner", "severities"),
    [(0.9, [("inner", "alarm"), ("outer", "warning")]), (0.15, [("outer", "alarm")])],
    ids=["risen more", "risen less"],
)
def test_a_sideband_of_a_clearer_family_is_no_alarm_of_its_own(inner: float, severities: list[tuple[str, str]]) -> None:
    sound = [
        replace(p, channels={"de": replace(c, features={**c.features, "bearing1.inner": 0.1})})
        for p in sound_points()
        for c in p.channels.values()
    ]
    seen = point("t", {"bearing1.outer": 0.5, "bearing1.inner": inner})
    marked = replace(seen.channels["de"], sideband_of={"bearing1.outer": "bearing1.inner"})
    found = assess(replace(seen, channels={"de": marked}), Baselines(sound))
    assert [(a.feature.removeprefix("bearing1."), a.severity) for a in found.alarms] == severities
    assert ("sideband of bearing1: inner race" in found.alarms[-1].message) is (inner == 0.9)
    assert ("family", "bearing1.outer", "alarm") in told(assess(seen, Baselines(sound)))


def test_too_few_baselines_give_no_alarm_and_no_all_clear() -> None:
    found = assess(point("t", {"rms": 100.0}), Baselines(sound_points(7)))
    assert found.alarms == () and found.limits == {} and found.state == "unknown" and found.baselines == 7
    assert "there are 7 baselines like it" in found.reasons[0] and "8 are needed" in found.reasons[0]
    assert "there is 1 baseline like" in assess(point("t", {"rms": 1.0}), Baselines(sound_points(1))).reasons[0]
    assert "there are no baselines like" in assess(point("t", {"rms": 1.0}), Baselines([])).reasons[0]


def test_a_recording_less_than_half_as_long_as_its_baselines_is_judged_by_its_rms_alone() -> None:
    baselines = Baselines(sound_points())
    sound = assess(point("t", {"rms": 1.0, "bearing1.outer": 0.9}, duration_s=4.9), baselines)
    assert sound.alarms == () and sound.state == "unknown" and sound.baselines == 0
    assert "lasts 4.9 s" in sound.reasons[0] and "up to 10 s" in sound.reasons[0]
    loud = assess(point("t", {"rms": 2.0, "bearing1.outer": 0.9}, duration_s=1.0), baselines)
    assert told(loud) == [("level", "rms", "alarm")] and loud.state == "alarm"


@pytest.mark.parametrize("duration_s", [5.0, 10.0, 60.0])
def test_a_recording_long_enough_is_judged_whole(duration_s: float) -> None:
    baselines = Baselines(sound_points())
    found = assess(point("t", {"rms": 1.0, "bearing1.outer": 0.9}, duration_s=duration_s), baselines)
    assert told(found) == [("family", "bearing1.outer", "alarm")] and found.reasons == ()


def test_of_baselines_of_several_lengths_those_not_too_long_count() -> None:
    longer = [replace(p, recording=f"long {p.recording}", duration_s=100.0) for p in sound_points(20)]
    found = assess(point("t", {"bearing1.outer": 0.9}), Baselines([*sound_points(8), *longer]))
    assert found.baselines == 8 and found.state == "alarm"


def test_baselines_that_have_nothing_in_common_are_no_comparison() -> None:
    baselines = Baselines(sound_points())
    assert assess(point("t", {"rms": 1.0}), baselines).reasons == ()
    (reason,) = assess(point("t", {"rms": 1.0}, unit="g"), baselines).reasons
    assert "in 8 of the 12 baselines like it" in reason


@pytest.mark.parametrize(
    ("others", "state", "worst"),
    [([], "unknown", "unknown"), ([1.0], "ok", "ok"), ([9.0], "alarm", "alarm"), ([1.0, 9.0, 1.0], "ok", "alarm")],
)
def test_baselines_alone_are_no_all_clear(others: list[float], state: str, worst: str) -> None:
    points = [*sound_points(8), *(point("t", {"rms": rms}) for rms in others)]
    baselines = Baselines(points)
    machine = Watched(name="m", points=tuple(points), assessments=tuple(assess(p, baselines) for p in points))
    assert (machine.state, machine.worst) == (state, worst)


def test_one_baseline_and_a_recording_are_not_judged() -> None:
    points = [*sound_points(1), point("t", {"rms": 9.0})]
    machine = Watched(name="m", points=tuple(points), assessments=tuple(assess(p, Baselines(points)) for p in points))
    assert (machine.state, machine.worst) == ("unknown", "unknown")


@pytest.mark.parametrize(
    ("a", "b", "same"),
    [
        ({"speed_hz": 25.0}, {"speed_hz": 25.7}, True),
        ({"speed_hz": 25.0}, {"speed_hz": 25.9}, False),
        ({"torque_nm": 100.0}, {"torque_nm": 109.0}, True),
        ({"torque_nm": 100.0}, {"torque_nm": 112.0}, False),
        ({"torque_nm": 100.0}, {}, False),
        ({"speed_hz": None}, {"speed_hz": None}, True),
        ({"speed_hz": None}, {}, False),
        ({"sampling_rate_hz": 25_600.0}, {}, False),
        ({"version": ""}, {}, False),
    ],
)
def test_only_like_recordings_are_compared(a: dict[str, Any], b: dict[str, Any], same: bool) -> None:
    one, other = point("a", {"rms": 1.0}, **a), point("b", {"rms": 1.0}, **b)
    assert alike(one, other) is alike(other, one) is same


def test_baselines_of_another_speed_or_unit_count_for_nothing() -> None:
    baselines = Baselines(sound_points() + sound_points(8, 1, speed_hz=40.0))
    assert assess(point("t", {"rms": 5.0}, speed_hz=32.0), baselines).state == "unknown"
    assert assess(point("t", {"rms": 5.0}, unit="g"), baselines).state == "unknown"


def test_a_baseline_is_not_judged_by_the_others() -> None:
    outlier = point("x", {"rms": 9.0}, baseline=True)
    found = assess(outlier, Baselines([*sound_points(), outlier]))
    assert found.alarms == () and found.state == "ok"


def test_a_spoilt_channel_is_told_and_not_judged() -> None:
    found = assess(point("t", {"rms": 5.0}, findings=[STUCK]), Baselines(sound_points()))
    assert told(found) == [("measurement", "stuck", "measurement")] and found.state == "measurement"
    assert "not judged" in found.alarms[0].message


def test_a_clipped_level_is_at_least_what_it_reads() -> None:
    found = assess(point("t", {"rms": 5.0, "bearing1.outer": 0.9}, findings=[CLIPPED]), Baselines(sound_points()))
    assert told(found) == [("level", "rms", "alarm"), ("measurement", "clipping", "measurement")]


def test_a_spoilt_channel_is_no_baseline() -> None:
    spoilt = [point(f"s{i}", {"rms": 50.0}, baseline=True, findings=[CLIPPED]) for i in range(30)]
    assert told(assess(point("t", {"rms": 2.0}), Baselines(sound_points() + spoilt))) == [("level", "rms", "alarm")]


def test_fixed_limits_need_a_class_and_cite_the_standard() -> None:
    values = {"velocity_rms": 5e-3}
    assert assess(point("t", values), Baselines([])).state == "unknown"
    found = assess(point("t", values, vibration_class="group2-rigid"), Baselines([]))
    assert told(found) == [("limit", "velocity_rms", "alarm")]
    assert found.alarms[0].limit == 4.5e-3 and "ISO 10816-3:2009" in found.alarms[0].rule
    calm = assess(point("t", {"velocity_rms": 1e-3}, vibration_class="group2-rigid"), Baselines([]))
    assert calm.state == "unknown" and calm.alarms == ()


def test_states_are_in_order_of_gravity() -> None:
    assert STATES == ("unknown", "ok", "measurement", "warning", "alarm")
