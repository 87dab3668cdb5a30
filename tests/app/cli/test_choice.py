"""`--preset`, `--machine`, `--set`."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.cli.choice import changed, machine_document, parse_set, read_machine
from sim.core.errors import SpecError
from sim.core.spec import RampSpeed, TorqueLoad
from sim.presets import preset


def test_values_are_json_or_text() -> None:
    assert parse_set(["a.b=2e-5", "c=true", "d=printed", "e=null"]) == {
        "a.b": 2e-5,
        "c": True,
        "d": "printed",
        "e": None,
    }
    assert parse_set(['profile={"kind": "ramp", "end_ratio": 2}']) == {"profile": {"kind": "ramp", "end_ratio": 2}}


def test_a_broken_object_is_told_where_it_breaks() -> None:
    with pytest.raises(SpecError, match=r"--set profile: is not readable JSON.*line 1"):
        parse_set(['profile={"kind": "ramp"'])


def test_a_speed_profile_is_given_as_plainly_as_any_value() -> None:
    whole = changed(preset("paper"), parse_set(['profile={"kind": "ramp", "end_ratio": 2, "duration_s": 1}']))
    single = parse_set(["profile.kind=ramp", "profile.end_ratio=2", "profile.duration_s=1"])
    assert changed(preset("paper"), single) == whole
    assert whole.operating is not None and whole.operating.profile == RampSpeed(end_ratio=2.0, duration_s=1.0)


@pytest.mark.parametrize("text", ["gap", "=3", ""])
def test_what_is_not_key_value_is_refused(text: str) -> None:
    with pytest.raises(SpecError, match="KEY=VALUE"):
        parse_set([text])


@pytest.mark.parametrize(
    "items", [("speed_hz=20", "operating.speed_hz=30"), ("speed_hz=20", "speed_hz=20"), ("torque=3", "torque_nm=3")]
)
def test_a_key_given_twice_is_refused(items: tuple[str, ...]) -> None:
    with pytest.raises(SpecError, match=r"--set (speed_hz|torque): is given twice"):
        changed(preset("paper"), parse_set(items))


def test_a_term_is_changed_or_added() -> None:
    demo = changed(preset("paper-demo"), {"fit_clearance@bearing1.gap": 1e-5, "unbalance@gear.moment": 1e-4})
    found = {(t.term, t.site): t.parameters for t in demo.terms}
    assert found["fit_clearance", "bearing1"]["gap"] == 1e-5
    assert "damping" not in found["fit_clearance", "bearing1"]  # the machine's own collision damping stays
    assert found["unbalance", "gear"] == {"moment": 1e-4}


@pytest.mark.parametrize("name", ["torque_nm", "torque"])
def test_torque_is_the_driven_shafts_and_scales_a_given_output(name: str) -> None:
    machine = preset("paper").model_copy(
        update={"loads": [TorqueLoad(shaft="input", torque_nm=23.0), TorqueLoad(shaft="output", torque_nm=-81.0)]}
    )
    loads = changed(machine, {name: 46.0}).loads
    assert [load.torque_nm for load in loads if isinstance(load, TorqueLoad)] == [46.0, -162.0]


@pytest.mark.parametrize(
    ("key", "value"), [("torque", "x"), ("torque_nm", 1e9), ("speed", 3), ("operating.speed_hz", -1)]
)
def test_wrong_changes_are_refused(key: str, value: object) -> None:
    with pytest.raises(SpecError):
        changed(preset("paper"), {key: value})


def test_torque_needs_a_driven_shaft() -> None:
    with pytest.raises(SpecError, match="torque"):
        changed(preset("oscillator"), {"torque": 3.0})


def test_a_parameter_file_is_recognised_where_a_machine_is_due(tmp_path: Path) -> None:
    path = tmp_path / "p.json"
    path.write_text('{"parameters": {"If1": 1}}')
    with pytest.raises(SpecError, match="--from-reference"):
        read_machine(path)


@pytest.mark.parametrize(
    "text",
    [
        "{",
        "[1]",
        '{"name": NaN}',
        '{"name": "a", "name": "b"}',
        f'{{"x": {"9" * 5000}}}',
        '{"name": "x", "wheels": 4}',
        '{"name": ""}',
    ],
)
def test_broken_machine_files_are_refused(tmp_path: Path, text: str) -> None:
    path = tmp_path / "m.json"
    path.write_text(text)
    with pytest.raises(SpecError):
        read_machine(path)


@pytest.mark.parametrize(("name", "meant"), [("paper-dmo", "paper-demo"), ("two_stage", "two-stage")])
def test_a_machine_file_that_is_not_there_may_have_been_a_preset(name: str, meant: str) -> None:
    with pytest.raises(SpecError, match=rf"{name}: no such file \(did you mean --preset {meant}\?\)"):
        read_machine(Path(name))
    with pytest.raises(SpecError, match=rf"{name}: no such file \(did you mean {meant}\?\).*or a preset: .*overhung"):
        machine_document(Path(name), presets_too=True)


def test_a_machine_file_that_is_not_there_is_only_that(tmp_path: Path) -> None:
    with pytest.raises(SpecError) as refused:
        read_machine(tmp_path / "machine.json")
    assert "did you mean" not in str(refused.value) and "no such file" in str(refused.value)
