"""What is refused before anything is computed, and with which words."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reconcile import entry
from reconcile.atlas.places import simulated_channel, simulated_channels
from reconcile.entry import _turning, already_there, check_channels, check_size, reconcile_recordings
from signals.recording import Operating, Recording, Tacho
from sim.core.errors import SpecError
from sim.core.response import Channel
from sim.core.spec import TermSpec
from sim.presets import preset

MACHINE = preset("paper-lightly-damped")


def channel(
    location: str = "bearing1", axis: str = "y", quantity: str = "acceleration", unit: str = "m/s^2"
) -> Channel:
    return Channel(name=f"{location}{axis}", quantity=quantity, unit=unit, location=location, axis=axis)


def recording(*channels: Channel, rate_hz: float = 20480.0, seconds: float = 1.0) -> Recording:
    chosen = channels or (channel(),)
    return Recording(
        sampling_rate_hz=rate_hz,
        channels=chosen,
        samples=np.random.default_rng(0).normal(size=(len(chosen), round(seconds * rate_hz))),
        operating=Operating(shaft="input", speed_hz=30.0),
    )


def test_no_recording_is_refused() -> None:
    with pytest.raises(SpecError, match="at least one recording"):
        reconcile_recordings(MACHINE, [])


def test_more_than_a_request_may_ask_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    one = recording(seconds=0.01)
    check_size([one] * entry.MOST_RECORDINGS, [one] * entry.MOST_RECORDINGS)
    with pytest.raises(SpecError, match="at most 24"):
        check_size([one], [one] * (entry.MOST_RECORDINGS + 1))
    monkeypatch.setattr(entry, "MOST_SAMPLES", 2 * one.samples.size)
    check_size([one], [one])
    with pytest.raises(SpecError, match="too long together"):
        check_size([one, one], [one])


@pytest.mark.parametrize(
    ("other", "field"),
    [
        (recording(channel("bearing2")), r"baseline\[0\]\.channels\[0\]"),
        (recording(channel(axis="x")), r"baseline\[0\]\.channels\[0\]"),
        (recording(channel(quantity="velocity", unit="m/s")), r"baseline\[0\]\.channels\[0\]"),
        (recording(channel(unit="g")), r"baseline\[0\]\.channels\[0\]"),
        (recording(channel(), channel("bearing2")), r"baseline\[0\]\.channels"),
        (recording(rate_hz=10240.0), r"baseline\[0\]\.sampling_rate_hz"),
    ],
)
def test_recordings_that_do_not_match_are_refused_by_field(other: Recording, field: str) -> None:
    with pytest.raises(SpecError, match=field):
        reconcile_recordings(MACHINE, [recording()], [other])
    check_channels([other], [other])


def test_the_odd_one_out_is_told_be_it_the_first() -> None:
    wrong, rest = replace(recording(rate_hz=10240.0), label="now.json"), [recording(), recording()]
    with pytest.raises(SpecError) as refused:
        check_channels([wrong], rest)
    (problem,) = refused.value.problems
    assert "now.json" in problem.field and (problem.given, problem.allowed) == (10240.0, "20480")
    elsewhere = recording(channel("bearing2"))
    with pytest.raises(SpecError) as refused:
        check_channels([elsewhere, recording()], rest)
    assert [p.field for p in refused.value.problems] == ["recording[0].channels[0]"]


def test_of_two_that_differ_neither_is_called_wrong() -> None:
    now, rest = replace(recording(rate_hz=10240.0), label="now.json"), replace(recording(), label="rest.json")
    with pytest.raises(SpecError) as refused:
        check_channels([now], [rest])
    (problem,) = refused.value.problems
    assert problem.field == "rest.json: sampling_rate_hz"
    assert "now.json: sampling_rate_hz, which has 10240 Hz: either may be wrong" in problem.message
    assert (problem.given, problem.allowed) == (20480.0, "the same in both")
    two = replace(recording(channel(), channel("bearing2")), label="two.json")
    with pytest.raises(SpecError, match=r"rest\.json: channels: differs from two\.json: channels, which has 2"):
        check_channels([two], [rest])


@pytest.mark.parametrize("gone", [0, 1, 2])
def test_the_channel_that_is_missing_or_too_many_is_named(gone: int) -> None:
    """Also where those after it stand one place further on."""
    places = ["drive_end", "fan_end", "out_near"]
    whole = recording(*(channel(place) for place in places))
    fewer = recording(*(channel(place) for i, place in enumerate(places) if i != gone))
    for tests, rest, said in (([whole, whole], fewer, "it lacks"), ([fewer, fewer], whole, "it has")):
        with pytest.raises(SpecError) as refused:
            check_channels(tests, [rest])
        (problem,) = refused.value.problems
        assert f"; {said} " in problem.message and f" at {places[gone]} y acceleration" in problem.message
        assert problem.field.endswith("channels") and problem.given == len(rest.channels)


def test_the_same_channels_in_another_order_are_the_same() -> None:
    here, there = recording(channel(), channel("bearing2")), recording(channel("bearing2"), channel())
    check_channels([here], [there])
    check_channels([here], [there, here])


def test_channels_in_another_order_than_their_names_are_told_once() -> None:
    here = recording(channel(), channel("bearing2"))
    renamed = [replace(c, name=name) for c, name in zip(here.channels[::-1], here.names, strict=True)]
    there = replace(here, channels=tuple(renamed), label="rest.json")
    with pytest.raises(SpecError) as refused:
        check_channels([here], [there])
    (problem,) = refused.value.problems
    assert problem.field == "rest.json: channels" and "in another order, which has" in problem.message
    assert problem.message.endswith("either may be wrong") and problem.allowed == "the same in both"
    with pytest.raises(SpecError, match="are the usual ones"):
        check_channels([here], [there, here])


@pytest.mark.parametrize("names", [("a", "b"), ("p", "q")])
def test_channels_in_another_order_under_names_that_tell_nothing_are_told_by_their_places(
    names: tuple[str, str],
) -> None:
    here = recording(replace(channel(), name="a"), replace(channel("bearing2", "x"), name="b"))
    there = recording(replace(channel("bearing2", "x"), name=names[0]), replace(channel(), name=names[1]))
    with pytest.raises(SpecError) as refused:
        check_channels([there], [here, here])
    (problem,) = refused.value.problems
    first, second = (f"{place} acceleration m/s^2" for place in ("bearing1 y", "bearing2 x"))
    assert problem.given == f"{names[0]} at {second}, {names[1]} at {first}"
    assert problem.allowed == f"a at {first}, b at {second}"


def test_matching_recordings_pass_whatever_their_names_and_lengths() -> None:
    renamed = replace(channel(), name="anything")
    check_channels([recording()], [recording(renamed, seconds=2.0)])


@pytest.mark.parametrize(
    ("location", "axis", "name"),
    [
        ("bearing1", "y", "resonator1.y.acceleration"),
        ("bearing1", "x", "bearing1.outer.x.acceleration"),
        ("bearing1", "", "resonator1.y.acceleration"),
        ("resonator3", "y", "resonator3.y.acceleration"),
        ("casing", "y", None),
        ("", "", None),
    ],
)
def test_sensors_stand_where_they_were_mounted(location: str, axis: str, name: str | None) -> None:
    assert simulated_channel(MACHINE, replace(channel(), location=location, axis=axis)) == name


def test_a_place_the_machine_does_not_have_is_refused() -> None:
    with pytest.raises(SpecError, match="is not a place of this machine"):
        simulated_channels(MACHINE, [channel(), channel("casing")])


def test_a_gear_that_only_turns_is_said_to() -> None:
    with pytest.raises(SpecError, match="only turns in this machine") as refused:
        simulated_channels(preset("gear-pair"), [channel("pinion")])
    assert "no part of this machine moves" in refused.value.problems[0].allowed


def test_what_the_machine_has_already_without_a_size_is_said_not_to_be_looked_for() -> None:
    assert already_there(preset("rotor")) == ()
    assert already_there(preset("overhung")) == ()  # effects with a size are candidates that may have grown
    none = TermSpec(term="unbalance", site="pinion", parameters={"moment": 0.0})
    (text,) = already_there(MACHINE.model_copy(update={"terms": [none]}))
    assert text.endswith("unbalance at pinion")


@pytest.mark.parametrize("kind", ["recording", "baseline"])
def test_a_shaft_that_the_machine_has_not_is_refused_with_those_it_has(kind: str) -> None:
    wrong = replace(recording(), operating=Operating(shaft="nope", speed_hz=30.0))
    tests, baselines = ([wrong], [recording()]) if kind == "recording" else ([recording()], [wrong])
    with pytest.raises(SpecError, match=rf"{kind}\[0\]\.operating\.shaft") as refused:
        reconcile_recordings(MACHINE, tests, baselines)
    assert refused.value.problems[0].given == "nope" and "input, output" in refused.value.problems[0].allowed


def test_a_place_that_is_none_is_blamed_where_it_stands() -> None:
    with pytest.raises(SpecError, match="bearing9") as refused:
        reconcile_recordings(MACHINE, [recording(channel("bearing9"))], [recording()])
    assert "baseline" not in str(refused.value) and "bearing1" in refused.value.problems[0].allowed


@pytest.mark.parametrize("tacho", [True, False])
def test_a_recording_that_states_no_speed_turns_as_its_pulses_say_or_as_the_machine_does(tacho: bool) -> None:
    pulses = Tacho(shaft="input", pulse_times_s=np.arange(0.0, 2.0, 1 / 28.0), pulses_per_revolution=1)
    bare = replace(recording(), operating=None, tacho=pulses if tacho else None)
    filled = _turning(MACHINE, bare).operating
    assert filled is not None and filled.shaft == "input"
    assert filled.speed_hz == pytest.approx(28.0 if tacho else 30.0)
