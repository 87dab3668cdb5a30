"""Recordings that cannot go together are refused when asked for, with their fields; doubts stay with the engine."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from jobs.reconciliations.machine import Known, read_form
from jobs.reconciliations.together import check_together
from jobs.status import Status
from reconcile.entry import reconcile_recordings
from signals.recording import Operating, Recording, Tacho
from sim.core.errors import Problem, SpecError
from sim.core.response import Channel
from sim.core.spec import CustomLaw, TermSpec
from sim.presets.catalogue import preset
from tests.service.reconciling import KINEMATICS, World, made

KNOWN = read_form(KINEMATICS)
CHANNEL = made(1).channels[0]


def placed(several: Sequence[Recording], field: str) -> list[Recording]:
    """As they are seen before a job is made: without samples."""
    return [
        replace(one, samples=np.zeros((len(one.channels), 1)), origin="simulated", label=f"{field}.{i}")
        for i, one in enumerate(several)
    ]


def told(tests: Sequence[Recording], baselines: Sequence[Recording] = (), known: Known = KNOWN) -> dict[str, Problem]:
    try:
        check_together(known, placed(tests, "recordings"), placed(baselines, "baselines"))
    except SpecError as error:
        return {p.field: p for p in error.problems}
    return {}


def turning(speed_hz: float, *, rate_hz: float = 51200.0) -> Recording:
    return replace(made(1), sampling_rate_hz=rate_hz, operating=Operating(shaft="input", speed_hz=speed_hz))


REFUSED: list[tuple[Recording, str, object, str]] = [
    (replace(made(2), sampling_rate_hz=2048.0), "baselines.0.sampling_rate_hz", 2048.0, "1024"),
    (
        replace(made(2), channels=(replace(CHANNEL, unit="g"),)),
        "baselines.0.channels.0",
        "bearing1 x acceleration g",
        "m/s^2",
    ),
    (
        replace(made(2), operating=Operating(shaft="output", speed_hz=20.0)),
        "baselines.0.operating.shaft",
        "output",
        "input",
    ),
    (
        replace(made(2), operating=Operating(shaft="input", speed_hz=0.0)),
        "baselines.0.operating.speed_hz",
        0.0,
        "> 0",
    ),
    (
        replace(made(2), operating=Operating(shaft="input", speed_hz=1200.0)),
        "baselines.0.operating.speed_hz",
        1200.0,
        "revolutions",
    ),
]


@pytest.mark.parametrize(("baseline", "field", "given", "allowed"), REFUSED)
def test_the_odd_one_is_named_by_its_place_in_the_request(
    baseline: Recording, field: str, given: object, allowed: str
) -> None:
    found = told([made(1), made(3)], [baseline])
    assert list(found) == [field]
    assert found[field].given == given and allowed in found[field].allowed


@pytest.mark.slow
@pytest.mark.parametrize("baseline", [case[0] for case in REFUSED])
def test_what_is_refused_the_engine_refuses_too(baseline: Recording) -> None:
    with pytest.raises(SpecError):
        reconcile_recordings(KNOWN, [made(1), made(3)], [baseline])


def test_several_things_are_told_together() -> None:
    wrong = replace(made(2), sampling_rate_hz=2048.0, operating=Operating(shaft="inptu", speed_hz=20.0))
    found = told([made(1), made(3)], [wrong])
    assert set(found) == {"baselines.0.sampling_rate_hz", "baselines.0.operating.shaft"}
    assert "did you mean input?" in found["baselines.0.operating.shaft"].message


def test_where_none_is_the_odd_one_the_other_is_named_in_words_of_the_request() -> None:
    found = told([made(1)], [replace(made(2), sampling_rate_hz=2048.0)])
    assert "recordings.0.sampling_rate_hz" in found["baselines.0.sampling_rate_hz"].message


def test_what_hangs_on_samples_is_left_to_the_engine() -> None:
    assert told([made(1), made(3)], [made(2)]) == {}
    assert told([turning(600.0)], [turning(10.0)]) == {}, "lines of the shaft may confirm the fast run"
    assert told([turning(40.0)], [turning(20.0)]) == {}, "operating points may differ"
    assert list(told([turning(1200.0)], [turning(20.0)])) == ["recordings.0.operating.speed_hz"]


def test_pulses_that_say_another_speed_are_certain() -> None:
    pulses = Tacho(shaft="input", pulses_per_revolution=1, pulse_times_s=np.arange(20) / 10.0)
    assert list(told([replace(turning(600.0), tacho=pulses)])) == ["recordings.0.operating.speed_hz"]


def nominal(speed_hz: float) -> Known:
    form = KINEMATICS["kinematics"]
    return read_form({"kinematics": {**form, "shafts": [{"name": "input", "speed_hz": speed_hz}]}})


def test_the_speed_of_the_machine_file_in_rpm_is_told_before_there_is_a_job() -> None:
    found = told([turning(25.0)], (), nominal(1500.0))
    assert list(found) == ["machine.kinematics.shafts.0.speed_hz"]
    (problem,) = found.values()
    assert problem.given == 1500.0 and "1500 rpm = 25 Hz" in problem.message and "revolutions" in problem.allowed
    with pytest.raises(SpecError, match="1500 rpm = 25 Hz"):
        reconcile_recordings(nominal(1500.0), [turning(25.0)], [])
    silent = replace(made(1), operating=None)
    assert list(told([silent], (), nominal(1500.0))) == ["machine.kinematics.shafts.0.speed_hz"], "above Nyquist's"
    pulses = Tacho(shaft="input", pulses_per_revolution=1, pulse_times_s=np.arange(20) / 10.0)
    assert list(told([replace(silent, tacho=pulses)], (), nominal(600.0))) == ["machine.kinematics.shafts.0.speed_hz"]


def test_a_fast_machine_beside_a_slow_roll_is_left_to_the_engine() -> None:
    assert told([turning(10.0)], (), nominal(600.0)) == {}, "its lines may be those of a slow roll"
    assert told([turning(25.0), turning(1500.0)], (), nominal(1500.0)) == {}
    assert told([turning(25.0)], (), nominal(25.0)) == {}


def test_a_place_that_the_simulated_machine_does_not_have() -> None:
    known, elsewhere = preset("paper"), replace(CHANNEL, location="roof")
    test = replace(made(1), channels=(elsewhere,))
    assert list(told([test], (), known)) == ["recordings.0.channels.a.location"]
    assert told([made(1)], [made(2)], known) == {}


@pytest.mark.slow
def test_no_job_is_made_of_what_cannot_go_together(tmp_path: Path) -> None:
    world = World(tmp_path)
    test, baseline = world.recording(1), world.sent(replace(made(2), sampling_rate_hz=2048.0))
    with pytest.raises(SpecError) as refused:
        world.ask([test], baselines=[baseline])
    assert [p.field for p in refused.value.problems] == ["baselines.0.sampling_rate_hz"]
    assert world.ask([test], baselines=[world.recording(2)]).status is Status.ACCEPTED


def driven(rate_hz: float) -> Recording:
    channels = tuple(
        Channel(name=q, quantity=q, unit=u, location="mass", axis="y")
        for q, u in (("force", "N"), ("displacement", "m"))
    )
    return Recording(sampling_rate_hz=rate_hz, channels=channels, samples=np.zeros((2, 1)))


def test_rates_of_a_driven_machine_are_told_before_there_is_a_job() -> None:
    found = told([driven(2000.0), driven(2000.0), driven(1000.0)], [], preset("oscillator"))
    assert list(found) == ["recordings.2.sampling_rate_hz"]
    problem = found["recordings.2.sampling_rate_hz"]
    assert (problem.given, problem.allowed) == (1000.0, "the same in both")
    assert "recordings.0.sampling_rate_hz, which has 2000 Hz" in problem.message
    assert told([driven(2000.0)], [driven(1000.0)], preset("oscillator")) == {}, "a baseline may be at another rate"


@pytest.mark.parametrize(
    ("own", "field"),
    [
        ({"terms": [TermSpec(term="cubic_support", site="mass", parameters={"cubic": 4e10, "spring": 1.0})]}, "terms"),
        ({"custom_laws": [CustomLaw(name="soft", dof="mass.y", expression="-3*z")]}, "custom_laws"),
    ],
)
def test_a_driven_machine_with_laws_of_its_own_is_refused(own: dict[str, object], field: str) -> None:
    oscillator = preset("oscillator")
    assert told([made(1)], known=oscillator) == {}
    (refused,) = told([made(1)], known=oscillator.model_copy(update=own)).values()
    assert refused.field == f"machine.{field}" and refused.given in ("cubic_support", "soft")
    assert "leave them out" in str(refused.allowed)
