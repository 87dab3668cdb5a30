"""`sideband reconcile` says what of the descriptions it does not use."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from app.cli.main import main
from app.cli.reconcile import NO_BASELINE
from tests.app.cli.test_reconcile import asked, kinematics, written


@pytest.mark.slow
def test_keys_that_are_not_used_are_noted_and_stand_in_the_limits(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    channel = {"name": "a", "quantity": "acceleration", "unit": "m/s^2", "shelf": "left"}
    given, out = written(tmp_path, "t", seconds=0.3, channels=[channel]), tmp_path / "out"
    assert main(asked(kinematics(tmp_path), given, out, "--jobs", "1")) == 0
    note = f"{given}: channels[0].shelf: is not used here"
    assert f"note: {note}\n" in capsys.readouterr().err
    assert note in json.loads((out / "report.json").read_text(encoding="utf-8"))["where"]["limits"]
    given = written(tmp_path, "t", seconds=0.3)
    assert main(asked(kinematics(tmp_path), given, out, "--jobs", "1")) == 0
    assert capsys.readouterr().err.count("note: ") == 1, "of the baseline"


@pytest.mark.slow
def test_that_there_is_no_baseline_is_noted(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    given, out = written(tmp_path, "t", seconds=0.3), tmp_path / "out"
    assert main(asked(kinematics(tmp_path), given, out, "--jobs", "1")) == 0
    assert f"note: {NO_BASELINE}\n" in capsys.readouterr().err
    before = written(tmp_path, "b", seconds=0.35)
    assert main(asked(kinematics(tmp_path), given, out, "--jobs", "1", "--baseline", str(before))) == 0
    assert NO_BASELINE not in capsys.readouterr().err


def recorded(folder: Path, row: np.ndarray) -> Path:
    rate_hz = 20_000
    channel = {"name": "a", "quantity": "acceleration", "unit": "m/s^2"}
    description = {"sampling_rate_hz": rate_hz, "channels": [channel]}
    description["operating"] = {"shaft": "input", "speed_hz": 25.0}
    (folder / "n.json").write_text(json.dumps(description), encoding="utf-8")
    np.savetxt(folder / "n.csv", row[:, None], fmt="%.5f", header="a")
    return folder / "n.json"


@pytest.mark.slow
def test_what_is_wrong_with_the_samples_is_noted(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    row, out = np.random.default_rng(0).normal(size=80_000), tmp_path / "out"
    row[1000:1003] = np.nan
    assert main(asked(kinematics(tmp_path), recorded(tmp_path, row), out, "--jobs", "1")) == 0
    assert "note: a of test 1: not finite, 3 samples" in capsys.readouterr().err
    cut = np.clip(np.nan_to_num(row), -1.0, 1.0)
    assert main(asked(kinematics(tmp_path), recorded(tmp_path, cut), out, "--jobs", "1")) == 0
    assert "note: the measurement of a (test 1): clipped: " in capsys.readouterr().err
