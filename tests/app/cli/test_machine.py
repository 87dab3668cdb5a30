"""`sideband machine`: parameter files in, specifications and reports out."""

from __future__ import annotations

import json
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from sim.core.spec import MachineSpec
from sim.presets import preset

Call = Callable[..., tuple[int, str, str]]
Process = Callable[..., subprocess.CompletedProcess[str]]


@pytest.mark.slow
def test_a_reference_becomes_a_machine_that_can_be_checked(
    sideband: Process, call: Call, reference: Path, tmp_path: Path
) -> None:
    out = tmp_path / "machine.json"
    done = sideband("machine", "--from-reference", reference / "tabled_clearance_20um.json", "--out", out, "--json")
    assert done.returncode == 0, done.stderr
    report = json.loads(done.stdout)
    assert report["from_parameters"]["mesh_table"].startswith("given: 9 x 400")
    assert report["frequencies"]["f_m"] == 690.0
    assert report["frequencies"]["f_r2"] == pytest.approx(8.5185, abs=1e-4)
    assert report["frequencies"]["f_o1"] == pytest.approx(77.21, abs=0.01)
    machine = MachineSpec.model_validate_json(out.read_text())
    assert machine.terms[0].parameters["gap"] == 2e-5
    code, text, _ = call("machine", "--check", out)
    assert code == 0
    assert "f_o1" in text
    assert "natural frequencies" in text


def test_what_is_missing_is_derived_and_reported(call: Call, reference: Path, tmp_path: Path) -> None:
    parameters = json.loads((reference / "lightly_damped_healthy.json").read_text())
    for key in ("ct", "fm", "fr2"):
        del parameters[key]
    path = tmp_path / "p.json"
    path.write_text(json.dumps({"parameters": parameters}))
    code, out, _ = call("machine", "--from-reference", path, "--json")
    said = json.loads(out)["from_parameters"]
    assert code == 0
    assert all(said[key].startswith("derived") for key in ("ct", "fm", "fr2", "mesh_table"))


def test_errors_name_every_wrong_key(call: Call, reference: Path, tmp_path: Path) -> None:
    parameters = json.loads((reference / "lightly_damped_healthy.json").read_text())
    parameters["stiffnes"] = 1.0
    parameters["fr1"] = "fast"
    del parameters["mg"]
    path = tmp_path / "p.json"
    path.write_text(json.dumps(parameters))
    code, _, error = call("machine", "--from-reference", path, "--out", tmp_path / "m.json")
    assert code == 2
    assert all(f"parameters.{key}" in error for key in ("stiffnes", "fr1", "mg"))
    assert not (tmp_path / "m.json").exists()


def test_an_unknown_section_is_named(call: Call, tmp_path: Path) -> None:
    path = tmp_path / "p.json"
    path.write_text('{"parameters": {}, "bearing": []}')
    code, _, error = call("machine", "--from-reference", path)
    assert code == 2
    assert "bearing:" in error
    assert "bearings" in error


def test_the_parameter_file_is_not_overwritten(call: Call, reference: Path, tmp_path: Path) -> None:
    path = tmp_path / "p.json"
    shutil.copyfile(reference / "lightly_damped_healthy.json", path)
    before = path.read_text()
    assert call("machine", "--from-reference", path, "--out", path)[0] == 2
    assert path.read_text() == before


def test_a_preset_is_explained_and_can_be_written(call: Call, tmp_path: Path) -> None:
    out = tmp_path / "m.json"
    code, text, _ = call("machine", "--preset", "paper", "--set", "speed_hz=20", "--out", out)
    assert code == 0
    assert "defect orders" in text
    written = MachineSpec.model_validate_json(out.read_text())
    assert written.operating is not None
    assert written.operating.speed_hz == 20
    assert written.bearings == preset("paper").bearings


def test_an_impossible_machine_is_refused_with_the_field(call: Call, tmp_path: Path) -> None:
    path = tmp_path / "m.json"
    document = preset("paper").model_dump(mode="json")
    document["bearings"][0]["body"] = "nowhere"
    path.write_text(json.dumps(document))
    code, _, error = call("machine", "--check", path)
    assert code == 2
    assert "bearings.bearing1.body" in error
