"""`sideband reconcile`: wrong input ends with exit code 2 and says what is wrong; a report is two files."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from app.cli import reconcile as command
from app.cli.main import main
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
    assert told.out.startswith("nothing_missing: ")
    assert json.loads((tmp_path / "out" / "report.json").read_text(encoding="utf-8"))["verdict"] == "nothing_missing"
    assert (tmp_path / "out" / "report.html").stat().st_size > 1000


def test_of_several_recordings_the_one_that_is_refused_is_named(
    machine: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bad = tmp_path / "second.json"
    bad.write_text('{"channels": 3}', encoding="utf-8")
    assert main(asked(machine, bad, tmp_path / "out")) == 2
    assert "second.json: " in capsys.readouterr().err
