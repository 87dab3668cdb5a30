"""Stored answers are evidence: later ones are held against them, and replace none of another engine's."""

from __future__ import annotations

import argparse
import json
import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import pytest

from proof import __main__ as commands
from proof import page
from proof.case import canonical, truth_of
from proof.keep import Answers, against, keep
from proof.page import UNMET
from proof.plan import plan
from proof.runs import every_run
from proof.said import FIRST_RUNS, SECTIONS
from proof.score.one import Score, score
from proof.score.stored import OtherRun

RESULTS = Path(page.__file__).parent / "results"
CASES = plan("quiet")[:4]


def scores(verdict: str = "nothing_missing", count: int = 2) -> tuple[Score, ...]:
    return tuple(score(json.loads(canonical(truth_of(case))), {"verdict": verdict}) for case in CASES[:count])


def answers(engine: str = "old", found: Sequence[Score] = scores(), **about: object) -> Answers:
    return replace(Answers(split="quiet", engine=engine, scores=tuple(found)), **about)  # type: ignore[arg-type]


def kept(folder: Path, section: str = "quiet") -> dict[str, object]:
    found: dict[str, object] = json.loads((folder / f"{section}.json").read_text(encoding="utf-8"))
    return found


def test_answers_of_another_engine_are_not_replaced(tmp_path: Path) -> None:
    keep(tmp_path, "quiet", answers(first=True, commit="c0ffee"))
    before = (tmp_path / "quiet.json").read_bytes()
    for add in (False, True):
        with pytest.raises(OtherRun, match=r"quiet.json holds the answers of engine old to 2 cases.*another --name"):
            keep(tmp_path, "quiet", answers("new", scores("explained", 3)), add=add)
    assert (tmp_path / "quiet.json").read_bytes() == before
    keep(tmp_path, "seen", answers("new", scores("explained")))
    assert kept(tmp_path, "seen")["first_run"] is False and "commit" not in kept(tmp_path, "seen")


def test_the_same_engine_drops_no_cases_and_its_first_run_stays_one(tmp_path: Path) -> None:
    keep(tmp_path, "quiet", answers(first=True, commit="c0ffee"))
    with pytest.raises(OtherRun, match=r"q002.*--add keeps both"):
        keep(tmp_path, "quiet", answers(found=scores(count=1)))
    keep(tmp_path, "quiet", answers())
    assert (kept(tmp_path)["first_run"], kept(tmp_path)["commit"]) == (True, "c0ffee")


def test_what_is_added_to_first_runs_is_one(tmp_path: Path) -> None:
    keep(tmp_path, "quiet", answers(first=True, commit="c0ffee"))
    more = scores(count=3)[2:]
    with pytest.raises(OtherRun, match=r"add --first-run if no engine had met q003"):
        keep(tmp_path, "quiet", answers(found=more), add=True)
    whole = keep(tmp_path, "quiet", answers(found=more, first=True, commit="c0ffee"), add=True)
    assert [s.name for s in whole.scores] == ["q001", "q002", "q003"] and whole.first
    keep(tmp_path, "seen", answers())
    with pytest.raises(OtherRun, match=r"seen.json holds cases that are not known to be first runs"):
        keep(tmp_path, "seen", answers(found=scores(count=4)[3:], first=True, commit="c0ffee"), add=True)


def test_a_first_run_names_its_commit_and_cases_that_are_stored_nowhere(tmp_path: Path) -> None:
    with pytest.raises(OtherRun, match=r"--commit"):
        keep(tmp_path, "quiet", answers(first=True))
    keep(tmp_path, "quiet", answers())
    with pytest.raises(OtherRun, match=r"quiet.json holds answers to q001, q002 already"):
        keep(tmp_path, "last", answers("new", first=True, commit="c0ffee"))
    assert not (tmp_path / "last.json").exists()


def test_each_answer_is_held_against_its_first_run(tmp_path: Path) -> None:
    keep(tmp_path, "quiet", answers(first=True, commit="c0ffee"))
    keep(tmp_path, "repeat", answers("between", scores("explained")))
    keep(tmp_path, "last", answers("other", scores(count=3)[2:], first=True, commit="c0ffee"))
    now = [*scores(count=1), *scores("explained", 4)[1:]]
    found = against(tmp_path, answers("new", now))
    text = "\n".join(found.lines)
    assert "0 of 1 as stored in last.json (engine other, here new)" in text and "repeat.json" not in text
    assert "1 of 2 as stored in quiet.json (engine old, here new)" in text
    assert "1 of 3 answers are the same as stored; nothing was stored or replaced" in text
    assert "1 have no stored answer: q004" in text
    assert {word.split()[0] for word in found.others} == {"q002", "q003"}
    assert "q002 (nothing_missing was stored, now explained)" in found.others
    assert not against(tmp_path, answers("new", scores("explained")), "repeat").others


def test_an_answer_is_held_against_that_of_the_same_engine_before_all_others(tmp_path: Path) -> None:
    keep(tmp_path, "quiet", answers(first=True, commit="c0ffee"))
    keep(tmp_path, "present", answers("new", scores("explained", 1)))
    found = against(tmp_path, answers("new", scores("explained", 2)))
    text = "\n".join(found.lines)
    assert "1 of 1 as stored in present.json (the same engine)" in text and "0 of 1 as stored in quiet.json" in text
    assert found.others == ("q002 (nothing_missing was stored, now explained)",)


def given(folder: Path, *more: str) -> argparse.Namespace:
    """The command `score` on cases of a folder, whose truths are those sealed."""
    for case in CASES[:2]:
        for name, text in (("truth", canonical(truth_of(case))), ("reports", json.dumps(REPORT))):
            (folder / name).mkdir(exist_ok=True)
            (folder / name / f"{case.name}.json").write_text(text, encoding="utf-8")
    where = ["--truth", str(folder / "truth"), "--reports", str(folder / "reports")]
    return commands.parser().parse_args(["score", "--split", "quiet", *where, *more])


REPORT = {"engine": "new", "report": {"verdict": "explained"}}


def test_single_cases_fail_where_a_verdict_is_another(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(commands, "RESULTS", tmp_path / "results")
    keep(tmp_path / "results", "quiet", answers(first=True, commit="c0ffee"))
    before = (tmp_path / "results" / "quiet.json").read_bytes()
    with pytest.raises(SystemExit, match=re.escape("another verdict than stored: q001 (nothing_missing was stored")):
        commands.score_all(given(tmp_path, "--cases", "q001"))
    commands.score_all(given(tmp_path))  # a whole split is told, and no failure
    assert "0 of 2 answers are the same as stored" in capsys.readouterr().err
    with pytest.raises(SystemExit, match=r"another --name"):
        commands.score_all(given(tmp_path, "--keep"))
    assert (tmp_path / "results" / "quiet.json").read_bytes() == before


def test_single_cases_pass_where_verdicts_are_those_stored_or_none_is(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(commands, "RESULTS", tmp_path / "results")
    commands.score_all(given(tmp_path, "--cases", "q001"))
    keep(tmp_path / "results", "quiet", answers("old", scores("explained")))
    commands.score_all(given(tmp_path, "--cases", "q001,q002"))
    with pytest.raises(SystemExit, match=r"they need --keep"):
        commands.score_all(given(tmp_path, "--first-run"))


def test_the_words_of_sections_claim_no_first_run_that_is_not_stored_as_one() -> None:
    runs = {run.section: run for run in every_run(RESULTS)}
    assert {name for name in runs if SECTIONS[name].startswith(UNMET)} <= {r.section for r in runs.values() if r.first}
    assert all(runs[name].first for name in FIRST_RUNS if name in runs)
