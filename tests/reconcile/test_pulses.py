"""Pulses that contradict the stated speed are refused at level kinematics, unless lines of the shaft speak for them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reconcile.entry import reconcile_recordings
from reconcile.kinematics import read_kinematic_spec
from reconcile.pulses import check_pulses, contradiction
from reconcile.stated import given
from signals.recording import Operating, Recording, Tacho
from sim.core.errors import SpecError
from tests.strategies.impulses import N, recorded, shaft_lines

SPEC = read_kinematic_spec(
    {
        "kinematics": {
            "shafts": [{"name": "shaft", "speed_hz": 30.0}],
            "bearings": [{"name": "bearing1", "shaft": "shaft", "catalogue": "6205"}],
        }
    }
)


def turning(
    hz: float, *, stated: float, pulses: float | None = None, per_turn: int = 1, lines: bool = True
) -> Recording:
    """Lines of a shaft at `hz`; pulses of it (or `pulses` a second) told as so many per turn."""
    rng = np.random.default_rng(3)
    samples = (shaft_lines(rng, hz) if lines else 0.0) + rng.standard_normal(N)
    one = recorded(samples, hz)
    tacho = Tacho(
        shaft="shaft", pulse_times_s=np.arange(0.01, 1.9, 1.0 / (pulses or hz)), pulses_per_revolution=per_turn
    )
    return replace(one, operating=Operating(shaft="shaft", speed_hz=stated), tacho=tacho, label="t.json")


@pytest.mark.parametrize("per_turn", [2, 3, 4])
def test_a_miscounted_number_of_pulses_is_refused_with_the_one_that_fits(per_turn: int) -> None:
    with pytest.raises(SpecError) as caught:
        reconcile_recordings(SPEC, [turning(30.0, stated=30.0, per_turn=per_turn)])
    (problem,) = caught.value.problems
    assert problem.field == "t.json: tacho.pulses_per_revolution" and problem.given == per_turn
    assert "(pulses_per_revolution 1 would fit)" in str(problem.allowed)


def test_times_in_milliseconds_are_told_as_such() -> None:
    one = turning(30.0, stated=30.0)
    assert one.tacho is not None
    late = replace(one, tacho=replace(one.tacho, pulse_times_s=1000.0 * one.tacho.pulse_times_s))
    with pytest.raises(SpecError, match="the times look like milliseconds") as caught:
        reconcile_recordings(SPEC, [late])
    (problem,) = caught.value.problems
    assert (problem.field, problem.allowed) == ("t.json: tacho.pulse_times_s", "times in seconds")
    assert str(problem.given).startswith("10 to 18")


def test_pulses_win_where_the_lines_of_the_shaft_are_at_their_speed() -> None:
    check_pulses(given([turning(30.0, stated=22.5)], []))
    with pytest.raises(SpecError, match=r"make 40 Hz, but 30 Hz are stated"):
        check_pulses(given([turning(30.0, stated=30.0, pulses=40.0)], []))
    with pytest.raises(SpecError, match=r"make 30 Hz, but 22.5 Hz are stated"):
        check_pulses(given([turning(30.0, stated=22.5, lines=False)], []))


def test_labels_may_be_wrong_by_some_per_cent() -> None:
    check_pulses(given([turning(30.0, stated=28.0)], []))


def test_a_run_up_may_state_any_speed_it_has() -> None:
    turns = np.arange(0, 60)
    times = (np.sqrt(20.0**2 + 2 * 10.0 * turns) - 20.0) / 10.0  # 20 Hz and 10 Hz/s more
    one = replace(turning(30.0, stated=21.0, lines=False), tacho=Tacho(shaft="shaft", pulse_times_s=times))
    check_pulses(given([one], []))
    assert contradiction(one, "f") is not None, "which its mean is not"
    slow = replace(one, operating=Operating(shaft="shaft", speed_hz=12.0))
    with pytest.raises(SpecError):
        check_pulses(given([slow], []))


@pytest.mark.parametrize(("per_turn", "refuses"), [(11, True), (10, False)])
def test_pulses_miscounted_by_less_than_a_tenth_are_told_by_the_lines(per_turn: int, refuses: bool) -> None:
    one = turning(30.0, stated=30.0, pulses=300.0, per_turn=per_turn)
    if not refuses:
        return check_pulses(given([one], []))
    with pytest.raises(SpecError, match=r"pulses_per_revolution 10 would fit"):
        check_pulses(given([one], []))
    label = turning(27.3, stated=30.0, pulses=300.0, per_turn=11)
    return check_pulses(given([label], []))  # the label is wrong, as its lines say


GEARED = read_kinematic_spec(
    {
        "kinematics": {
            "shafts": [{"name": "shaft", "speed_hz": 30.0}, {"name": "slow"}],
            "bearings": [{"name": "bearing1", "shaft": "shaft", "catalogue": "6205"}],
            "gears": [{"name": "a", "shaft": "shaft", "teeth": 20}, {"name": "b", "shaft": "slow", "teeth": 60}],
            "meshes": [{"name": "m", "gears": ["a", "b"]}],
        }
    }
)


def of_slow(pulses: float, per_turn: int = 1, *, stated: bool = True) -> Recording:
    """A shaft at 30 Hz; `pulses` a second that are said to be of a shaft a third as fast."""
    one = turning(30.0, stated=30.0, pulses=pulses, per_turn=per_turn)
    assert one.tacho is not None
    tacho = replace(one.tacho, shaft="slow")
    return replace(one, tacho=tacho, operating=one.operating if stated else None)


def test_pulses_of_another_shaft_are_held_against_what_the_teeth_make_of_the_stated_speed() -> None:
    for right in (of_slow(10.0), of_slow(40.0, 4), of_slow(10.2)):
        check_pulses(given([right], []), GEARED)
    with pytest.raises(SpecError, match=r"make 20 Hz, but 10 Hz of slow go with the 30 Hz stated of shaft.*\b2 would"):
        reconcile_recordings(GEARED, [of_slow(20.0)])
    with pytest.raises(SpecError, match="make 30 Hz, but 10 Hz of slow"):
        check_pulses(given([of_slow(30.0)], []), GEARED)  # lines at 30 Hz are the stated shaft's


def test_without_a_stated_speed_pulses_are_held_against_the_machines_own_but_a_drive_may_leave_it() -> None:
    def bare(pulses: float) -> Recording:
        return replace(turning(30.0, stated=30.0, pulses=pulses, lines=False), operating=None)

    with pytest.raises(SpecError, match=r"make 60 Hz, but 30 Hz are in the machine file.*\b2 would fit"):
        check_pulses(given([bare(60.0)], []), SPEC)
    with pytest.raises(
        SpecError, match=r"make 30 Hz, but 10 Hz of slow go with the 30 Hz in the machine file of shaft"
    ):
        check_pulses(given([of_slow(30.0, stated=False)], []), GEARED)
    for free in (bare(30.0), bare(23.0), bare(41.0)):
        check_pulses(given([free], []), SPEC)
        check_pulses(given([free], []))


def test_shafts_that_nothing_ties_are_not_compared() -> None:
    apart = GEARED.model_copy(update={"meshes": []})
    check_pulses(given([of_slow(20.0)], []), apart)


def crossings(seconds: float = 1.9) -> np.ndarray:
    """What a vibration gives where its crossings are counted: 30 Hz 21 times a turn on the mean."""
    steps = np.random.default_rng(8).uniform(0.3, 1.7, 4000) / (21 * 30.0)
    times = np.cumsum(steps)
    return times[times < seconds]


def test_a_count_is_recommended_for_a_pulse_train_only() -> None:
    """Random crossings fit some whole number; an even train, one with lost pulses and uneven teeth are pulses."""
    one = turning(30.0, stated=30.0, lines=False)

    def problem(times: np.ndarray, per_turn: int = 1) -> str:
        tacho = Tacho(shaft="shaft", pulse_times_s=times, pulses_per_revolution=per_turn)
        found = contradiction(replace(one, tacho=tacho), "tacho.pulses_per_revolution")
        assert found is not None
        return str(found)

    said = problem(crossings())
    assert "do not look like those of a tacho" in said and "would fit" not in said
    even = np.arange(0.01, 1.9, 1 / 630.0)
    lost = np.delete(even, np.random.default_rng(2).choice(even.size, even.size // 20, replace=False))
    for train in (even, even + np.random.default_rng(3).normal(0, 2e-5, even.size), lost):
        assert "does" not in problem(train) and "do not look" not in problem(train)
    assert "pulses_per_revolution 21 would fit" in problem(even)
    uneven_teeth = (np.arange(0, 60)[:, None] + np.array([0.0, 0.2, 0.55, 0.7])).ravel() / 30.0
    assert "pulses_per_revolution 4 would fit" in problem(uneven_teeth, 4 * 2) or "would fit" in problem(
        uneven_teeth, 8
    )


def test_a_recording_of_no_turn_is_too_short_to_be_judged_by_pulses() -> None:
    one = turning(30.0, stated=30.0)
    cut = replace(
        one, samples=one.samples[:, :40], tacho=Tacho(shaft="shaft", pulse_times_s=np.array([0.0004, 0.0011]))
    )
    with pytest.raises(SpecError, match=r"samples: are too short to hold turns of the shaft.*'40 samples, 0\.06 turns"):
        check_pulses(given([cut], []))


@pytest.mark.parametrize("doubled", [True, False])
def test_a_doubled_rate_is_named_beside_the_count_where_the_lines_stand_with_the_pulses(doubled: bool) -> None:
    """A rate stated twice too high lifts pulses and lines alike; a wheel of two teeth leaves the lines."""
    one = turning(56.0 if doubled else 28.0, stated=28.0, pulses=56.0)
    with pytest.raises(SpecError, match="pulses_per_revolution 2 would fit") as caught:
        check_pulses(given([one], []))
    (problem,) = caught.value.problems
    assert ("a sampling_rate_hz of 10000 or a speed_hz of 56 would fit as well" in problem.allowed) == doubled
