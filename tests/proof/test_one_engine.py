"""The page says of the splits that one engine ran each which engine it was, and how many of their cases are run."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from proof.entire import cases_of_design, held
from proof.one_engine import CLEAR, DESIGNS, FAR_OFF, of_sizes, one_engine, seen_pairs, seen_singles
from proof.plan import Case
from proof.score.rates import MEASURES, at_target, rate
from proof.targets import TARGETS, written
from proof.visible import Visible
from proof.whole import read

LATEST = DESIGNS[0].split
PLANNED = cases_of_design(DESIGNS[0])
STORED = Path(__file__).parents[2] / "proof" / "results" / "entire.json"


def stored(folder: Path, cases: tuple[Case, ...], section: str = "held", **about: object) -> None:
    """Scores of earlier cases under these names, as a first run unless `about` says otherwise."""
    kept = json.loads(STORED.read_text(encoding="utf-8"))["scores"]
    scores = [kept[k % len(kept)] | {"name": case.name} for k, case in enumerate(cases)]
    document = {"split": "held", "engine": "feed", "commit": "c0ffee00", "first_run": True, "scores": scores, **about}
    (folder / f"{section}.json").write_text(json.dumps(document), encoding="utf-8")


def words(text: str) -> str:
    return " ".join(text.split())


def part(text: str, split: str) -> str:
    """What is said of one split."""
    return text.partition(f": split `{split}`")[2].partition("\n### ")[0]


@pytest.mark.parametrize("count", [3, 40])
def test_what_is_run_is_told_with_its_engine_and_that_the_others_are_not(count: int, tmp_path: Path) -> None:
    stored(tmp_path, held()[:count])
    said = words(one_engine(tmp_path, "beef"))
    assert (
        f"{count} of the plan's 120 cases are run by one engine, `feed` (commit c0ffee00), which had met none" in said
    )
    assert "The others are not run yet" in said and "make proof SPLIT=held" in said
    present, earlier = said.split("### An earlier engine")
    latest, before = present.split("### An engine before: split `held`")
    assert latest.startswith(f"### The latest plan: split `{LATEST}`") and "|" not in latest
    assert f"### The plan before: split `{DESIGNS[1].split}`" in latest and "### A plan before: split `wide`" in latest
    assert "| false alarms on nulls" in before and "all first runs" not in before
    assert "None of its cases are stored." in earlier and "|" not in earlier


def test_the_command_that_makes_the_figures_again_names_their_cases_alone(tmp_path: Path) -> None:
    stored(tmp_path, held()[2:5])
    assert "\n```sh\ngit checkout c0ffee00 && make proof SPLIT=held CASES=h003,h004,h005\n```\n" in one_engine(
        tmp_path, "beef"
    )
    stored(tmp_path, held()[2:5], commit=None)
    assert "git checkout" not in one_engine(tmp_path, "beef")


def test_that_no_engine_had_met_the_cases_is_said_of_what_is_stored_so_alone(tmp_path: Path) -> None:
    for first in (False, None):
        stored(tmp_path, held()[:4], first_run=first, engine="later")
        said = words(part(one_engine(tmp_path, "beef"), "held"))
        assert "had met none" not in said and "not stored as their first run" in said


def test_first_runs_of_any_number_of_engines_stand_beside_those_of_the_one(tmp_path: Path) -> None:
    stored(tmp_path, held()[:40])
    stored(tmp_path, held()[40:70], "begun", engine="bead")
    stored(tmp_path, held()[70:75], "last", engine="bade")
    stored(tmp_path, held()[75:99], "seen", engine="fade", first_run=False)
    text = part(one_engine(tmp_path, "beef"), "held")
    said = words(text)
    assert "40 of the plan's 120 cases are run" in said
    assert '30 more were first met by another engine, `bead` (commit c0ffee00) ("Begun" below).' in said
    assert '5 more were first met by another engine, `bade` (commit c0ffee00) ("Last" below).' in said
    assert "all 75 stored first runs of this plan together, by 3 engines" in said and "fade" not in said
    rows = {row.split("|")[1].strip(): row for row in text.splitlines() if row.startswith("| ")}
    runs = [read(tmp_path / f"{name}.json") for name in ("held", "begun", "last")]
    for target in TARGETS:
        for scores in (runs[0], [s for run in runs for s in run]):
            of = [s for s in scores if s.group == target.group]
            at = [s for s in of if at_target(s)]
            for found in (at, of):
                assert written(rate(found, MEASURES[target.measure])) in rows[target.words], target.words
    assert "Missed by the one engine are:" in said and "Missed by all first runs together are:" in said


def test_a_case_of_two_summaries_counts_once(tmp_path: Path) -> None:
    stored(tmp_path, held()[:4])
    stored(tmp_path, held()[2:6], "begun", engine="bead")
    assert "all 6 stored first runs" in words(one_engine(tmp_path, "beef"))


def test_whether_a_stored_run_is_of_the_engine_at_hand_is_said(tmp_path: Path) -> None:
    stored(tmp_path, held()[:4], LATEST, split=LATEST)
    stored(tmp_path, held()[4:6], "begun", engine="bead")
    assert "No stored run is of the engine at hand" in words(one_engine(tmp_path, "beef"))
    said = words(one_engine(tmp_path, "bead"))
    assert 'Of the engine at hand when this page was written is "Begun" alone.' in said and "No stored run" not in said


def test_what_the_engine_at_hand_makes_of_the_latest_plan_stands_apart_from_first_runs(tmp_path: Path) -> None:
    stored(tmp_path, PLANNED[:4], LATEST, split=LATEST)
    assert "by the engine at hand" not in part(one_engine(tmp_path, "beef"), LATEST).partition("####")[2]
    stored(tmp_path, PLANNED[:3], "resumed", split=LATEST, engine="beef", first_run=False)
    stored(tmp_path, PLANNED[4:5], "closing", split=LATEST, engine="beef")
    text = part(one_engine(tmp_path, "beef"), LATEST)
    first, _, own = text.partition("#### The same plan by the engine at hand")
    assert "4 of the plan's 72 cases by `beef` (commit c0ffee00), 1 of them it met first" in words(own)
    assert "no measure of what it makes of machines it has not met" in words(own)
    assert '"Closing" and "Resumed"' in own or '"Resumed" and "Closing"' in own
    assert "| the engine at hand, cases it had mostly met |" in own and "stored first runs" not in own
    assert "all 5 stored first runs" in words(first)
    assert "by the engine at hand" not in part(one_engine(tmp_path, "bead"), LATEST).partition("####")[2]


def test_nothing_is_said_to_be_left_where_all_are_run(tmp_path: Path) -> None:
    stored(tmp_path, held())
    said = one_engine(tmp_path, "beef")
    assert "120 of the plan's 120 cases" in said and "not run" not in said


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


def test_pairs_are_parted_by_how_far_the_fainter_moves_what_the_other_shows() -> None:
    scores = [s for s in read(STORED) if s.group == "double" and at_target(s)][:4]
    assert len(scores) == 4
    ratios = (CLEAR + 0.1, CLEAR - 0.1, CLEAR + 0.1, CLEAR - 0.1)
    seen = {
        s.name: Visible(effect_db=9.0, drift_db=1.0, new_share=0.0, parts_db=(9.0, ratio))
        for s, ratio in zip(scores, ratios, strict=True)
    }
    told = [replace(s, both=k < 3) for k, s in enumerate(scores)]
    assert "so far 2 of 2 are named whole; of the others 1 of 2." in seen_pairs(told, seen)
    assert seen_pairs(told, {}) == "" == seen_pairs([], seen)
    bare = {name: replace(one, parts_db=()) for name, one in seen.items()}
    assert seen_pairs(told, bare) == ""


def test_how_far_sizes_are_off_is_told_of_those_that_were_told() -> None:
    one = read(STORED)[0]
    off = [(0.1, True), (0.2, True), (FAR_OFF, False), (1.0, True)]
    told = [replace(one, severity_error=e, severity_covered=c, placebo_improves=c) for e, c in off]
    none = replace(one, severity_error=None, severity_covered=None, placebo_improves=None)
    said = of_sizes([*told, none])
    assert said.startswith("Of the 5 cases") and "4 sizes were told: half are within 47 %" in said
    assert "50 % are off by 74 % or more" in said and "3 of their intervals" in said and "In 3 of 4 cases" in said
    assert of_sizes([none]) == ""
