"""The page says of the splits that one engine ran each which engine it was, and how many of their cases are run."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from proof.entire import held
from proof.one_engine import CLEAR, COMMITS, FAR_OFF, of_sizes, one_engine, seen_singles
from proof.plan import Case
from proof.score.rates import at_target
from proof.visible import Visible
from proof.whole import read

STORED = Path(__file__).parents[2] / "proof" / "results" / "entire.json"


def stored(folder: Path, cases: tuple[Case, ...]) -> None:
    """Scores of earlier cases under these names."""
    kept = json.loads(STORED.read_text(encoding="utf-8"))
    scores = [score | {"name": case.name} for score, case in zip(kept["scores"], cases, strict=False)]
    (folder / "held.json").write_text(json.dumps({"engine": "feed", "scores": scores}), encoding="utf-8")


@pytest.mark.parametrize("count", [3, 40])
def test_what_is_run_is_told_with_its_engine_and_that_the_others_are_not(count: int, tmp_path: Path) -> None:
    stored(tmp_path, held()[:count])
    said = " ".join(one_engine(tmp_path).split())
    assert f"{count} of its 120 cases are run, all by engine `feed` (commit {COMMITS['held']})" in said
    assert "The others are not run yet" in said and "make proof SPLIT=held" in said
    present, earlier = said.split("### An earlier engine")
    latest, before = present.split("### An engine before: split `held`")
    assert latest.startswith("### The latest engine: split `mixed`") and "|" not in latest
    assert "### The latest plan that is run whole: split `wide`" in latest
    assert "| false alarms on nulls" in before
    assert "None of its cases are stored." in earlier and "|" not in earlier


def test_what_another_engine_met_first_is_told_apart(tmp_path: Path) -> None:
    stored(tmp_path, held()[40:])
    (tmp_path / "held.json").rename(tmp_path / "begun.json")
    stored(tmp_path, held()[:40])
    said = " ".join(one_engine(tmp_path).split())
    assert "40 of its 120 cases are run" in said and 'first met by an earlier engine ("Begun" below). `git' in said


def test_nothing_is_said_to_be_left_where_all_are_run(tmp_path: Path) -> None:
    kept = json.loads(STORED.read_text(encoding="utf-8"))["scores"]
    every = [kept[k % len(kept)] | {"name": case.name} for k, case in enumerate(held())]
    (tmp_path / "held.json").write_text(json.dumps({"engine": "feed", "scores": every}), encoding="utf-8")
    said = one_engine(tmp_path)
    assert "120 of its 120 cases" in said and "not run" not in said


def test_single_effects_are_parted_by_how_far_they_move_the_spectrum() -> None:
    scores = [s for s in read(STORED) if s.group == "single" and at_target(s)][:6]
    assert {s.place for s in scores} == {True, False}
    seen = {
        s.name: Visible(effect_db=(CLEAR + 0.1 if s.place else CLEAR - 0.1), drift_db=1.0, new_share=0.0)
        for s in scores
    }
    right = sum(bool(s.place) for s in scores)
    said = seen_singles(scores, seen)
    assert f"{right}/{right} = 100 %" in said and f"0/{6 - right} = 0 %" in said
    assert seen_singles(scores, {}) == "" == seen_singles([], seen)


def test_how_far_sizes_are_off_is_told_of_those_that_were_told() -> None:
    one = read(STORED)[0]
    off = [(0.1, True), (0.2, True), (FAR_OFF, False), (1.0, True)]
    told = [replace(one, severity_error=e, severity_covered=c, placebo_improves=c) for e, c in off]
    none = replace(one, severity_error=None, severity_covered=None, placebo_improves=None)
    said = of_sizes([*told, none])
    assert said.startswith("Of the 5 cases") and "4 sizes were told: half are within 47 %" in said
    assert "50 % are off by 74 % or more" in said and "3 of their intervals" in said and "In 3 of 4 cases" in said
    assert of_sizes([none]) == ""
