"""What descriptions state is held against the machine: shafts, places of sensors, rpm where Hz is asked."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

from reconcile.entry import reconcile_recordings
from reconcile.kinematics import read_kinematic_spec
from reconcile.stated import check_speeds, exchanged, given, sixty_times
from reconcile.unstated import unstated
from reconcile.verdict import Report
from signals.recording import Operating, Recording, Tacho
from sim.core.errors import SpecError
from sim.core.response import Channel
from tests.strategies.impulses import recorded, shaft_lines

SPEC = read_kinematic_spec(
    {
        "kinematics": {
            "shafts": [{"name": "shaft", "speed_hz": 24.3}],
            "bearings": [{"name": "bearing1", "shaft": "shaft", "catalogue": "6205"}],
        }
    }
)


def quiet(
    speed_hz: float = 24.3,
    *,
    shaft: str = "shaft",
    rate_hz: float = 20_000.0,
    location: str = "bearing1",
    seed: int = 0,
) -> Recording:
    return Recording(
        sampling_rate_hz=rate_hz,
        channels=(Channel(name="a", quantity="acceleration", unit="m/s^2", location=location, axis="y"),),
        samples=np.random.default_rng(seed).standard_normal((1, 40_000)),
        operating=Operating(shaft=shaft, speed_hz=speed_hz),
    )


def refused(*tests: Recording, baselines: tuple[Recording, ...] = (), spec: Any = SPEC) -> SpecError:
    with pytest.raises(SpecError) as caught:
        reconcile_recordings(spec, list(tests), list(baselines))
    return caught.value


def test_a_shaft_that_the_machine_lacks_is_refused_even_where_it_has_one_only() -> None:
    (problem,) = refused(replace(quiet(shaft="motor"), label="t/1.json")).problems
    assert problem.field == "t/1.json: operating.shaft"
    assert (problem.given, problem.allowed) == ("motor", "shaft")


def test_pulses_of_a_shaft_that_the_machine_lacks_are_not_left_unused() -> None:
    tacho = Tacho(shaft="motor", pulse_times_s=np.arange(0, 2, 0.04))
    (problem,) = refused(quiet(), baselines=(replace(quiet(), tacho=tacho),)).problems
    assert (problem.field, problem.given, problem.allowed) == ("baseline[0].tacho.shaft", "motor", "shaft")


def test_a_place_that_is_nearly_a_part_is_refused_with_the_parts() -> None:
    (problem,) = refused(replace(quiet(location="bearnig1"), label="t1.json")).problems
    assert problem.field == "t1.json: channels.a.location"
    assert problem.given == "bearnig1" and problem.allowed.startswith("shaft, bearing1")
    assert "did you mean bearing1" in problem.message


@cache
def placeless() -> Report:
    return reconcile_recordings(SPEC, [quiet(location="")], [quiet(location="", seed=1)])


@pytest.mark.slow
@pytest.mark.parametrize("location", ["bearing2", "motor housing", "brg1", "bearing bracket"])
def test_a_place_that_is_no_part_is_a_remark(location: str) -> None:
    report = reconcile_recordings(SPEC, [quiet(location=location)], [quiet(location=location, seed=1)])
    remark = f"a at {location}: no part of this machine, so the place is taken as not known"
    assert report.where.limits.count(remark) == 1
    unknown = placeless()
    assert (report.verdict, report.sentence, report.where.sites) == (
        unknown.verdict,
        unknown.sentence,
        unknown.where.sites,
    )


@pytest.mark.slow
def test_a_place_that_is_not_known_passes() -> None:
    assert placeless().level == "kinematics"
    alone = read_kinematic_spec({"kinematics": {"shafts": [{"name": "shaft"}]}})
    assert reconcile_recordings(alone, [quiet(location="near the motor")]).level == "kinematics"


@pytest.mark.parametrize(
    ("one", "why"),
    [
        (quiet(1458.0), "nominal speed is 24.3 Hz"),
        (quiet(1500.0), "nominal speed is 24.3 Hz"),
        (replace(quiet(1458.0), tacho=Tacho(shaft="shaft", pulse_times_s=np.arange(0, 2, 1 / 24.3))), "its tacho says"),
    ],
)
def test_rpm_is_told_by_the_machine_or_the_pulses(one: Recording, why: str) -> None:
    (problem,) = refused(replace(one, label="t1.json")).problems
    assert problem.field == "t1.json: operating.speed_hz"
    assert f"looks like rpm: {problem.given:g} rpm = {problem.given / 60:.4g} Hz" in problem.message  # type: ignore[operator]
    assert why in problem.message


def test_rpm_is_told_by_the_other_recordings_and_by_the_rate() -> None:
    for several in (given([quiet(1797.0)], [quiet(29.95)]), given([quiet(1797.0, rate_hz=2000.0)], [])):
        with pytest.raises(SpecError, match=r"1797 rpm = 29\.95 Hz"):
            check_speeds({"shaft": None}, "", several)


def test_a_nominal_speed_in_rpm_is_refused_at_the_machine() -> None:
    with pytest.raises(SpecError, match=r"kinematics\.shafts\.shaft\.speed_hz: looks like rpm"):
        check_speeds({"shaft": 1797.0}, "kinematics.shafts.{shaft}.speed_hz", given([quiet(29.95)], []))


def test_rpm_is_told_by_the_lines_alone() -> None:
    rng = np.random.default_rng(3)
    rows = shaft_lines(rng) + 0.1 * rng.standard_normal(100_000)
    check_speeds({"shaft": None}, "", given([recorded(rows)], []))
    with pytest.raises(SpecError, match=r"lines of a shaft stand at multiples of 24\.3 Hz"):
        check_speeds({"shaft": None}, "", given([recorded(rows, speed_hz=1458.0)], []))


@pytest.mark.parametrize("speed_hz", [0.4, 12.0, 30.0, 150.0, 300.0, 700.0])
def test_slow_runs_fast_machines_and_noise_are_no_rpm(speed_hz: float) -> None:
    check_speeds({"shaft": None}, "", given([quiet(speed_hz)], []))
    check_speeds({"shaft": speed_hz}, "", given([quiet(speed_hz)], [quiet(speed_hz)]))
    check_speeds({"shaft": 30.0}, "", given([quiet(min(speed_hz, 150.0))], []))


def test_sixty_is_met_closely() -> None:
    assert sixty_times(1797, 29.95) and sixty_times(1500, 25.8) and sixty_times(150, 2.5)
    assert not sixty_times(150, 3.0) and not sixty_times(300, 30) and not sixty_times(29.95, 29.95)
    assert not sixty_times(1500, 30) and not sixty_times(300, 4.0)


def turning(speed_hz: float, at_hz: float | None = None) -> Recording:
    """A shaft's lines at `at_hz` under a statement of `speed_hz`."""
    rng = np.random.default_rng(3)
    lines = shaft_lines(rng, speed_hz if at_hz is None else at_hz)
    return recorded(lines + 0.1 * rng.standard_normal(100_000), speed_hz=speed_hz)


