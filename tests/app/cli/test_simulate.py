"""`sideband simulate`: the three files of a result, and what is refused before anything is computed."""

from __future__ import annotations

import argparse
import json
import shlex
import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from app.cli.result import FILES, FURTHER
from app.cli.simulate import configure, repeating
from jobs.physics import PhysicsEngine
from jobs.request import DEFAULT_RATE_HZ, SimulationRequest

Call = Callable[..., tuple[int, str, str]]
Process = Callable[..., subprocess.CompletedProcess[str]]


@pytest.mark.slow
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
    assert "causes: 10 further runs" in done.stderr and "100 % eccentricity@pinion" in done.stdout
    assert {path.name for path in out.iterdir()} == {*FILES, *FURTHER}
    labels = json.loads((out / "labels.json").read_text())
    assert labels["cause_cost"]["runs"] == 10 and labels["cause_cost"]["steps"] > 10 * 36_000
    sideband_line = next(p for p in labels["peaks"] if p["label"] == "1*f_m+1*f_r1")
    assert sideband_line["causes"][0]["term"] == "eccentricity" and sideband_line["causes"][0]["share"] > 0.9
    impacts = json.loads((out / "impacts.json").read_text())
    assert [c["contact"] for c in impacts["contacts"]] == ["mesh1"]
    with np.load(out / "signals.npz") as signals:
        assert "mesh1.contact" not in signals, "only what was asked for is kept"


@pytest.mark.slow
def test_the_written_machine_gives_the_same_signals(call: Call, tmp_path: Path) -> None:
    common = ("--duration", "0.05", "--quiet", "--channels", "pinion.y.displacement,mesh1.force")
    assert call("simulate", "--preset", "gear-pair", "--duration", "0.05", "--quiet", "--out", tmp_path / "x")[0] == 0
    assert call("simulate", "--preset", "paper-demo", *common, "--out", tmp_path / "a")[0] == 0
    assert call("simulate", "--machine", tmp_path / "a" / "machine.json", *common, "--out", tmp_path / "b")[0] == 0
    with np.load(tmp_path / "a" / "signals.npz") as a, np.load(tmp_path / "b" / "signals.npz") as b:
        assert set(a.files) == {"pinion.y.displacement", "mesh1.force", "time_s", "sampling_rate_hz"}
        np.testing.assert_array_equal(a["mesh1.force"], b["mesh1.force"])


@pytest.mark.slow
def test_the_command_told_at_the_end_repeats_everything(call: Call, tmp_path: Path) -> None:
    """Duration, rate, seed, channels, transient, sensors: the machine's file alone does not have them."""
    chain = {"channels": [{"kind": "accelerometer", "name": "acc", "preset": "icp-magnet"}]}
    chain["channels"][0]["place"] = {"location": "mass", "direction_deg": 90}  # type: ignore[assignment]
    (tmp_path / "my chain.json").write_text(json.dumps(chain))
    own = ("--duration", "0.07", "--rate", "25000", "--seed", "5", "--keep-transient")
    own += ("--sensors", tmp_path / "my chain.json", "--keep-raw", "--set", "bodies.mass.mass_kg=2")
    code, _, error = call("simulate", "--preset", "oscillator", *own, "--out", tmp_path / "a b")
    assert code == 0, error
    (line,) = (line for line in error.splitlines() if line.startswith("repeat with: "))
    program, *words = shlex.split(line.removeprefix("repeat with: "))
    assert program == "sideband"
    assert json.loads((tmp_path / "a b" / "summary.json").read_text())["request"]["repeat"] in line
    assert call(*words, "--quiet")[0] == 0
    for name in ("signals.npz", "raw.npz"):
        with np.load(tmp_path / "a b" / name) as one, np.load(tmp_path / "a b-again" / name) as other:
            assert one.files == other.files
            for key in one.files:
                np.testing.assert_array_equal(one[key], other[key])


def test_channels_and_causes_are_in_the_command(tmp_path: Path) -> None:
    parser = argparse.ArgumentParser()
    configure(parser)
    given = ["--channels", "pinion.y.displacement,mesh1.force", "gear.y.displacement", "--causes", "--duration", "0.1"]
    request = SimulationRequest(preset="paper", causes=True, duration_s=0.1)
    words = shlex.split(repeating(parser.parse_args(given), request, tmp_path))
    assert words[words.index("--channels") + 1] == "pinion.y.displacement,mesh1.force,gear.y.displacement"
    assert "--causes" in words and words[words.index("--duration") + 1] == "0.1"


def test_all_wrong_options_are_told_together(call: Call, tmp_path: Path) -> None:
    wrong = ("--duration", "-1", "--seed", "-1", "--set", "gears.pinion.teeth=3", "--set", "gears.pinon.teeth=30")
    code, _, error = call("simulate", *wrong, "--out", tmp_path / "r")
    named = ("--duration", "--seed", "--set gears.pinion.teeth", "--set gears.pinon.teeth")
    assert code == 2 and error.count("\n") == 4
    assert all(f"error: {name}: " in error for name in named)


