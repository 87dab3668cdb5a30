"""What a description says of its bearing is refused alike by every command, and as the service refuses it."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from jobs.recordings.described import check_kinematics
from signals.ingest import read_description
from sim.core.errors import SpecError

Call = Callable[..., tuple[int, str, str]]
ABOUT: dict[str, Any] = {
    "sampling_rate_hz": 2000.0,
    "channels": [{"name": "casing", "column": "x", "unit": "g", "location": "bearing1", "axis": "y"}],
    "operating": {"shaft": "input", "speed_hz": 21.0},
}
FAN = {"kinematics": {"shafts": [{"name": "fan"}], "bearings": [{"name": "de", "shaft": "fan", "catalogue": "6205"}]}}
MACHINE = {
    "kinematics": {
        "shafts": [{"name": "input"}],
        "bearings": [{"name": "bearing1", "shaft": "input", "catalogue": "6205"}],
    }
}


@pytest.fixture
def command(tmp_path: Path, request: pytest.FixtureRequest) -> tuple[object, ...]:
    (tmp_path / "m.json").write_text(json.dumps(MACHINE), encoding="utf-8")
    recording, machine = tmp_path / "R.json", ("--machine", tmp_path / "m.json")
    return {
        "recording": ("recording", recording),
        "classify": ("classify", "--recording", recording),
        "classify with a machine": ("classify", "--recording", recording, *machine),
        "reconcile": ("reconcile", *machine, "--recording", recording, "--out", tmp_path / "out"),
    }[request.param]


COMMANDS = ("recording", "classify", "classify with a machine", "reconcile")


@pytest.mark.parametrize("command", COMMANDS, indirect=True)
@pytest.mark.parametrize(
    ("more", "field", "given"), [({"bearing": "6999"}, "bearing", "6999"), (FAN, "operating.shaft", "input")]
)
def test_a_bearing_that_is_not_known_is_refused(
    call: Call, tmp_path: Path, command: tuple[object, ...], more: dict[str, Any], field: str, given: str
) -> None:
    with pytest.raises(SpecError) as service:
        check_kinematics(read_description({**ABOUT, **more}))
    np.savez(tmp_path / "R.npz", x=np.random.default_rng(2).normal(size=8000))
    (tmp_path / "R.json").write_text(json.dumps({**ABOUT, **more}), encoding="utf-8")
    code, out, err = call(*command)
    assert (code, out) == (2, "") and f"R.json: {field}" in err and given in err, err
    assert service.value.problems[0].message in err
    assert not (tmp_path / "out").exists()