@pytest.mark.parametrize(
    ("nominal", "speeds"),
    [
        (None, (5.0, 300.0)),
        (300.0, (5.0,)),
        (300.0, (5.0, 150.0, 300.0)),
        (0.5, (30.0,)),
        (250.0, (4.0, 250.0)),
    ],
)
def test_slow_rolls_of_fast_machines_are_no_rpm(nominal: float | None, speeds: tuple[float, ...]) -> None:
    check_speeds({"shaft": nominal}, "machine.speed_hz", given([turning(s) for s in speeds], []))


def test_a_speed_about_the_nominal_one_is_no_rpm_whatever_its_lines() -> None:
    check_speeds({"shaft": 300.0}, "", given([quiet(310.0)], [turning(5.0)]))
    check_speeds({"shaft": None, "fast": 300.0}, "", given([quiet(310.0)], [turning(5.0)]))
    check_speeds({"shaft": 300.0}, "", given([quiet(310.0, rate_hz=600.0)], []))


def test_what_no_line_confirms_stays_rpm_beside_a_slow_recording() -> None:
    for several in ([turning(1458.0, at_hz=24.3), turning(24.3)], [quiet(300.0), turning(5.0)]):
        with pytest.raises(SpecError, match="looks like rpm"):
            check_speeds({"shaft": None}, "", given(several, []))


def test_lines_at_a_sixtieth_too_do_not_confirm() -> None:
    teeth = turning(1458.0)  # the lines of a wheel of 60 teeth on a shaft at 24.3 Hz
    both = replace(teeth, samples=teeth.samples + turning(24.3).samples)
    with pytest.raises(SpecError, match=r"1458 rpm = 24\.3 Hz \(the machine's nominal speed is 24\.3 Hz"):
        check_speeds({"shaft": 24.3}, "", given([both], []))


def test_a_standstill_without_pulses_is_refused_by_its_field() -> None:
    (problem,) = refused(quiet(0.0)).problems
    assert problem.field.endswith("operating.speed_hz") and "stands still" in problem.message


