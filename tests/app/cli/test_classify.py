import json
from dataclasses import replace

import numpy as np
import pytest

from app.cli.main import main
from learn.model import default_model, save

RATE, SPEED = 20_000.0, 25.0
ORDERS = {"6205": 3.5848}


def outer_fault(turns=60.0, seed=0):
    rng = np.random.default_rng(seed)
    n = int(turns / SPEED * RATE)
    x = np.zeros(n)
    times = np.arange(0, turns, 1 / ORDERS["6205"])
    x[np.minimum((times / SPEED * RATE).astype(int), n - 1)] = 1.0
    t = np.arange(200) / RATE
    shaft = 0.05 * np.sin(2 * np.pi * SPEED * np.arange(n) / RATE)
    return np.convolve(x, np.exp(-t * 800) * np.sin(2 * np.pi * 3000 * t))[:n] + shaft + 0.05 * rng.standard_normal(n)


@pytest.fixture
def recording(tmp_path):
    def write(samples, **extra):
        np.savez(tmp_path / "r.npz", acc=samples)
        document = {
            "sampling_rate_hz": RATE,
            "channels": [{"name": "acc", "unit": "m/s^2"}],
            "operating": {"shaft": "motor", "speed_hz": SPEED},
            **extra,
        }
        path = tmp_path / "r.json"
        path.write_text(json.dumps(document))
        return str(path)

    return write


def answer(capsys, *arguments):
    assert main(["classify", *arguments, "--json"]) == 0
    return json.loads(capsys.readouterr().out)


@pytest.mark.slow
@pytest.mark.parametrize("how", ["6205", {"catalogue": "6205"}, {"orders": {"bpfo": 3.5848, "bpfi": 5.4152}}])
def test_an_outer_race_fault_is_named_with_the_lines_that_say_so(recording, capsys, how):
    found = answer(capsys, "--recording", recording(outer_fault(), bearing=how))
    assert found["label"] == "outer"
    assert found["probabilities"]["outer"] > 0.8
    assert sum(found["probabilities"].values()) == pytest.approx(1.0)
    assert found["lines"][0]["family"] == "BPFO"
    assert found["lines"][0]["frequency_hz"] == pytest.approx(ORDERS["6205"] * SPEED, rel=0.01)
    assert found["geometry"] == "known"
    assert found["speed"]["speed_hz"] == pytest.approx(SPEED, rel=0.01)


def test_without_geometry_it_is_named_too(recording, capsys):
    found = answer(capsys, "--recording", recording(outer_fault()))
    assert found["label"] == "outer"
    assert found["geometry"] == "unknown"


def test_noise_is_healthy(recording, capsys):
    noise = np.random.default_rng(2).standard_normal(50_000)
    found = answer(capsys, "--recording", recording(noise, bearing="6205"), "--trust-speed")
    assert found["label"] == "healthy"
    assert found["speed"] == {"speed_hz": SPEED, "method": "given", "estimated": False}


def test_geometry_of_a_machine_file(recording, tmp_path, capsys):
    machine = tmp_path / "m.json"
    kinematics = {"shafts": [{"name": "motor"}], "bearings": [{"name": "de", "shaft": "motor", "catalogue": "6205"}]}
    machine.write_text(json.dumps({"kinematics": kinematics}))
    found = answer(capsys, "--recording", recording(outer_fault()), "--machine", str(machine))
    assert (found["label"], found["bearing"]) == ("outer", "de")


def test_kinematics_in_the_description_itself(recording, capsys):
    kinematics = {"shafts": [{"name": "motor"}], "bearings": [{"name": "de", "shaft": "motor", "catalogue": "6205"}]}
    found = answer(capsys, "--recording", recording(outer_fault(), kinematics=kinematics))
    assert (found["label"], found["bearing"]) == ("outer", "de")


def test_text_for_people(recording, capsys):
    assert main(["classify", "--recording", recording(outer_fault(), bearing="6205")]) == 0
    out = capsys.readouterr().out
    assert out.startswith("outer at bearing (outer ")
    assert "BPFO" in out


@pytest.mark.parametrize(
    ("extra", "told"),
    [
        ({"bearing": 7}, "bearing"),
        ({"bearing": "no such size"}, "no such size"),
        ({"bearing": "6205", "kinematics": {}}, "kinematics"),
        ({"channels": [{"name": "acc", "unit": "V", "quantity": "voltage"}]}, "no vibration"),
    ],
)
def test_what_cannot_be_used_is_refused_with_its_place(recording, capsys, extra, told):
    assert main(["classify", "--recording", recording(outer_fault(10.0), **extra)]) == 2
    assert told in capsys.readouterr().err


