"""`sideband simulate`: the three files of a result, and what is refused before anything is computed."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from app.cli.result import FILES, FURTHER

Call = Callable[..., tuple[int, str, str]]
Process = Callable[..., subprocess.CompletedProcess[str]]


def test_a_result_folder(sideband: Process, tmp_path: Path) -> None:
    out = tmp_path / "result"
    done = sideband(
        "simulate", "--preset", "paper", "--set", "fit_clearance@bearing1.gap=2e-5", "--duration", 0.6, "--out", out
    )
    assert done.returncode == 0, done.stderr
    assert "Traceback" not in done.stderr
    assert {path.name for path in out.iterdir()} == set(FILES)
    labels = json.loads((out / "labels.json").read_text())
    assert labels["frequencies"]["f_o1"] == pytest.approx(77.2065)
    assert labels["frequencies"]["f_m"] == pytest.approx(690.0)
    keys = {"label", "frequency_hz", "order", "amplitude", "unit", "status", "components"}
    assert all(keys <= set(peak) for peak in labels["peaks"])
    mesh = next(p for p in labels["peaks"] if p["label"] == "1*f_m")
    assert mesh["status"] == "present"
    assert mesh["unit"] == "m/s^2"
    assert mesh["order"] == pytest.approx(23.0)
    with np.load(out / "signals.npz") as signals:
        assert signals["resonator1.y.acceleration"].shape == signals["time_s"].shape == (18000,)
        assert float(signals["sampling_rate_hz"]) == 30000.0
    summary = json.loads((out / "summary.json").read_text())
    assert summary["request"]["set"] == ["fit_clearance@bearing1.gap=2e-5"]
    assert summary["quality"]["energy"]["acceptable"] is True
    machine = json.loads((out / "machine.json").read_text())
    assert machine["terms"] == [{"term": "fit_clearance", "site": "bearing1", "parameters": {"gap": 2e-5}}]


@pytest.mark.slow
def test_causes_and_impacts_on_request(sideband: Process, tmp_path: Path) -> None:
    out = tmp_path / "result"
    change = ("--set", "eccentricity@pinion.radius=2e-5", "--duration", 0.6, "--channels", "resonator1.y.acceleration")
    done = sideband("simulate", "--preset", "paper-lightly-damped", *change, "--causes", "--out", out)
    assert done.returncode == 0, done.stderr
    assert "causes: 7 further runs" in done.stderr and "100 % eccentricity@pinion" in done.stdout
    assert {path.name for path in out.iterdir()} == {*FILES, *FURTHER}
    labels = json.loads((out / "labels.json").read_text())
    assert labels["cause_cost"]["runs"] == 7 and labels["cause_cost"]["steps"] > 7 * 36_000
    sideband_line = next(p for p in labels["peaks"] if p["label"] == "1*f_m+1*f_r1")
    assert sideband_line["causes"][0]["term"] == "eccentricity" and sideband_line["causes"][0]["share"] > 0.9
    impacts = json.loads((out / "impacts.json").read_text())
    assert [c["contact"] for c in impacts["contacts"]] == ["mesh1"]
    with np.load(out / "signals.npz") as signals:
        assert "mesh1.contact" not in signals, "only what was asked for is kept"


def test_the_written_machine_gives_the_same_signals(call: Call, tmp_path: Path) -> None:
    common = ("--duration", "0.05", "--quiet", "--channels", "pinion.y.displacement,mesh1.force")
    assert call("simulate", "--preset", "gear-pair", "--duration", "0.05", "--quiet", "--out", tmp_path / "x")[0] == 0
    assert call("simulate", "--preset", "paper-demo", *common, "--out", tmp_path / "a")[0] == 0
    assert call("simulate", "--machine", tmp_path / "a" / "machine.json", *common, "--out", tmp_path / "b")[0] == 0
    with np.load(tmp_path / "a" / "signals.npz") as a, np.load(tmp_path / "b" / "signals.npz") as b:
        assert set(a.files) == {"pinion.y.displacement", "mesh1.force", "time_s", "sampling_rate_hz"}
        np.testing.assert_array_equal(a["mesh1.force"], b["mesh1.force"])


def test_nothing_is_overwritten_without_force(call: Call, tmp_path: Path) -> None:
    common = ("simulate", "--preset", "oscillator", "--duration", "0.05", "--quiet", "--out", tmp_path)
    (tmp_path / "summary.json").write_text("mine")
    code, _, error = call(*common)
    assert code == 2
    assert "--force" in error
    assert (tmp_path / "summary.json").read_text() == "mine"
    assert not (tmp_path / "signals.npz").exists()
    assert call(*common, "--force")[0] == 0
    assert json.loads((tmp_path / "summary.json").read_text())["machine"] == "oscillator"


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (("--duration", "-1"), "duration_s"),
        (("--duration", "nan"), "duration_s"),
        (("--duration", "1e9"), "duration_s"),
        (("--rate", "500"), "sampling_rate_hz"),
        (("--seed", "-1"), "seed"),
        (("--channels", "resonator1.y.accelerations"), "resonator1.y.acceleration "),
        (("--channels", "all", "mesh1.force"), "all"),
        (("--preset", "paperr"), "paper-demo"),
        (("--set", "fit_clearance@bearing1.gap=20"), "gap"),
        (("--set", "no_such@bearing1.gap=1"), "no_such"),
        (("--set", "fit_clearance@bearing9.gap=1e-5"), "bearing9"),
        (("--set", "nonsense"), "KEY=VALUE"),
    ],
)
def test_wrong_requests_are_refused_before_a_folder_is_made(
    call: Call, tmp_path: Path, arguments: tuple[str, ...], named: str
) -> None:
    out = tmp_path / "result"
    code, _, error = call("simulate", *arguments, "--out", out)
    assert code == 2
    assert error.startswith("error: ")
    assert named in error.replace(",", " ")
    assert not out.exists()
