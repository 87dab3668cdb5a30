"""`sideband simulate --recording R.json`: a simulation as a recording that the other commands read."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from signals.ingest import read_recording

Call = Callable[..., tuple[int, str, str]]
QUICK = ("simulate", "--preset", "gear-pair", "--duration", 0.3, "--rate", 20000, "--quiet")
CHAIN = {
    "clock": {"sampling_rate_hz": 8000},
    "channels": [
        {"kind": "accelerometer", "name": "top", "place": {"location": "resonator1", "direction_deg": 90}},
        {"kind": "tacho", "name": "key", "preset": "once-per-turn", "shaft": "input"},
    ],
}


@pytest.mark.slow
def test_channels_speed_and_samples_come_back_without_the_start_up(call: Call, tmp_path: Path) -> None:
    path = tmp_path / "run.json"
    settling = ("simulate", "--preset", "overhung", "--duration", 0.4, "--quiet")
    code, _, told = call(*settling, "--recording", path, "--out", tmp_path / "result")
    assert code == 0, told
    recording = read_recording(path)
    summary = json.loads((tmp_path / "result" / "summary.json").read_text())
    assert [c.name for c in recording.channels] == [c["name"] for c in summary["channels"]]
    assert recording.origin == "simulated" and recording.operating is not None
    assert (
        recording.operating.speed_hz
        == json.loads((tmp_path / "result" / "machine.json").read_text())["operating"]["speed_hz"]
    )
    assert recording.start_s == pytest.approx(summary["analysed_from_s"]) and recording.start_s > 0
    with np.load(tmp_path / "result" / "signals.npz") as signals:
        whole = signals[recording.channels[0].name]
    np.testing.assert_array_equal(recording.samples[0], whole[-recording.samples.shape[1] :])


@pytest.mark.slow
def test_of_sensors_the_pulses_become_the_tacho(call: Call, tmp_path: Path) -> None:
    (tmp_path / "chain.json").write_text(json.dumps(CHAIN))
    path = tmp_path / "run.json"
    chain = ("--sensors", tmp_path / "chain.json", "--preset", "overhung")
    code, _, told = call("simulate", *chain, "--duration", 0.5, "--quiet", "--recording", path, "--out", tmp_path / "r")
    assert code == 0, told
    recording = read_recording(path)
    assert recording.names == ("top",) and recording.sampling_rate_hz == 8000
    assert recording.tacho is not None and recording.tacho.shaft == "input"
    assert 1 / np.diff(recording.tacho.pulse_times_s).mean() == pytest.approx(30.0, rel=1e-3)


@pytest.mark.slow
def test_the_result_folder_is_named_after_the_recording(
    call: Call, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert call(*QUICK, "--recording", "before.json")[0] == 0
    assert call(*QUICK, "--recording", "after.json", "--seed", 1)[0] == 0
    assert (tmp_path / "result-before" / "summary.json").is_file()
    assert (tmp_path / "result-after" / "summary.json").is_file()


@pytest.mark.parametrize(
    ("name", "said"),
    [("run.npz", "does not end in .json"), ("none/run.json", "folder that does not exist"), ("old.json", "--force")],
)
def test_what_cannot_be_written_is_refused_before_anything_is_computed(
    call: Call, tmp_path: Path, name: str, said: str
) -> None:
    (tmp_path / "old.npz").write_bytes(b"earlier")
    code, _, told = call(*QUICK, "--recording", tmp_path / name, "--out", tmp_path / "result")
    assert code == 2 and said in told and "--recording" in told
    assert not (tmp_path / "result").exists()
    assert (tmp_path / "old.npz").read_bytes() == b"earlier"


@pytest.mark.slow
def test_force_overwrites(call: Call, tmp_path: Path) -> None:
    (tmp_path / "old.npz").write_bytes(b"earlier")
    code, _, told = call(*QUICK, "--recording", tmp_path / "old.json", "--out", tmp_path / "result", "--force")
    assert code == 0, told
    assert read_recording(tmp_path / "old.json").samples.size


@pytest.mark.slow
def test_with_the_example_sensors_a_pit_is_heard_above_the_noise(call: Call, tmp_path: Path) -> None:
    chain = Path(__file__).parents[3] / "examples" / "rig_sensors.json"
    common = ("simulate", "--preset", "bearing-rig", "--duration", 0.5, "--rate", 51200, "--sensors", chain, "--quiet")
    pit = ("--set", "outer_spall@drive_end.width=0.001")
    for name, more in (("sound", ()), ("now", pit)):
        code, _, told = call(*common, *more, "--recording", tmp_path / f"{name}.json", "--out", tmp_path / name)
        assert code == 0, told
    sound, now = (read_recording(tmp_path / f"{name}.json") for name in ("sound", "now"))
    assert sound.names == now.names == ("drive", "free") and sound.tacho is not None
    level = [np.sqrt(np.mean(r.samples[0] ** 2)) for r in (sound, now)]
    density = json.loads(chain.read_text())["channels"][0]["noise"]["density_per_sqrt_hz"]
    assert level[0] > 0.9 * density * np.sqrt(10_000)
    assert level[1] > 10 * level[0]
