"""`sideband verify` on the reference solutions, on other grids, and on broken files."""

from __future__ import annotations

import json
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from app.cli.reference_case import RESONATORS, RING_1
from app.cli.reference_run import CHANNELS, at_instants
from sim.presets.reference import machine_from_reference

Call = Callable[..., tuple[int, str, str]]
Process = Callable[..., subprocess.CompletedProcess[str]]
HEALTHY = "lightly_damped_healthy"


def _copy(reference: Path, folder: Path, name: str, as_name: str | None = None) -> Path:
    for ending in (".json", ".npz"):
        shutil.copyfile(reference / f"{name}{ending}", folder / f"{as_name or name}{ending}")
    return folder / f"{as_name or name}.json"


def _arrays(path: Path) -> dict[str, np.ndarray]:
    with np.load(path.with_suffix(".npz")) as stored:
        return dict(stored)


@pytest.mark.slow
def test_every_reference_solution_is_met(sideband: Process, reference: Path) -> None:
    done = sideband("verify", reference)
    assert done.returncode == 0, done.stdout + done.stderr
    lines = [line.split() for line in done.stdout.splitlines()]
    assert [line[0] for line in lines] == sorted(path.stem for path in reference.glob("*.json"))
    assert all(0 < float(line[1]) <= 1e-3 for line in lines)
    assert all(line[-1] == "ok" for line in lines)
    assert "Traceback" not in done.stderr


@pytest.mark.slow
def test_a_tolerance_that_cannot_be_met_fails(call: Call, reference: Path, tmp_path: Path) -> None:
    _copy(reference, tmp_path, HEALTHY)
    code, out, _ = call("verify", tmp_path, "--tolerance", "1e-12", "--json")
    found = json.loads(out)
    assert code == 1
    assert found["passed"] is False
    assert 1e-12 < found["files"][0]["error"] < 1e-3


@pytest.mark.slow
def test_a_wrong_parameter_is_found(call: Call, reference: Path, tmp_path: Path) -> None:
    path = _copy(reference, tmp_path, HEALTHY)
    parameters = json.loads(path.read_text())
    path.write_text(json.dumps(parameters | {"kp": parameters["kp"] * 1.02}))
    assert call("verify", tmp_path)[0] == 1


@pytest.mark.slow
def test_torques_are_those_of_the_reference_equations(call: Call, reference: Path, tmp_path: Path) -> None:
    """Tout repeats T Rb_ge / Rb_pin: another T is another machine, another Tout is a warning."""
    path = _copy(reference, tmp_path, HEALTHY)
    parameters = json.loads(path.read_text())
    path.write_text(json.dumps(parameters | {"Tout": 0.5 * parameters["Tout"], "gravity": 9.81}))
    code, out, error = call("verify", tmp_path, "--json")
    assert code == 0, out + error
    assert "warning: lightly_damped_healthy: Tout = " in error and "gravity is in the file but not in" in error
    assert len(json.loads(out)["files"][0]["warnings"]) == 2
    path.write_text(json.dumps(parameters | {"T": 2.0 * parameters["T"]}))
    code, out, error = call("verify", tmp_path, "--json")
    assert code == 1 and json.loads(out)["files"][0]["error"] > 0.1, "the solution is that of half this torque"
    assert "is not T Rb_ge / Rb_pin" in error and "error" not in error


@pytest.mark.slow
def test_other_names_in_the_file_are_the_same_machine(call: Call, reference: Path, tmp_path: Path) -> None:
    """The wrapped form, and without the values that follow from the others."""
    path = _copy(reference, tmp_path, HEALTHY)
    parameters = json.loads(path.read_text())
    for key in ("ct", "fm", "fr2", "Rb_pin", "Rb_ge", "a0", "Tout"):
        del parameters[key]
    path.write_text(json.dumps({"parameters": parameters, "tolerance": 0.1}))
    code, out, error = call("verify", tmp_path, "--json")
    assert code == 0, out + error


