"""The measured recordings, described: they read as what the catalogue says, and tell nothing of the truth."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from proof.real.describe import RIGS, description, index, write
from signals.ingest import read_recording
from signals.units import UNITS, normal
from sim.core.errors import SpecError

RECORDINGS = Path(__file__).parents[3].resolve().parent / "shared" / "recordings"
ENTRIES = index(RECORDINGS)["recordings"] if RECORDINGS.is_dir() else []
IRREGULAR = "motor_phone_accel"
RENAMED = {"Data": "casing", "V1": "input", "V2": "output", "mono": "microphone", "force": "friction"}
TELLING = ("fault", "healthy", "outer", "inner", "ball", "broken", "spall", "crack", "damage", "severe", "normal")

pytestmark = pytest.mark.skipif(not ENTRIES, reason="the recordings are not beside this project")


@pytest.mark.slow
@pytest.mark.parametrize("entry", [e for e in ENTRIES if e["dataset"] != IRREGULAR], ids=lambda e: e["file"])
def test_a_recording_reads_as_the_catalogue_says(tmp_path, entry) -> None:
    found = read_recording(write(RECORDINGS, entry, tmp_path, "case"))
    assert found.sampling_rate_hz == pytest.approx(entry["fs_hz"], rel=1e-4)
    assert found.samples.shape[1] == entry["n_samples"]
    rig = RIGS[entry["dataset"]]
    units = {channel["name"]: channel["unit"] for channel in rig.channels}
    for name, stats in (entry["stats"] or {}).items():
        channel = RENAMED.get(name, name if name in units else "seat")
        samples = found.series(channel).samples / UNITS[normal(units[channel])].factor
        if entry["dataset"] == "motor_acoustic":
            samples = samples[round(0.2 * samples.size) : round(0.8 * samples.size)]
        assert np.std(samples) == pytest.approx(stats["rms"], rel=0.02), name


@pytest.mark.parametrize("entry", [e for e in ENTRIES if e["dataset"] == IRREGULAR], ids=lambda e: e["file"])
def test_an_irregular_clock_is_refused_with_where(tmp_path, entry) -> None:
    with pytest.raises(SpecError, match=r"irregular from sample \d+ .* backward"):
        read_recording(write(RECORDINGS, entry, tmp_path, "case"))


@pytest.mark.parametrize("entry", ENTRIES, ids=lambda e: e["file"])
def test_nothing_in_the_copy_tells_the_truth(tmp_path, entry) -> None:
    text = write(RECORDINGS, entry, tmp_path, "case").read_text().lower()
    assert not [word for word in TELLING if word in text]
    assert all(path.name.startswith("case") for path in tmp_path.iterdir())


def test_the_speed_is_the_stated_one_unless_the_measured_is_asked_for() -> None:
    entry = next(e for e in ENTRIES if e["file"] == "uestc/N_1000_1.mat")
    assert description(entry)["operating"]["speed_hz"] == pytest.approx(1000 / 60)
    assert description(entry, measured_speed=True)["operating"]["speed_hz"] == pytest.approx(17.34)
    assert json.dumps(description(entry, condition="baseline")).count("baseline") == 1