def test_nothing_is_overwritten_without_force(call: Call, tmp_path: Path) -> None:
    common = ("simulate", "--preset", "oscillator", "--duration", "0.05", "--quiet", "--out", tmp_path)
    (tmp_path / "summary.json").write_text("mine")
    code, _, error = call(*common)
    assert code == 2
    assert "--force" in error and "summary.json" in error and error.count("\n") == 1
    assert (tmp_path / "summary.json").read_text() == "mine"
    assert not (tmp_path / "signals.npz").exists()
    assert call(*common, "--force")[0] == 0
    assert json.loads((tmp_path / "summary.json").read_text())["machine"] == "oscillator"


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (("--duration", "-1"), "--duration: "),
        (("--duration", "nan"), "--duration: "),
        (("--duration", "1e9"), "--duration: "),
        (("--duration", "1e-4"), ">= 0.0021333"),
        (("--rate", "500"), "--rate: "),
        (("--seed", "-1"), "--seed: "),
        (("--channels", "resonator1.y.accelerations"), "resonator1.y.acceleration "),
        (("--channels", "all", "mesh1.force"), "all"),
        (("--preset", "paperr"), "paper-demo"),
        (("--set", "fit_clearance@bearing1.gap=20"), "--set fit_clearance@bearing1.gap: "),
        (("--set", "fit_clearance@bearing1.gape=2e-5"), "did you mean gap?"),
        (("--set", "fit_clearence@bearing1.gap=1"), "did you mean fit_clearance?"),
        (("--set", "fit_clearance@bearing9.gap=1e-5"), "bearing9"),
        (("--set", "bearings.bearing2.radial_clearance_m=5"), "--set bearings.bearing2.radial_clearance_m: "),
        (("--set", "gears.pinion.teeth=3"), "--set gears.pinion.teeth: "),
        (("--set", "teeth=20"), "did you mean gears.pinion.teeth"),
        (("--set", "speed=20"), "did you mean speed_hz?"),
        (("--set", "rpm=1800"), "speed_hz=30"),
        (("--set", "speed_hz=1800"), "1800 rpm are 30 Hz"),
        (("--set", "torq=3"), "did you mean torque?"),
        (("--set", "nonsense"), "KEY=VALUE"),
        (("--set", f"gears.pinion.teeth={'9' * 5000}"), "--set gears.pinion.teeth: "),
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


SHORT = ("simulate", "--preset", "oscillator", "--duration", "0.05")


@pytest.mark.slow
def test_the_folder_is_named_after_the_machine_unless_it_is_given(
    call: Call, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert call(*SHORT)[0] == 0
    assert {path.name for path in (tmp_path / "result-oscillator").iterdir()} == set(FILES)
    assert call(*SHORT)[0] == 2
    assert call("simulate", "--machine", "result-oscillator/machine.json", "--duration", "0.05")[0] == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == ["result-machine", "result-oscillator"]


def test_both_ways_in_have_one_default_rate(call: Call, tmp_path: Path) -> None:
    assert call(*SHORT, "--out", tmp_path / "r")[0] == 0
    summary = json.loads((tmp_path / "r" / "summary.json").read_text())
    assert summary["sampling_rate_hz"] == SimulationRequest(preset="oscillator").sampling_rate_hz == DEFAULT_RATE_HZ


@pytest.mark.parametrize("where", ["simulating", "writing"])
def test_an_interrupt_leaves_nothing_behind(
    call: Call, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, where: str
) -> None:
    def interrupted(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    if where == "simulating":
        monkeypatch.setattr(PhysicsEngine, "simulate", interrupted)
    else:
        monkeypatch.setattr(np, "savez", interrupted)
    code, _, error = call(*SHORT, "--out", tmp_path / "new" / "deep")
    assert code == 130
    assert "interrupted" in error and "Traceback" not in error
    assert not list(tmp_path.iterdir())


def test_a_full_disk_is_one_line_and_leaves_nothing(
    call: Call, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object, **__: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(np, "savez", full)
    code, _, error = call(*SHORT, "--quiet", "--out", tmp_path / "new")
    assert code == 2
    assert error.endswith("signals.npz: no space left on device\n") and error.count("\n") == 1
    assert not list(tmp_path.iterdir())


def test_places_that_cannot_be_written_are_refused_in_one_line(call: Call, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("mine")
    for out in (tmp_path / "file", tmp_path / "file" / "below", Path("/proc/1/result")):
        code, _, error = call(*SHORT, "--out", out)
        assert code == 2
        assert error.startswith("error: --out: ") and error.count("\n") == 1 and "Errno" not in error


def test_no_bar_is_drawn_where_nobody_watches(call: Call, tmp_path: Path) -> None:
    code, _, error = call(*SHORT, "--out", tmp_path / "r")
    assert code == 0
    assert "\r" not in error and "%" not in error


def test_a_machine_without_lines_says_why(call: Call, tmp_path: Path) -> None:
    code, _, error = call(*SHORT, "--out", tmp_path / "r")
    labels = json.loads((tmp_path / "r" / "labels.json").read_text())
    assert code == 0 and labels["peaks"] == [] and "nothing turns" in labels["reason"]
    assert "no labels: nothing turns" in error


@pytest.mark.slow
def test_a_machine_of_angles_only_is_labelled_by_them(call: Call, tmp_path: Path) -> None:
    assert call("simulate", "--preset", "gear-pair", "--duration", "0.5", "--quiet", "--out", tmp_path / "r")[0] == 0
    labels = json.loads((tmp_path / "r" / "labels.json").read_text())
    mesh = next(p for p in labels["peaks"] if p["label"] == "1*f_m")
    assert (mesh["status"], mesh["unit"]) == ("present", "rad/s^2")
    assert "reason" not in labels
