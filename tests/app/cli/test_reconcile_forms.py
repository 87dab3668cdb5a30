"""`sideband reconcile`: a machine file of no form, or that cannot be assembled, is refused with file and field."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from app.cli.main import main
from sim.presets import preset


@pytest.fixture
def machine(tmp_path: Path) -> Path:
    path = tmp_path / "machine.json"
    path.write_text(preset("paper-lightly-damped").model_dump_json(), encoding="utf-8")
    return path


def asked(machine: Path, recording: Path, out: Path) -> list[str]:
    return ["reconcile", "--machine", str(machine), "--recording", str(recording), "--out", str(out)]


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("{}", "m.json: is empty (given '{}'); allowed: a machine, "),
        ('{"kinematic": {}}', "m.json: kinematic: is not a known field (did you mean kinematics?)"),
        ('{"paramters": {}}', "m.json: paramters: is not a known field (did you mean parameters?)"),
    ],
)
def test_an_object_of_no_form_is_told_the_forms(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], text: str, told: str
) -> None:
    path = tmp_path / "m.json"
    path.write_text(text, encoding="utf-8")
    assert main(asked(path, tmp_path / "none.json", tmp_path / "out")) == 2
    assert told in capsys.readouterr().err


@pytest.mark.parametrize(
    ("term", "told"),
    [
        ({"term": "outer_spal", "site": "bearing1"}, "m.json: terms.0.term: unknown term (did you mean outer_spall?)"),
        ({"term": "outer_spall", "site": "pinion"}, "m.json: terms.0.site"),
        ({"term": "outer_spall", "site": "bearing1", "parameters": {"wide": 1e-3}}, "m.json: terms.0.parameters.wide"),
    ],
)
def test_a_machine_that_cannot_be_assembled_is_refused_before_anything_is_read(
    machine: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], term: dict[str, object], told: str
) -> None:
    path = tmp_path / "m.json"
    path.write_text(json.dumps(json.loads(machine.read_text(encoding="utf-8")) | {"terms": [term]}), encoding="utf-8")
    assert main(asked(path, tmp_path / "none.json", tmp_path / "out")) == 2
    assert told in capsys.readouterr().err
