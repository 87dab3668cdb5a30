"""The example runs as it stands: a tiny recipe, a recording with a made fault, and bad input told plainly."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from examples.dataset_to_classifier import main, small_recipe
from learn.model import load
from sideband_datasets import make_plan
from sideband_datasets.folder import verify
from signals.encode import describe, encode
from tests.sideband_datasets.small import OUTER, document
from tests.strategies.impulses import recorded, sound, train


def tiny() -> dict[str, Any]:
    """Two classes of eight rotors, 15 turns a recording, one sensor."""
    recipe = document(count=32, sampling_rate_hz=10_000, duration_s=0.6, settle_s=0.1, peaks={"spectra": []})
    recipe["machines"][0]["instances"] = 8
    recipe["measurement"][0]["chain"]["channels"].pop()
    recipe |= {"faults": [{"name": "outer", "terms": [OUTER]}], "windows": {"length_revolutions": 10}}
    return recipe


@pytest.mark.slow
def test_the_way_from_recipe_to_verdict(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    recording = recorded(sound(2) + train(np.random.default_rng(2), 3.5848, 1.0))
    (tmp_path / "r.npz").write_bytes(encode(recording, "npz"))
    (tmp_path / "r.json").write_text(json.dumps({**describe(recording), "data": "r.npz", "bearing": "6205"}))
    (tmp_path / "recipe.json").write_text(json.dumps(tiny()))
    out = tmp_path / "made" / "example"
    given = ["--recipe", str(tmp_path / "recipe.json"), "--out", str(out), "--workers", "1"]
    assert main([*given, "--recording", str(tmp_path / "r.json")]) == 0
    told = capsys.readouterr().out
    assert "32 of 32 rows" in told and "r.json: " in told and "geometry known" in told
    assert verify(out) == []
    assert load(tmp_path / "made" / "example.model.json").made_by["real_samples"] == 0
    shard = next((out / "data").iterdir())
    before = shard.stat().st_mtime_ns
    out.rename(out.with_name("example.partial"))
    assert main(given) == 0, "what is there is gone on with"
    assert shard.stat().st_mtime_ns == before
    capsys.readouterr()
    (tmp_path / "recipe.json").write_text(json.dumps({**tiny(), "seed": 9}))
    assert main(given) == 2, "a dataset is not taken for another"
    assert "another recipe" in capsys.readouterr().err


@pytest.mark.slow
def test_its_recipe_can_be_planned_without_a_leak_and_with_all_classes() -> None:
    plan = make_plan(small_recipe())
    assert not plan.warnings and plan.rows == 160


def test_a_recipe_that_is_none_is_told_in_a_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "recipe.json").write_text("{}")
    assert main(["--recipe", str(tmp_path / "recipe.json"), "--out", str(tmp_path / "d")]) == 2
    assert capsys.readouterr().err.startswith("error: ")
