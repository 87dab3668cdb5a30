"""The page's table of what there was to see."""

from __future__ import annotations

import json
from dataclasses import asdict, replace
from pathlib import Path

from proof.case import truth_of
from proof.page import cut_rows, of_what_shows, together, wrong_rows
from proof.plan import plan
from proof.score.one import Score, score
from proof.shown import SEEN, all_rows, pair_rows, seen_rows
from proof.visible import Visible


def scores(*reports: dict | None) -> list[Score]:
    singles = [c for c in plan("third") if c.group == "single"]
    return [score(json.loads(json.dumps(truth_of(c))), report) for c, report in zip(singles, reports, strict=False)]


def seen(effect_db: float, drift_db: float) -> Visible:
    return Visible(effect_db=effect_db, drift_db=drift_db, new_share=0.0)


def right(number: int) -> dict:
    truth = json.loads(json.dumps(truth_of([c for c in plan("third") if c.group == "single"][number])))
    effect = truth["effects"][0]
    cause = {"term": effect["terms"][0], "site": effect["sites"][0], "severity": None, "named": True, "score": 9.0}
    return {"verdict": "explained", "causes": [cause]}


def test_single_effects_are_counted_by_what_there_is_to_see():
    found = scores(
        right(0), {"verdict": "nothing_missing"}, {"verdict": "unknown_physics"}, {"verdict": "nothing_missing"}
    )
    effects = dict(zip((s.name for s in found), (seen(6, 1), seen(0.2, 1), seen(2, 1), seen(3, 1)), strict=True))
    rows = seen_rows(found, effects)
    assert [row.rsplit("|", 3)[1:3] for row in rows[2:-1]] == [
        [" 0/1 ", " 0/1 "],
        [" 1/1 ", " 0/1 "],
        [" 1/2 ", " 1/2 "],
    ]
    assert [row.split("|")[1].strip() for row in rows[2:-1]] == [title for *_, title in SEEN]


def test_no_table_where_not_all_were_measured():
    found = scores(right(0), right(1))
    assert seen_rows(found, {found[0].name: seen(1, 1)}) == []
    assert seen_rows([], {}) == []


def test_pairs_are_counted_by_the_fainter_of_the_two():
    pairs = [c for c in plan("third") if c.group == "double"][:2]
    found = [score(json.loads(json.dumps(truth_of(c))), {"verdict": "unknown_physics"}) for c in pairs]
    both = dict(zip((s.name for s in found), ((6.0, 0.5), (9.0, 4.0)), strict=True))
    parts = {name: Visible(effect_db=10, drift_db=1, new_share=0.0, parts_db=two) for name, two in both.items()}
    rows = pair_rows(found, parts)
    assert [row.rsplit("|", 3)[1:3] for row in rows[2:-1]] == [
        [" 1/1 ", " 0/1 "],
        [" 0/0 ", " 0/0 "],
        [" 1/1 ", " 0/1 "],
    ]
    assert pair_rows(found, {s.name: seen(1, 1) for s in found}) == [], "parts were not measured"


def test_halved_distances_count_the_undetected_too():
    missed, halved, hopeless = scores(right(0), right(1), right(2))
    found = [
        replace(missed, gain=None, ceiling=None),
        replace(halved, gain=0.6, ceiling=0.7),
        replace(hopeless, gain=0.2, ceiling=0.3),
    ]
    of_all, of_room = cut_rows(found)
    assert "1/3 = 33 %" in of_all and "1/1 = 100 %" in of_room


def test_wrong_names_are_counted_in_kind_and_place_and_where_nothing_is_hidden():
    elsewhere = right(1)
    elsewhere["causes"][0]["site"] = "nowhere"
    healthy = next(c for c in plan("third") if c.group == "null")
    sound = [score(json.loads(json.dumps(truth_of(healthy))), right(0))]
    one, nothing = wrong_rows([*scores(right(0), elsewhere, {"verdict": "nothing_missing"}), *sound])
    assert "1/3" in one and "1/1" in nothing


def test_first_runs_are_counted_together(tmp_path: Path):
    for section, found in (("third", scores(right(0))), ("fourth", scores(right(0), {"verdict": "unknown_physics"}))):
        kept = {"scores": [asdict(s) for s in found]}
        (tmp_path / f"{section}.json").write_text(json.dumps(kept), encoding="utf-8")
    (row,) = [row for row in together(tmp_path).splitlines() if "with place" in row]
    assert row.count("2/3 = 67 %") == 2
    name = scores(right(0))[0].name
    (tmp_path / "visible-third.json").write_text(json.dumps({name: asdict(seen(6, 1))}), encoding="utf-8")
    table = of_what_shows(tmp_path).splitlines()
    assert (
        "| more than three times as far | 2/2 | 2/2 |" in table and len([r for r in table if r.startswith("| ")]) == 4
    )


def test_what_no_library_has_is_counted_by_what_there_is_to_see():
    unknown = [c for c in plan("third") if c.group == "open"][:2]
    found = [
        score(json.loads(json.dumps(truth_of(c))), {"verdict": w})
        for c, w in zip(unknown, ("unknown_physics", "nothing_missing"), strict=True)
    ]
    pair = score(json.loads(json.dumps(truth_of(next(c for c in plan("third") if c.group == "double")))), None)
    effects = {found[0].name: seen(6, 1), found[1].name: seen(2, 1), pair.name: seen(1, 1)}
    rows = all_rows([*found, pair], effects)
    assert [row.rsplit("|", 3)[1:3] for row in rows[2:-1]] == [
        [" 0/0 ", " 0/0 "],
        [" 0/1 ", " 0/1 "],
        [" 1/1 ", " 1/1 "],
    ]
    assert rows[0].startswith("| an effect that no library has") and len(rows) == 6, "no part of the pair was measured"
