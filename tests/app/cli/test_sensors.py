"""`sideband simulate --sensors`: measured channels, the motion before them, and what is refused."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from app.cli.result import FILES

Call = Callable[..., tuple[int, str, str]]
MASS = {"kind": "accelerometer", "name": "acc", "preset": "icp-100mv-g", "place": {"location": "mass"}}
SHORT = ("simulate", "--preset", "oscillator", "--duration", "0.1", "--quiet")


def written(folder: Path, **chain: object) -> Path:
    path = folder / "chain.json"
    path.write_text(json.dumps({"channels": [MASS], **chain}))
    return path


@pytest.mark.slow
def test_measured_channels_and_the_motion_before_them(call: Call, tmp_path: Path) -> None:
    chain, out = written(tmp_path, clock={"sampling_rate_hz": 12_800.0}), tmp_path / "r"
    assert call(*SHORT, "--sensors", chain, "--keep-raw", "--out", out)[0] == 0
    assert {p.name for p in out.iterdir()} == {*FILES, "sensors.json", "raw.npz"}
    with np.load(out / "signals.npz") as signals, np.load(out / "raw.npz") as raw:
        assert set(signals.files) == {"acc", "time_s", "sampling_rate_hz"}
        assert float(signals["sampling_rate_hz"]) == 12_800.0 and signals["acc"].size == 1280
        assert set(raw.files) == {"mass.y.acceleration", "time_s", "sampling_rate_hz"}
        assert float(raw["sampling_rate_hz"]) == 30_000.0
        # What is left of the first instants (the high-pass) aside, the sensor follows the motion.
        at = np.interp(signals["time_s"], raw["time_s"], raw["mass.y.acceleration"])
        assert np.corrcoef(at, signals["acc"])[0, 1] > 0.98
    described = json.loads((out / "sensors.json").read_text())
    assert described["chain"]["channels"][0]["mounting"]["frequency_hz"] == 30_000.0
    summary = json.loads((out / "summary.json").read_text())
    assert summary["channels"][0]["unit"] == "m/s^2" and summary["request"]["sensors"]["channels"][0]["name"] == "acc"


@pytest.mark.slow
def test_the_same_command_gives_the_same_bytes_and_leftovers_go(call: Call, tmp_path: Path) -> None:
    chain = written(tmp_path)
    for name in ("a", "b"):
        assert call(*SHORT, "--sensors", chain, "--keep-raw", "--out", tmp_path / name)[0] == 0
    assert (tmp_path / "a/signals.npz").read_bytes() == (tmp_path / "b/signals.npz").read_bytes()
    assert call(*SHORT, "--force", "--out", tmp_path / "a")[0] == 0
    assert {p.name for p in (tmp_path / "a").iterdir()} == set(FILES)


@pytest.mark.parametrize(
    ("chain", "arguments", "named"),
    [
        ({"channels": []}, (), "--sensors channels: "),
        ({"channels": [{**MASS, "converter": {"bits": 99}}]}, (), "converter.bits"),
        ({"channels": [{**MASS, "preset": "nonesuch"}]}, (), "icp-100mv-g"),
        ({"channels": [{**MASS, "place": {"location": "case"}}]}, (), "--sensors channels.0.place.location"),
        ({"clock": {"sampling_rate_hz": 48_000.0}}, (), "--sensors clock.sampling_rate_hz"),
        ({}, ("--channels", "mass.y.velocity"), "--channels: "),
    ],
)
def test_wrong_chains_are_refused_before_a_folder_is_made(
    call: Call, tmp_path: Path, chain: dict, arguments: tuple[str, ...], named: str
) -> None:
    code, _, error = call(*SHORT, "--sensors", written(tmp_path, **chain), *arguments, "--out", tmp_path / "r")
    assert code == 2 and error.startswith("error: ") and named in error and "Traceback" not in error
    assert not (tmp_path / "r").exists()


def test_missing_file_and_lonely_option(call: Call, tmp_path: Path) -> None:
    code, _, error = call(*SHORT, "--sensors", tmp_path / "none.json", "--out", tmp_path / "r")
    assert code == 2 and "none.json" in error and error.count("\n") == 1
    code, _, error = call(*SHORT, "--keep-raw", "--out", tmp_path / "r")
    assert code == 2 and "--keep-raw" in error and "--sensors" in error
