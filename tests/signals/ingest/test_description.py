"""The description: what is required, slips of the pen, remarks, files on disk."""

from __future__ import annotations

import json

import numpy as np
import pytest

from signals.ingest import ingest, read_description, read_recording
from signals.ingest.description import remarks
from sim.core.errors import SpecError

CHANNEL = {"name": "a", "unit": "g"}


def problems(document: object) -> dict[str, str]:
    with pytest.raises(SpecError) as caught:
        read_description(document)
    return {p.field: str(p) for p in caught.value.problems}


def test_every_wrong_field_is_named_at_once() -> None:
    wrong = {"sampling_rate_hz": -1, "channels": [{"name": "a"}, {"unit": "g", "name": ""}], "condition": "good"}
    assert set(problems(wrong)) == {"sampling_rate_hz", "channels.0.unit", "channels.1.name", "condition"}


@pytest.mark.parametrize("document", [None, [], "text", 3, {}, {"channels": []}, {"channels": {}}])
def test_what_is_no_description_is_refused(document: object) -> None:
    assert problems(document)


@pytest.mark.parametrize(
    ("slip", "field", "meant"),
    [
        ({"sampling_rate": 3}, "sampling_rate", "sampling_rate_hz"),
        ({"channels": [{**CHANNEL, "sensitvity": 2}]}, "channels.0.sensitvity", "sensitivity"),
        ({"operating": {"shaft": "input", "speed_hz": 1, "torque_Nm": 2}}, "operating.torque_Nm", "torque_nm"),
    ],
)
def test_a_slip_of_the_pen_is_told_not_ignored(slip: dict, field: str, meant: str) -> None:
    found = problems({"sampling_rate_hz": 1, "channels": [CHANNEL], **slip})
    assert meant in found[field]


def test_other_keys_are_a_persons_own_and_are_mentioned() -> None:
    document = {
        "sampling_rate_hz": 1,
        "channels": [{**CHANNEL, "serial": "A7"}],
        "operating": {"shaft": "input", "speed_hz": 1, "oil": "hot"},
        "rig": "2",
    }
    places = " ".join(remarks(read_description(document)))
    assert all(key in places for key in ("rig", "channels[0].serial", "operating.oil"))


def test_two_channels_of_one_name_are_refused() -> None:
    assert "another channel" in problems({"sampling_rate_hz": 1, "channels": [CHANNEL, CHANNEL]})["channels.1.name"]


def test_a_text_is_no_number_and_a_number_no_text() -> None:
    found = problems({"sampling_rate_hz": "1000", "channels": [{"name": 3, "unit": "g"}]})
    assert set(found) == {"sampling_rate_hz", "channels.0.name"}


def test_the_data_lies_beside_under_the_same_stem(tmp_path) -> None:
    np.savez(tmp_path / "run.1.npz", a=np.arange(10.0))
    np.savez(tmp_path / "run.npz", a=np.arange(20.0))
    (tmp_path / "run.1.json").write_text(json.dumps({"sampling_rate_hz": 1, "channels": [CHANNEL]}))
    assert read_recording(tmp_path / "run.1.json").samples.shape == (1, 10)


def test_which_of_two_files_is_never_guessed(tmp_path) -> None:
    np.savez(tmp_path / "run.npz", a=np.arange(10.0))
    (tmp_path / "run.csv").write_text("a\n" + "1\n2\n" * 8)
    document = {"sampling_rate_hz": 1, "channels": [CHANNEL]}
    (tmp_path / "run.json").write_text(json.dumps(document))
    with pytest.raises(SpecError, match="name one as `data`"):
        read_recording(tmp_path / "run.json")
    (tmp_path / "run.json").write_text(json.dumps({**document, "data": "run.csv"}))
    assert ingest(tmp_path / "run.json").recording.samples.shape == (1, 16)
    (tmp_path / "else.json").write_text(json.dumps(document))
    with pytest.raises(SpecError, match="no data file"):
        read_recording(tmp_path / "else.json")


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("{", "not strict JSON"),
        ('{"sampling_rate_hz": NaN}', "no number"),
        ('{"sampling_rate_hz": 1, "sampling_rate_hz": 2}', "twice"),
        ('{"sampling_rate_hz": 1e999}', "too large"),
        ("[" * 100_000, "nested"),
        ("9" * 6000, "digits"),
        ("\udcff", "UTF-8"),
    ],
)
def test_broken_json_is_refused_in_one_line(tmp_path, text: str, reason: str) -> None:
    (tmp_path / "r.json").write_text(text, errors="surrogateescape")
    with pytest.raises(SpecError, match=reason) as caught:
        read_recording(tmp_path / "r.json")
    assert "\n" not in str(caught.value)
    with pytest.raises(SpecError, match="no such file"):
        read_recording(tmp_path / "nowhere.json")


@pytest.mark.parametrize(
    ("more", "shaft"),
    [
        ({}, "shaft"),
        ({"tacho": {"shaft": "motor", "column": "p"}}, "motor"),
        ({"kinematics": {"shafts": [{"name": "main"}]}}, "main"),
        ({"kinematics": {"shafts": [{"name": "one"}, {"name": "two"}]}}, "shaft"),
        ({"kinematics": {"shafts": 3}, "tacho": 4}, None),
    ],
)
def test_a_shaft_that_is_not_named_is_the_only_one(more: dict, shaft: str | None) -> None:
    document = {"channels": [CHANNEL], "operating": {"speed_hz": 20.0}, **more}
    if shaft is None:
        assert problems(document).keys() >= {"tacho"}
    else:
        operating = read_description(document).operating
        assert operating is not None
        assert operating.shaft == shaft


@pytest.mark.parametrize("none", [{}, {"speed_hz": None}, {"shaft": "s2", "load": "50 %"}, {"speed_hz": "?"}, None])
def test_an_operating_point_without_speed_is_none(none: dict | None) -> None:
    assert read_description({"channels": [CHANNEL], "operating": none}).operating is None


def test_a_speed_in_words_counts_for_nothing_and_that_is_said() -> None:
    found = read_description({"channels": [CHANNEL], "operating": {"shaft": "s", "speed_hz": "thirty", "load": None}})
    assert found.operating is None
    (said,) = remarks(found)
    assert said == "operating.speed_hz: is not used here: it is no number, so no operating point is stated"


def test_a_speed_in_another_unit_at_the_top_is_told_where_it_belongs() -> None:
    (said,) = remarks(read_description({"channels": [CHANNEL], "speed_rpm": 1800}))
    assert "operating.speed_hz" in said and "over 60" in said


@pytest.mark.parametrize(
    "half",
    [
        {"speed_rpm": 1500},
        {"speed_hz": None, "torque_nm": 4.0},
        {"rps": 25},
        {"omega": 157.0},
        {"load": 2},
        {"speed_hz": "29,5"},
        {"shaft": "input", "speed_hz": "29,5 Hz"},
        {"speed_rpm": "1500"},
        {"shaft": 5},
    ],
)
def test_a_speed_under_another_name_or_a_torque_without_one_is_refused(half: dict) -> None:
    assert any(field.startswith("operating") for field in problems({"channels": [CHANNEL], "operating": half}))
