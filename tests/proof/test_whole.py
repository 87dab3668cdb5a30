"""All stored first runs together: every target is told, and all tables add up to the same."""

from __future__ import annotations

import json
from dataclasses import asdict, replace
from pathlib import Path

import pytest

from proof import page
from proof.case import truth_of
from proof.library import CLOSED
from proof.plan import plan
from proof.said import FIRST_RUNS, HISTORY
from proof.score.one import Score, score
from proof.score.rates import MEASURES, at_target, rate
from proof.targets import CUT_WORDS, TARGETS, WRONG_WORDS, written
from proof.visible import Visible
from proof.whole import LAWS, by_law, first_runs, history, measured, of_what_shows, said_of, together, whole_rows

RESULTS = Path(page.__file__).parent / "results"


def scores(*verdicts: str, group: str = "single") -> list[Score]:
    cases = [c for c in plan("third") if c.group == group]
    truths = [json.loads(json.dumps(truth_of(c))) for c in cases]
    return [score(truth, {"verdict": verdict}) for truth, verdict in zip(truths, verdicts, strict=False)]


def cells(row: str) -> list[str]:
    return [cell.strip() for cell in row.strip("|").split("|")]


@pytest.fixture(scope="module")
def kept() -> list[Score]:
    return first_runs(RESULTS)


def test_every_target_is_in_the_aggregate_at_both_kinds_of_condition(kept: list[Score]) -> None:
    told = {cells(row)[0]: cells(row)[1:] for row in together(kept).splitlines() if row.startswith("|")}
    columns = [s for s in kept if at_target(s)], kept
    for target in TARGETS:
        found = [rate([s for s in c if s.group == target.group], MEASURES[target.measure]) for c in columns]
        assert told[target.words][:2] == [written(found[0]), written(found[1])]
    assert {*CUT_WORDS, *WRONG_WORDS} <= set(told)
    for word in ("severity error, median", "its 90th percentile", "held-out gain", "core-seconds", "cases that took"):
        assert any(key.startswith(word) for key in told), word


def test_each_first_run_counts_once(kept: list[Score]) -> None:
    names = [s.name for s in kept]
    assert names and len(set(names)) == len(names)


def test_laws_add_up_to_the_aggregate(kept: list[Score]) -> None:
    rows = [cells(row) for row in by_law(kept) if row.startswith("| ") and not row.startswith("| effect")]
    *laws, every = rows
    single = [s for s in kept if at_target(s) and s.group == "single"]
    wanted = [rate(single, MEASURES[m]) for m in ("alarm", "mechanism", "place")]
    assert [int(every[1]), *(cell for cell in every[2:])] == [len(single), *(f"{r.hits}/{r.n}" for r in wanted)]
    assert sum(int(row[1]) for row in laws) == len(single)
    for column, found in enumerate(wanted, 2):
        assert [sum(int(row[column].split("/")[k]) for row in laws) for k in (0, 1)] == [found.hits, found.n]


def test_what_is_named_without_pits_and_what_never_is_follows_from_the_table(kept: list[Score]) -> None:
    table = by_law(kept)
    laws = {row.split("`")[1]: cells(row) for row in table if "`" in row}
    others = [row for law, row in laws.items() if not law.endswith("_pit")]
    named, n = (sum(int(row[4].split("/")[k]) for row in others) for k in (0, 1))
    text = " ".join(table[table.index("") :])
    assert f"Without the pits of bearings {named}/{n} = " in text
    never, absent = text.partition("Named in no case:")[2].split("Hidden in no case:")
    for law, row in laws.items():
        assert (f"{LAWS[law]} ({row[1]})" in never) == row[3].startswith("0/")
        assert LAWS[law] not in absent


def test_tables_of_what_shows_hold_every_case(kept: list[Score]) -> None:
    text = of_what_shows(kept, measured(RESULTS))
    tables = [t.splitlines() for t in text.split("\n\n") if t.startswith("|")]
    at = [s for s in kept if at_target(s)]
    for table, group, measure in zip(
        tables, ("single", "double", "open"), ("place", "both", "unknown_flagged"), strict=True
    ):
        found = rate([s for s in at if s.group == group], MEASURES[measure])
        *ranges, every = (cells(row)[2].split("/") for row in table[2:])
        assert [int(n) for n in every] == [found.hits, found.n]
        assert [sum(int(r[k]) for r in ranges) for k in (0, 1)] == [found.hits, found.n]


def test_all_first_runs_at_the_target_condition_are_measured(kept: list[Score]) -> None:
    assert "not measured" not in of_what_shows(kept, measured(RESULTS))


def test_the_history_adds_up_to_the_aggregate(kept: list[Score]) -> None:
    named = [cells(row)[2].split(" of ") for row in history(RESULTS).splitlines()]
    single = rate([s for s in kept if at_target(s) and s.group == "single"], MEASURES["place"])
    assert [sum(int(n[k]) for n in named) for k in (0, 1)] == [single.hits, single.n]
    assert set(HISTORY) <= set(FIRST_RUNS)


def test_every_law_has_words_of_its_own() -> None:
    assert set(LAWS) == set(CLOSED) and len(set(LAWS.values())) == len(LAWS)


def test_what_is_missed_is_said_with_by_how_much() -> None:
    found = [*scores("unknown_physics", "nothing_missing"), *scores("nothing_missing", "nothing_missing", group="null")]
    found[0] = replace(found[0], severity_error=0.35, core_seconds=130.0)
    text = " ".join(together(found).split("\n\n", 1)[1].split())
    missed, held = text.split("Held are:")
    assert "mechanism right at least 95 % (by 95 points)" in missed
    assert "severity error, median at most 0.1 (by 0.25)" in missed and "(in 1 of 1)" in missed
    assert "false alarms on nulls at most 8/300" in held and "false alarms" not in missed
    stands = {row.words: row.stands for row in whole_rows(found)}
    assert stands["a name beside the pair's"] is None


def test_first_runs_are_counted_together(tmp_path: Path) -> None:
    for section, verdicts in (("third", ("unknown_physics",)), ("fourth", ("unknown_physics", "nothing_missing"))):
        stored = {"engine": section, "scores": [asdict(s) for s in scores(*verdicts)]}
        (tmp_path / f"{section}.json").write_text(json.dumps(stored), encoding="utf-8")
    said = said_of(tmp_path)
    (row,) = [row for row in str(said["together"]).splitlines() if row.startswith("| false unknowns")]
    assert row.count("2/3 = 67 %") == 2
    assert said["versions"] == 2 and said["n_first"] == 3
    name = scores("unknown_physics")[0].name
    seen = {name: asdict(Visible(effect_db=6.0, drift_db=1.0, new_share=0.0))}
    (tmp_path / "visible-third.json").write_text(json.dumps(seen), encoding="utf-8")
    table = of_what_shows(first_runs(tmp_path), measured(tmp_path)).splitlines()
    assert "| more than three times as far | 2/2 | 0/2 |" in table and "| not measured | 0/1 | 0/1 |" in table
