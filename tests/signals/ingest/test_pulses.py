"""The pulse signal: named as it was written, not read as a motion, doubted where it looks like none."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from sim.core.errors import SpecError

RATE = 1000.0


def refusal(call: Any, *arguments: Any, **options: Any) -> str:
    with pytest.raises(SpecError) as caught:
        call(*arguments, **options)
    return str(caught.value)


def pulsed(folder: Path) -> Path:
    t = np.arange(2000) / RATE
    noise = np.random.default_rng(4).standard_normal((3, t.size))
    np.savez(folder / "p.npz", a=noise[0], b=noise[1], noise=noise[2], pulse=(np.mod(25 * t, 1) < 0.2).astype(float))
    return folder / "p.npz"


def test_a_channel_of_motion_that_reads_the_pulses_is_refused(read, tmp_path) -> None:
    path = pulsed(tmp_path)
    entry = {"name": "a", "column": "pulse", "quantity": "acceleration", "unit": "g"}
    text = refusal(read, path, channels=[entry], tacho={"shaft": "input", "column": "pulse"})
    assert text.startswith("channels.0.column: reads the same samples as tacho.column") and "'pulse'" in text
    text = refusal(read, path, tacho={"shaft": "input", "column": "b"})
    assert text.startswith("channels.1.column: reads the same samples as tacho.column")
    for free in ({"quantity": "", "unit": "V"}, {"quantity": "displacement", "unit": "um"}):
        (said,) = read(path, channels=[{**entry, **free}], tacho={"shaft": "input", "channel": "pulse"}).remarks[-1:]
        assert said == "channels.0: a holds the pulses of the tacho and is looked at as any channel is"
    assert read(path, tacho={"shaft": "input", "column": "pulse"}).remarks == ()


def test_the_field_that_was_written_is_named(read, tmp_path) -> None:
    path = pulsed(tmp_path)
    for key in ("column", "channel"):
        assert refusal(read, path, tacho={"shaft": "input", key: "q"}).startswith(f"tacho.{key}: is not in the file")
        far = refusal(read, path, tacho={"shaft": "input", key: "pulse", "threshold": 7.0})
        assert far.startswith(f"tacho.{key}: shows fewer than two pulses")


def test_a_column_that_looks_like_no_tacho_is_remarked_on(read, tmp_path) -> None:
    path = pulsed(tmp_path)
    (said,) = read(path, tacho={"shaft": "input", "column": "noise"}).remarks
    assert said.startswith("tacho.column: does not look like a tacho signal") and "%" in said


def test_the_pressure_in_a_cylinder_may_be_channel_and_trigger(read, tmp_path) -> None:
    path = pulsed(tmp_path)
    entry = {"name": "cylinder", "column": "pulse", "quantity": "pressure", "unit": "Pa"}
    found = read(path, channels=[entry], tacho={"shaft": "input", "column": "pulse"})
    assert found.recording.tacho is not None and found.recording.names == ("cylinder",)
    assert any("cylinder holds the pulses of the tacho" in remark for remark in found.remarks)
