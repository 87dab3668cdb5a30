"""`sideband reconcile`: wrong input ends with exit code 2 and says what is wrong; a report is two files."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from app.cli import reconcile as command
from app.cli.main import main
from app.cli.reconcile import _Shown
from reconcile.kinematics import KinematicSpec
from sim.core.spec import MachineSpec
from sim.presets import preset


@pytest.fixture
def machine(tmp_path: Path) -> Path:
    path = tmp_path / "machine.json"
    path.write_text(preset("paper-lightly-damped").model_dump_json(), encoding="utf-8")
    return path


def asked(machine: Path, recording: Path, out: Path, *more: str) -> list[str]:
    return ["reconcile", "--machine", str(machine), "--recording", str(recording), "--out", str(out), *more]


@pytest.mark.parametrize("jobs", ["0", "65"])
def test_jobs_are_bounded(machine: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], jobs: str) -> None:
    assert main(asked(machine, tmp_path / "r.json", tmp_path / "out", "--jobs", jobs)) == 2
    assert "--jobs" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_files_that_are_not_there_are_said(machine: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(asked(machine, tmp_path / "none.json", tmp_path / "out")) == 2
    assert "none.json" in capsys.readouterr().err
    assert main(asked(tmp_path / "nothing.json", tmp_path / "none.json", tmp_path / "out")) == 2
    assert "nothing.json" in capsys.readouterr().err


def test_a_machine_that_is_none_is_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "m.json"
    for text in ("{", '{"wheels": 4}', '{"kinematics": {"shafts": []}}'):
        path.write_text(text, encoding="utf-8")
        assert main(asked(path, tmp_path / "r.json", tmp_path / "out")) == 2
        told = capsys.readouterr().err
        assert told and "Traceback" not in told


def test_the_three_forms_of_a_machine(machine: Path, tmp_path: Path) -> None:
    assert isinstance(command._machine(machine), MachineSpec)
    path = tmp_path / "k.json"
    path.write_text(
        json.dumps(
            {
                "kinematics": {
                    "shafts": [{"name": "shaft"}],
                    "bearings": [{"name": "bearing1", "shaft": "shaft", "catalogue": "6205"}],
                }
            }
        ),
        encoding="utf-8",
    )
    assert isinstance(command._machine(path), KinematicSpec)


def test_all_that_is_wrong_with_kinematics_is_told_at_once(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "k.json"
    shafts = [{"name": "shaft", "rpm": 1500}]
    bearings = [{"name": "a", "shaft": "shfat", "catalogue": "6205"}, {"name": "b", "shaft": "shaft", "catalogue": "0"}]
    path.write_text(json.dumps({"kinematics": {"shafts": shafts, "bearings": bearings}, "x": 1}), encoding="utf-8")
    assert main(asked(path, tmp_path / "r.json", tmp_path / "out")) == 2
    told = capsys.readouterr().err.splitlines()
    assert all(line.startswith(f"error: {path}: ") and "allowed: " in line for line in told)
    assert sorted(line.split(": ")[2] for line in told) == [
        "kinematics.bearings.0.shaft",
        "kinematics.bearings.1.catalogue",
        "kinematics.shafts.0.rpm",
        "x",
    ]
    assert any("1500 rpm are speed_hz 25" in line for line in told)


def test_a_preset_is_a_machine_and_a_recording_is_none(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    found = command._machine(Path("bearing-rig"))
    assert isinstance(found, MachineSpec) and found == preset("bearing-rig")
    path = tmp_path / "r.json"
    path.write_text(json.dumps({"channels": [], "sampling_rate_hz": 20480}), encoding="utf-8")
    assert main(asked(path, path, tmp_path / "out")) == 2
    told = capsys.readouterr().err
    assert "describes a recording, not a machine" in told and "bearing-rig" in told and told.count("error") == 1
    assert main(asked(Path("bearing-rg"), path, tmp_path / "out")) == 2
    told = capsys.readouterr().err
    assert "bearing-rg: no such file (did you mean bearing-rig?)" in told and "two-stage" in told


def test_arguments_that_are_missing_end_with_2(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["reconcile", "--out", "x"])
    assert ended.value.code == 2
    assert "--machine" in capsys.readouterr().err


@pytest.mark.slow
def test_a_report_is_written_for_kinematics_alone(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    rate_hz = 20_000
    np.savetxt(tmp_path / "r.csv", np.random.default_rng(0).normal(size=(4 * rate_hz, 1)), fmt="%.5f", header="a")
    description = {
        "sampling_rate_hz": rate_hz,
        "channels": [{"name": "a", "quantity": "acceleration", "unit": "m/s^2", "location": "bearing1", "axis": "y"}],
        "operating": {"shaft": "shaft", "speed_hz": 25.0},
    }
    (tmp_path / "r.json").write_text(json.dumps(description), encoding="utf-8")
    machine = {
        "kinematics": {
            "shafts": [{"name": "shaft"}],
            "bearings": [{"name": "bearing1", "shaft": "shaft", "catalogue": "6205"}],
        }
    }
    (tmp_path / "k.json").write_text(json.dumps(machine), encoding="utf-8")
    asked_for = asked(tmp_path / "k.json", tmp_path / "r.json", tmp_path / "out", "--jobs", "1")
    code = main([*asked_for, "--atlas", str(tmp_path / "atlas")])
    told = capsys.readouterr()
    assert code == 0, told.err
    assert told.out.startswith("not_decidable: Nothing stands out of noise")
    assert json.loads((tmp_path / "out" / "report.json").read_text(encoding="utf-8"))["verdict"] == "not_decidable"
    assert (tmp_path / "out" / "report.html").stat().st_size > 1000


def test_of_several_recordings_the_one_that_is_refused_is_named(
    machine: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bad = tmp_path / "second.json"
    bad.write_text('{"channels": 3}', encoding="utf-8")
    assert main(asked(machine, bad, tmp_path / "out")) == 2
    assert "second.json: " in capsys.readouterr().err


def written(folder: Path, name: str, *, seconds: float = 2.0, **further: object) -> Path:
    rate_hz = 20_000
    noise = np.random.default_rng([*name.encode()]).normal(size=round(seconds * rate_hz))
    np.savetxt(folder / f"{name}.csv", noise, header="a")
    channel = {"name": "a", "quantity": "acceleration", "unit": "m/s^2", "location": "bearing1", "axis": "y"}
    operating = {"shaft": "input", "speed_hz": 30.0}
    description = {"sampling_rate_hz": rate_hz, "channels": [channel], "operating": operating, **further}
    path = folder / f"{name}.json"
    path.write_text(json.dumps({k: v for k, v in description.items() if v is not None}), encoding="utf-8")
    return path


def kinematics(folder: Path, **shaft: object) -> Path:
    bearing = {"name": "bearing1", "shaft": "input", "catalogue": "6205"}
    path = folder / "k.json"
    document = {"kinematics": {"shafts": [{"name": "input", **shaft}], "bearings": [bearing]}}
    path.write_text(json.dumps(document), encoding="utf-8")
    return path


@pytest.mark.slow
def test_a_refusal_says_the_file_as_it_was_given_and_once(
    machine: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("runs").mkdir()
    good, out = written(tmp_path, "good"), tmp_path / "out"
    bad = {
        "unit": ({"channels": [{"name": "a", "unit": "furlong"}]}, "channels.0.unit"),
        "shaft": ({"operating": {"shaft": "fan", "speed_hz": 30.0}}, "operating.shaft"),
        "away": ({"channels": [{"name": "a", "unit": "m/s^2", "location": "bearnig1"}]}, "channels.a.location"),
        "rpm": ({"operating": {"shaft": "input", "speed_hz": 1800.0}}, "operating.speed_hz"),
        "other": ({"sampling_rate_hz": 10_000.0}, "sampling_rate_hz"),
    }
    for name, (change, field) in bad.items():
        written(Path("runs"), name, **change)
        given = f"runs/{name}.json"
        for known in (machine, kinematics(tmp_path, speed_hz=30.0)):
            first = [given] if name == "away" else [str(good), given]
            asked_for = ["reconcile", "--machine", str(known), "--recording", *first, "--out", str(out), "--jobs", "1"]
            assert main(asked_for) == 2, name
            said = capsys.readouterr().err
            assert f"error: {given}: {field}" in said, said
            assert said.count(given) == 1, said


def test_a_broken_description_is_named_as_it_was_given(
    machine: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("runs").mkdir()
    Path("runs/a.json").write_text("{", encoding="utf-8")
    for given in ("runs/a.json", "runs/none.json"):
        assert main(asked(machine, Path(given), Path("out"))) == 2
        said = capsys.readouterr().err
        assert said.startswith(f"error: {given}: ") and said.count(given) == 1


def test_what_is_wrong_with_the_machine_says_its_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    written(tmp_path, "t", seconds=0.5)
    kinematics(tmp_path, speed_hz=1797.0)
    assert main(asked(Path("k.json"), Path("t.json"), Path("out"), "--jobs", "1")) == 2
    assert "error: k.json: kinematics.shafts.input.speed_hz: looks like rpm: 1797" in capsys.readouterr().err
    document = json.loads(Path("k.json").read_text(encoding="utf-8"))
    document["kinematics"]["bearings"][0]["shaft"] = "fan"
    Path("k.json").write_text(json.dumps(document), encoding="utf-8")
    assert main(asked(Path("k.json"), Path("t.json"), Path("out"), "--jobs", "1")) == 2
    assert "error: k.json: kinematics.bearings.0.shaft: is no shaft" in capsys.readouterr().err


@pytest.mark.slow
def test_recordings_that_cannot_carry_the_kinematics_are_named_once(tmp_path: Path) -> None:
    """Both levels: no speed is stated, and too few turns."""
    machine = kinematics(tmp_path)
    report = tmp_path / "out" / "report.json"
    for change, field in (({"operating": None}, "operating.speed_hz"), ({"seconds": 0.3}, "samples")):
        given = written(tmp_path, "t", **change)  # type: ignore[arg-type]
        assert main(asked(machine, given, report.parent, "--jobs", "1", "--atlas", str(tmp_path / "atlas"))) == 0
        sentence = json.loads(report.read_text(encoding="utf-8"))["sentence"]
        assert f"{given}: {field}" in sentence
        assert sentence.count(str(given)) == 1 and "test 1" not in sentence


@pytest.mark.slow
def test_at_machine_level_a_recording_that_cannot_be_read_is_named(
    machine: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    slow = written(tmp_path, "b", operating={"shaft": "input", "speed_hz": 20.0})
    given = written(tmp_path, "t")
    code = main([*asked(machine, given, tmp_path / "out", "--jobs", "1"), "--baseline", str(slow)])
    said = capsys.readouterr().err
    assert code == 2 and str(slow) in said and str(given) in said and "no baseline was recorded" in said


def test_what_was_given_in_place_of_a_description_or_a_machine_is_said(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out, good = tmp_path / "out", written(tmp_path, "good")
    known = kinematics(tmp_path, speed_hz=30.0)
    bare = tmp_path / "bare.json"
    bare.write_text(json.dumps(json.loads(known.read_text())["kinematics"]), encoding="utf-8")
    np.savez(tmp_path / "data.npz", a=np.random.default_rng(0).normal(size=9))
    strange = written(tmp_path, "strange")
    (tmp_path / "strange.csv").rename(tmp_path / "strange.xlsx")

    def said(machine: Path, recording: Path) -> str:
        assert main(["reconcile", "--machine", str(machine), "--recording", str(recording), "--out", str(out)]) == 2
        return capsys.readouterr().err

    assert '{"kinematics": {...}}' in said(bare, good)
    assert "holds data: give its description" in said(known, tmp_path / "data.npz")
    (tmp_path / "table.csv").write_text("a,b\n1,2\n", encoding="utf-8")
    told = said(known, tmp_path / "table.csv")
    assert "holds data: give its description (JSON)" in told and "table.json" in told and "strict JSON" not in told
    assert "strange.xlsx" in said(known, strange)


def test_a_refused_comparison_leaves_no_empty_folder_and_touches_none_that_was_there(tmp_path: Path) -> None:
    """It turns with a shaft that the drawing does not have."""
    machine = kinematics(tmp_path)
    recording = written(tmp_path, "r", operating={"shaft": "elsewhere", "speed_hz": 30.0})
    mine = tmp_path / "mine"
    mine.mkdir()
    for out, stays in ((tmp_path / "new", False), (mine, True)):
        assert main(asked(machine, recording, out)) == 2
        assert out.exists() == stays


def test_where_nothing_can_be_written_is_said_before_the_work(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(command, "reconcile_recordings", lambda *_, **__: pytest.fail("worked first"))
    machine = kinematics(tmp_path)
    given = written(tmp_path, "t")
    (tmp_path / "out").write_text("a file")
    assert main(asked(machine, given, tmp_path / "out")) == 2
    assert "--out" in capsys.readouterr().err
    assert main(asked(machine, given, Path("/proc/nothing/here"))) == 2
    assert "--out" in capsys.readouterr().err


@pytest.mark.slow
def test_descriptions_and_machines_may_begin_with_a_byte_order_mark(tmp_path: Path) -> None:
    machine, given = kinematics(tmp_path), written(tmp_path, "t")
    for path in (machine, given):
        path.write_bytes(b"\xef\xbb\xbf" + path.read_bytes())
    assert main(asked(machine, given, tmp_path / "out", "--jobs", "1", "--atlas", str(tmp_path / "atlas"))) == 0


def test_progress_says_how_long_the_atlases_still_take(capsys: pytest.CaptureFixture[str]) -> None:
    now = iter([0.0, 2.0, 60.0, 110.0, 114.0])
    shown = _Shown(clock=lambda: next(now))
    for share in (0.1, 0.11, 0.35, 0.58, 0.6):
        shown(share, "atlas at 30 Hz")
    shown(0.62, "candidates")
    lines = capsys.readouterr().err.splitlines()
    assert lines[0] == " 10% atlas at 30 Hz", "no pace yet"
    assert lines[1].endswith("35% atlas at 30 Hz, all atlases in about 1 min")
    assert lines[2].endswith("58% atlas at 30 Hz, all atlases within a minute")
    assert lines[-1] == " 62% candidates"


@pytest.mark.parametrize("terminal", [True, False])
def test_progress_is_one_line_on_a_terminal_and_a_line_a_stage_or_a_twentieth_elsewhere(
    terminal: bool, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("sys.stderr.isatty", lambda: terminal, raising=False)
    shown = _Shown()
    atlas = [(share, "atlas at 30 Hz") for share in (0.1, 0.12, 0.14, 0.16)]
    for share, stage in [*atlas, (0.6, "candidates"), (1.0, "done")]:
        shown(share, stage)
    told = capsys.readouterr().err
    assert told.count("atlas at 30 Hz") == (4 if terminal else 2)
    assert told.count("\n") == (1 if terminal else 4) and ("\r" in told) is terminal