@pytest.mark.slow
def test_a_speed_that_nobody_stated_is_told() -> None:
    silent = replace(quiet(), operating=None)
    report = reconcile_recordings(SPEC, [silent], [quiet(seed=1)])
    assert "test 1 states no speed: the machine file's was taken" in report.where.limits
    stated = reconcile_recordings(SPEC, [quiet()], [quiet(seed=1)])
    assert not any("states no speed" in limit for limit in stated.where.limits)


def test_a_speed_that_nobody_stated_but_lines_tell_is_told_with_what_they_tell() -> None:
    silent = [replace(quiet(), operating=None)] * 2
    rows = {"test 1": {"speed_hz": 29.897, "method": "harmonics"}, "test 2": {"speed_hz": 30.0, "method": "stated"}}
    report = Report(verdict="nothing_missing", sentence="", level="kinematics")
    found, taken = unstated(given(silent, []), replace(report, stages=({"name": "speed", "found": rows},)))
    assert found.startswith("test 1 ") and found.endswith("was the start, lines of the shaft were found at 29.9 Hz")
    assert taken == "test 2 states no speed: the machine file's was taken"
    (both,) = unstated(given(silent, []), report)
    assert both == "test 1, test 2 state no speed: the machine file's was taken"


def test_sixty_times_the_drawing_and_far_too_fast_is_rpm_whatever_its_lines(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("reconcile.stated.confirmed", lambda *_: True)
    machine = {"shaft": 24.3}
    with pytest.raises(SpecError, match="looks like rpm"):
        check_speeds(machine, "f", given([quiet(1458.0)], []))
    check_speeds({"shaft": 8.0}, "f", given([quiet(480.0)], []))


def test_a_test_that_is_called_a_baseline_beside_baselines_that_are_not_is_told() -> None:
    one, other = quiet(), replace(quiet(), condition="baseline")
    assert exchanged(given([other], [one])) and not exchanged(given([one], [other]))
    assert not exchanged(given([other], [other])) and not exchanged(given([other], []))


def pulsed(speed_hz: float, *, shaft: str = "shaft") -> Recording:
    """Pulses, and no stated speed."""
    times = np.arange(0.0, 2.0, 1.0 / speed_hz)
    tacho = Tacho(pulse_times_s=times, pulses_per_revolution=1, shaft=shaft)
    return replace(quiet(shaft=shaft), operating=None, tacho=tacho)


def test_pulses_counted_sixty_to_a_turn_are_the_tachos_fault_where_the_speed_is_the_machines_own() -> None:
    tacho = Tacho(pulse_times_s=np.arange(0.0, 20.0, 1.0 / 24.3), pulses_per_revolution=60, shaft="shaft")
    with pytest.raises(SpecError) as refusal:
        check_speeds({"shaft": 24.0}, "", given([replace(quiet(24.3), tacho=tacho)], []))
    (problem,) = refusal.value.problems
    assert problem.field == "recording[0].tacho.pulses_per_revolution"
    assert (problem.given, problem.allowed) == (60, "about 1 with this speed")
    with pytest.raises(SpecError, match="looks like rpm"):  # the machine says otherwise
        check_speeds({"shaft": 0.4}, "", given([replace(quiet(24.3), tacho=tacho)], []))


FIELD = "kinematics.shafts.{shaft}.speed_hz"


def test_the_machines_speed_in_rpm_is_told_by_pulses_alone() -> None:
    with pytest.raises(SpecError, match=r"1797 rpm = 29\.95 Hz \(the pulses of recording\[0\]\.tacho say"):
        check_speeds({"shaft": 1797.0}, FIELD, given([pulsed(29.95)], []))
    check_speeds({"shaft": 1797.0}, FIELD, given([pulsed(24.0)], []))  # may be a slow roll
    check_speeds({"shaft": 29.95}, FIELD, given([pulsed(29.95)], []))


def test_the_machines_speed_in_rpm_is_told_at_another_load_too() -> None:
    with pytest.raises(SpecError, match=r"1800 rpm = 30 Hz \(recording\[0\]\.operating\.speed_hz is 25\)"):
        check_speeds({"shaft": 1800.0}, FIELD, given([quiet(25.0)], []))
    check_speeds({"shaft": 1800.0}, FIELD, given([quiet(12.0)], []))


def test_a_shaft_whose_speed_nothing_tells_does_not_outrun_the_sampling() -> None:
    several = given([quiet(25.0, rate_hz=2000.0)], [])
    with pytest.raises(SpecError, match=r"shafts\.other\.speed_hz: looks like rpm.*half the sampling rate is 1000 Hz"):
        check_speeds({"shaft": 25.0, "other": 1500.0}, FIELD, several)
    check_speeds({"shaft": 25.0, "other": 300.0}, FIELD, several)