@pytest.mark.slow
@pytest.mark.parametrize("keep", [slice(None, None, 3), slice(0, 3000), slice(1500, None, 2)])
def test_other_rates_and_durations(call: Call, reference: Path, tmp_path: Path, keep: slice) -> None:
    path = _copy(reference, tmp_path, HEALTHY)
    arrays = _arrays(path)
    cut = {k: arrays[k][keep] if k in ("t", "q", "a") else arrays[k] for k in arrays}
    np.savez(path.with_suffix(".npz"), **cut)
    code, out, error = call("verify", tmp_path)
    assert code == 0, out + error


def test_instants_off_any_grid_are_interpolated(reference: Path) -> None:
    arrays = _arrays(reference / f"{HEALTHY}.json")
    parameters = json.loads((reference / f"{HEALTHY}.json").read_text())
    machine = machine_from_reference(parameters, arrays["mesh_table"], arrays["centre_distance_error"])
    places = np.unique(np.random.default_rng(3).integers(0, 1500, 300))
    t = arrays["t"][places] + 1e-9 * np.sqrt(places)  # no longer on a grid
    on_grid = at_instants(machine, arrays["t"][:1500], 240e3)
    off_grid = at_instants(machine, t * (1 + 1e-7) + 1e-6, 240e3)
    assert on_grid.shape == (len(CHANNELS), 1500)
    expected = on_grid[:4, places]
    # One microsecond later a 700 Hz motion has moved by 0.4 % of its amplitude, its impacts by a little more.
    assert np.linalg.norm(off_grid[:4] - expected) < 0.03 * np.linalg.norm(expected)


def test_ring_and_resonator_columns(reference: Path) -> None:
    arrays = _arrays(reference / "rattle_light_torque.json")
    parameters = json.loads((reference / "rattle_light_torque.json").read_text())
    machine = machine_from_reference(parameters, arrays["mesh_table"], arrays["centre_distance_error"])
    found = at_instants(machine, arrays["t"][:300], 240e3)
    np.testing.assert_allclose(found[:4].T, arrays["a"][:300][:, RESONATORS], atol=2e-3 * np.abs(found[:4]).max())
    np.testing.assert_allclose(found[4:].T, arrays["q"][:300][:, RING_1], atol=1e-3 * np.abs(found[4:]).max())


@pytest.mark.slow
@pytest.mark.parametrize("damage", ["json", "npz", "no_npz", "no_a", "shape", "nan", "unknown", "no_grid"])
def test_a_broken_file_is_named_and_the_others_go_on(call: Call, reference: Path, tmp_path: Path, damage: str) -> None:
    path = _copy(reference, tmp_path, HEALTHY, "a_broken")
    _copy(reference, tmp_path, HEALTHY, "z_good")
    arrays = _arrays(path)
    npz = path.with_suffix(".npz")
    match damage:
        case "json":
            path.write_text("{")
        case "npz":
            npz.write_bytes(b"PK\x03\x04 not really")
        case "no_npz":
            npz.unlink()
        case "no_a":
            np.savez(npz, **{k: v for k, v in arrays.items() if k != "a"})
        case "shape":
            np.savez(npz, **(arrays | {"a": arrays["a"][:, :5]}))
        case "nan":
            np.savez(npz, **(arrays | {"a": arrays["a"] * np.nan}))
        case "unknown":
            path.write_text(json.dumps(json.loads(path.read_text()) | {"stiffnes": 3.0}))
        case "no_grid":
            np.savez(npz, **{k: v for k, v in arrays.items() if k != "centre_distance_error"})
    code, out, error = call("verify", tmp_path)
    assert code == 2
    assert "error: a_broken" in error
    assert "Traceback" not in error
    assert "a_broken unusable" in out
    assert out.splitlines()[-1].startswith("z_good") and out.splitlines()[-1].endswith("ok")


def test_an_empty_folder_is_no_success(call: Call, tmp_path: Path) -> None:
    code, _, error = call("verify", tmp_path)
    assert code == 2
    assert str(tmp_path) in error
