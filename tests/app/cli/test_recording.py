"""`sideband recording`: what is in a recording, what is wrong with it, and refusals in one line."""

from __future__ import annotations

import json
from collections.abc import Callable

import numpy as np
import pytest

Call = Callable[..., tuple[int, str, str]]

RATE = 2000.0
ABOUT = {
    "sampling_rate_hz": RATE,
    "channels": [{"name": "casing", "column": "x", "unit": "g", "location": "bearing1", "axis": "y"}],
    "operating": {"shaft": "input", "speed_hz": 21.0, "torque_nm": 5},
}


@pytest.fixture
def described(tmp_path):
    t = np.arange(8000) / RATE
    x = np.random.default_rng(2).normal(size=t.size)
    np.savez(tmp_path / "R.npz", x=x)
    broken = x + 3 * np.sin(2 * np.pi * 50 * t)
    broken[100:140], broken[500] = 0.0, np.nan
    np.savez(tmp_path / "bad.npz", x=broken)
    np.savez(tmp_path / "hum.npz", x=x + 3 * np.sin(2 * np.pi * 50 * t))
    for stem in ("R", "bad", "hum"):
        (tmp_path / f"{stem}.json").write_text(json.dumps(ABOUT))
    return tmp_path


def test_a_sound_recording_is_told_in_si(call: Call, described) -> None:
    code, out, _ = call("recording", described / "R.json", "--check")
    assert code == 0
    assert "4 s at 2000 Hz (8000 samples)" in out and "casing" in out and "m/s^2" in out
    assert "input at 21 Hz, 5 N m" in out and "no defects found" in out


def test_defects_are_told_with_their_place_and_exit_code_1(call: Call, described) -> None:
    code, out, _ = call("recording", described / "bad.json", "--check")
    assert code == 1
    assert "dropout" in out and "0.05-0.07 s" in out and "not finite" in out
    assert call("recording", described / "bad.json")[0] == 0


def test_mains_hum_is_told_and_is_no_defect(call: Call, described) -> None:
    code, out, _ = call("recording", described / "hum.json", "--check")
    assert code == 0 and "mains hum at 50" in out


def test_a_speed_in_rpm_and_noise_alone_are_remarked_on_and_no_defect(call: Call, described) -> None:
    rpm = {**ABOUT, "operating": {"shaft": "input", "speed_hz": 1480}, "data": "R.npz"}
    (described / "rpm.json").write_text(json.dumps(rpm))
    code, out, _ = call("recording", described / "rpm.json", "--check")
    assert code == 0 and "no defects found" in out
    assert "note: operating.speed_hz" in out and "24.67 Hz" in out
    assert "note: casing: nothing stands out of noise" in out
    document = json.loads(call("recording", described / "rpm.json", "--check", "--json")[1])
    assert any("24.67 Hz" in remark for remark in document["remarks"]) and document["findings"] == []
    unchecked = call("recording", described / "rpm.json")[1]
    assert "note: operating.speed_hz" in unchecked and "note: casing" not in unchecked


def test_volts_of_no_stated_sensitivity_are_told(call: Call, described) -> None:
    channel = {**ABOUT["channels"][0], "quantity": "acceleration", "unit": "V"}
    (described / "volts.json").write_text(json.dumps({**ABOUT, "channels": [channel], "data": "R.npz"}))
    code, out, _ = call("recording", described / "volts.json", "--check")
    assert code == 0 and "in V: no sensitivity is stated, so levels are not accelerations" in out


def test_json_holds_the_same(call: Call, described) -> None:
    code, out, _ = call("recording", described / "bad.json", "--check", "--json")
    document = json.loads(out)
    assert code == 1 and document["duration_s"] == 4.0
    assert {f["kind"] for f in document["findings"]} == {"not_finite", "dropout"}
    assert document["channels"][0]["rms"] > 9.8 * 0.9


def test_what_cannot_be_read_is_exit_code_2_and_no_traceback(call: Call, described) -> None:
    (described / "no.json").write_text(json.dumps({**ABOUT, "sampling_rate_hz": None, "data": "R.npz"}))
    code, out, err = call("recording", described / "no.json")
    assert (code, out) == (2, "") and "never guessed" in err and "Traceback" not in err
    (described / "no.json").write_text(json.dumps({**ABOUT, "data": "nowhere.npz"}))
    assert "no such file" in call("recording", described / "no.json")[2]


def test_a_channel_that_never_changes_is_stuck_or_silent_and_has_no_level(call: Call, described) -> None:
    two = [{**ABOUT["channels"][0], "name": name, "column": name} for name in ("held", "none")]
    np.savez(described / "still.npz", held=np.full(8000, 0.01), none=np.zeros(8000))
    (described / "still.json").write_text(json.dumps({**ABOUT, "channels": two}))
    code, out, _ = call("recording", described / "still.json", "--check")
    assert code == 1 and "held: stuck: the channel never changes" in out and "none: silence: the channel" in out
    assert "always 0.09807 m/s^2" in out and "always 0 m/s^2" in out and "rms" not in out and "constant" not in out
    document = json.loads(call("recording", described / "still.json", "--json")[1])
    assert [c["rms"] for c in document["channels"]] == [0.0, 0.0]


def test_too_few_turns_for_a_comparison_are_remarked_on(call: Call, described) -> None:
    np.savez(described / "short.npz", x=np.random.default_rng(2).normal(size=1000))
    (described / "short.json").write_text(json.dumps(ABOUT))
    out = call("recording", described / "short.json", "--check")[1]
    assert "note: 0.5 s are 10.5 turns of input: to look for its lines 12 turns or more are needed, 0.58 s" in out
    assert "turns" not in call("recording", described / "R.json", "--check")[1]