def test_samples_that_are_no_numbers_and_short_records_are_refused(recording, capsys):
    broken = outer_fault(10.0)
    broken[5] = np.nan
    assert main(["classify", "--recording", recording(broken)]) == 2
    assert "not finite" in capsys.readouterr().err
    assert main(["classify", "--recording", recording(outer_fault(2.0)), "--trust-speed"]) == 2
    assert "too few turns" in capsys.readouterr().err


def test_a_malformed_model_is_refused(recording, tmp_path, capsys):
    model = tmp_path / "model.json"
    model.write_text("{}")
    assert main(["classify", "--recording", recording(outer_fault()), "--model", str(model)]) == 2
    assert "sideband-classifier" in capsys.readouterr().err


GEARED = {
    "shafts": [{"name": "motor"}, {"name": "out"}],
    "gears": [{"name": "pinion", "shaft": "motor", "teeth": 23}, {"name": "wheel", "shaft": "out", "teeth": 57}],
    "meshes": [{"name": "mesh", "gears": ["pinion", "wheel"]}],
}


def geared(*, tooth, turns=60.0):
    """Three mesh harmonics of 23 teeth, modulated once a turn; a tooth of the wheel that rings when it is struck."""
    n = int(turns / SPEED * RATE)
    turn = SPEED * np.arange(n) / RATE
    x = (1 + 0.4 * np.cos(2 * np.pi * turn)) * sum(np.cos(2 * np.pi * 23 * k * turn + k) / k for k in (1, 2, 3))
    if tooth:
        train = np.zeros(n)
        train[np.flatnonzero(np.diff(np.floor(turn * 23 / 57)) > 0)] = 1.5
        t = np.arange(100) / RATE
        x = x + np.convolve(train, np.exp(-t * 800) * np.sin(2 * np.pi * 3000 * t))[:n]
    return x + 0.1 * np.random.default_rng(4).standard_normal(n)


@pytest.mark.slow
def test_a_tooth_of_a_described_stage_is_named_with_its_gear(recording, capsys):
    found = answer(capsys, "--recording", recording(geared(tooth=True), kinematics=GEARED))
    assert (found["label"], found["stage"], found["gear"], found["bearing"]) == ("tooth", "mesh", "wheel", None)
    assert found["probabilities"]["tooth"] > 0.7
    assert found["lines"][0]["frequency_hz"] == pytest.approx(SPEED * 23 / 57, rel=0.01)
    assert len(found["parts"]) == 1
    sound = answer(capsys, "--recording", recording(geared(tooth=False), kinematics=GEARED))
    assert (sound["label"], sound["gear"]) == ("healthy", None)


@pytest.mark.slow
def test_bearings_and_gears_are_both_answered(recording, capsys):
    both = {**GEARED, "bearings": [{"name": "de", "shaft": "motor", "catalogue": "6205"}]}
    path = recording(geared(tooth=True), kinematics=both)
    found = answer(capsys, "--recording", path, "--trust-speed")
    parts = {part["bearing"] or part["stage"]: part for part in found["parts"]}
    assert set(parts) == {"de", "mesh"}
    assert parts["mesh"]["label"] == "tooth"
    assert set(parts["de"]["probabilities"]) == {"healthy", "outer", "inner", "ball"}
    least = min(parts.values(), key=lambda part: part["probabilities"]["healthy"])
    assert found["label"] == least["label"]
    assert main(["classify", "--recording", path, "--trust-speed"]) == 0
    assert "mesh: tooth" in capsys.readouterr().out


@pytest.mark.slow
def test_a_model_without_gears_answers_for_bearings_and_says_so(recording, tmp_path, capsys):
    model = default_model()
    path = tmp_path / "old.json"
    save(replace(model, heads={k: v for k, v in model.heads.items() if not k.startswith("gear")}), path)
    found = answer(capsys, "--recording", recording(outer_fault(), kinematics=GEARED), "--model", str(path))
    assert found["label"] == "outer"
    assert any(remark.startswith("gears:") for remark in found["remarks"])


def test_a_stage_that_the_recording_does_not_hold_leaves_the_bearing(recording, capsys):
    high = {**GEARED, "gears": [{**gear, "teeth": 20 * gear["teeth"]} for gear in GEARED["gears"]]}
    both = {**high, "bearings": [{"name": "de", "shaft": "motor", "catalogue": "6205"}]}
    found = answer(capsys, "--recording", recording(outer_fault(), kinematics=both))
    assert (found["label"], found["bearing"], len(found["parts"])) == ("outer", "de", 1)
    assert any(remark.startswith("mesh: is not looked at") for remark in found["remarks"])
    assert main(["classify", "--recording", recording(outer_fault(), kinematics=high), "--json"]) == 2
