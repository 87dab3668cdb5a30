"""`sideband reconcile` says what of the descriptions it does not use."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from app.cli.main import main
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
    assert "note: " not in capsys.readouterr().err
