"""`sideband analyse`: indicators of a result folder and of recordings, or one line that says what is missing."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from scipy.io import savemat, wavfile

Call = Callable[..., tuple[int, str, str]]
RATE, SPEED_HZ, TEETH = 12_800, 25.0, 23


def vibration(seconds: float = 4.0) -> np.ndarray:
    t = np.arange(int(RATE * seconds)) / RATE
    phase = 2 * np.pi * SPEED_HZ * t
    x = np.cos(TEETH * phase) * (1 + 0.2 * np.cos(phase)) + 0.4 * np.cos(2 * TEETH * phase)
    return x + 0.1 * np.random.default_rng(0).standard_normal(t.size)


@pytest.fixture
def recording(tmp_path: Path) -> Path:
    """An npz with a pulse channel, described beside."""
    t = np.arange(4 * RATE) / RATE
    np.savez(tmp_path / "gearbox.npz", a=vibration(), pulse=(np.mod(SPEED_HZ * t, 1.0) < 0.1).astype(float))
    about = {
        "sampling_rate_hz": RATE,
        "channels": [{"name": "casing", "column": "a", "quantity": "acceleration", "unit": "m/s^2"}],
        "operating": {"shaft": "input", "speed_hz": SPEED_HZ},
        "tacho": {"shaft": "input", "column": "pulse", "pulses_per_revolution": 1},
    }
    (tmp_path / "gearbox.json").write_text(json.dumps(about))
    return tmp_path / "gearbox.npz"


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory) -> Path:
    from app.cli.main import main  # noqa: PLC0415 - one run for the module

    out = tmp_path_factory.mktemp("analyse") / "demo"
    assert main(["simulate", "--preset", "paper-demo", "--duration", "0.5", "--out", str(out), "--quiet"]) == 0
    return out


@pytest.mark.slow
def test_a_result_knows_its_shafts_and_gears(call: Call, result: Path) -> None:
    code, out, _ = call("analyse", result)
    document = json.loads(out)
    assert code == 0 and document["kind"] == "gear" and document["rotation"] == "specified speed"
    assert {s["shaft"]: s["teeth"] for s in document["shafts"]} == {"f_r1": [23], "f_r2": [81]}
    assert all(s["fm0"] > 0 and s["runs"] == 1 for s in document["shafts"])
    several = json.loads(call("analyse", result, "--indicator", "kurtogram", "--indicator", "cepstrum")[1])
    assert [d["kind"] for d in several] == ["kurtogram", "cepstrum"]
    # the clearance at bearing 1 modulates with the ball pass: the demo's fault
    cyclic = json.loads(call("analyse", result, "--indicator", "cyclic")[1])
    assert next(line for line in cyclic["lines"] if line["label"] == "1*f_o1")["above"]
    turn = json.loads(call("analyse", result, "--indicator", "average", "--shaft", "input", "--tacholess")[1])
    assert turn["shaft"] == "f_r1" and "phase of orders 23, 46 of f_r1" in turn["rotation"]
    assert turn["mean_speed_hz"] == pytest.approx(30.0, rel=1e-3)
    again = json.loads(call("analyse", result, "--earlier", result)[1])
    assert again["shafts"][0]["runs"] == 2


@pytest.mark.slow
def test_options_that_a_result_answers_itself_are_refused(call: Call, result: Path) -> None:
    for options in (["--rate", 1000], ["--teeth", 23]):
        code, out, err = call("analyse", result, *options)
        assert code == 2 and not out and options[0] in str(err)
    code, _, err = call("analyse", result, "--channel", "nothing")
    assert code == 2 and "resonator1.y.acceleration" in err


@pytest.mark.slow
def test_a_described_recording_uses_its_tacho(call: Call, recording: Path) -> None:
    code, out, err = call("analyse", recording, "--teeth", TEETH)
    assert code == 0, err
    document = json.loads(out)
    assert document["rotation"] == "tacho" and document["channel"] == "casing" and document["unit"] == "m/s^2"
    (shaft,) = document["shafts"]
    assert shaft["component"] == "input" and shaft["revolutions"] >= 97
    assert shaft["fm4"] == pytest.approx(3, abs=0.6), "the difference signal is noise"
    by_phase = json.loads(call("analyse", recording, "--teeth", TEETH, "--tacholess")[1])
    assert "phase of orders 23, 46" in by_phase["rotation"]
    assert by_phase["shafts"][0]["fm0"] == pytest.approx(shaft["fm0"], rel=0.05)


@pytest.mark.parametrize("suffix", [".npz", ".mat", ".wav", ".csv"])
def test_every_format_gives_the_same(call: Call, tmp_path: Path, suffix: str) -> None:
    path, x = tmp_path / f"a{suffix}", vibration(2.0)
    if suffix == ".npz":
        np.savez(path, channel=x)
    elif suffix == ".mat":
        savemat(path, {"channel": x})
    elif suffix == ".wav":
        wavfile.write(path, RATE, x.astype(np.float32))
    else:
        path.write_text("channel\n" + "\n".join(f"{v:.9g}" for v in x) + "\n")
    code, out, err = call("analyse", path, "--rate", RATE, "--unit", "g", "--speed", SPEED_HZ, "--teeth", TEETH)
    assert code == 0, err
    (shaft,) = json.loads(out)["shafts"]
    np.savez(tmp_path / "plain.npz", channel=x)
    other = call(
        "analyse", tmp_path / "plain.npz", "--rate", RATE, "--unit", "g", "--speed", SPEED_HZ, "--teeth", TEETH
    )
    assert shaft["fm0"] == pytest.approx(json.loads(other[1])["shafts"][0]["fm0"], rel=1e-5)


def test_what_is_missing_is_said_in_one_line(call: Call, tmp_path: Path, recording: Path) -> None:
    np.savez(tmp_path / "bare.npz", x=vibration(1.0))
    (tmp_path / "broken.npz").write_bytes(b"no archive")
    (tmp_path / "two.csv").write_text("a,b\n1,2,3\n")
    cases: list[tuple[list[object], str]] = [
        ([tmp_path / "nowhere.npz"], "does not exist"),
        ([tmp_path], "is no result folder"),
        ([tmp_path / "bare.npz"], "--rate"),
        ([tmp_path / "bare.npz", "--rate", 1000], "--unit"),
        ([tmp_path / "bare.npz", "--rate", -1, "--unit", "g"], "--rate"),
        ([tmp_path / "bare.npz", "--rate", 1000, "--unit", "g"], "speed"),
        ([tmp_path / "bare.npz", "--rate", 1000, "--unit", "g", "--speed", 0], "speed_hz"),
        ([recording], "teeth"),
        ([recording, "--teeth", 9000], "teeth"),
        ([recording, "--indicator", "cyclic", "--max-alpha", 1e9], "max_alpha_hz"),
        ([tmp_path / "broken.npz", "--rate", 1000, "--unit", "g"], "cannot be read"),
        ([tmp_path / "two.csv", "--rate", 1000, "--unit", "g"], "cannot be read"),
        ([tmp_path / "gearbox.json"], "is no recording"),
    ]
    for arguments, told in cases:
        code, out, err = call("analyse", *arguments)
        assert code == 2 and not out, arguments
        assert told in err and "Traceback" not in err, (arguments, err)


def test_a_rate_in_the_file_is_used_and_a_bad_description_is_told(call: Call, recording: Path) -> None:
    folder = recording.parent
    np.savez(folder / "own.npz", x=vibration(1.0), sampling_rate_hz=float(RATE))
    assert call("analyse", folder / "own.npz", "--unit", "g", "--indicator", "kurtogram")[0] == 0
    good = json.loads((folder / "gearbox.json").read_text())
    for key, value in (
        ("channels", [{"column": "a"}]),
        ("channels", [{"name": "casing", "column": "missing", "unit": "g"}]),
        ("operating", {"shaft": "input"}),
        ("tacho", {"shaft": "input"}),
        ("tacho", {"shaft": "input", "column": "pulse", "pulses_per_revolution": 0}),
    ):
        (folder / "gearbox.json").write_text(json.dumps({**good, key: value}))
        code, _, err = call("analyse", recording, "--teeth", TEETH)
        assert code == 2 and err.startswith("error: ") and "Traceback" not in err, (key, value, err)
