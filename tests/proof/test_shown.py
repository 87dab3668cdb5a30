"""The tables of what there was to see."""

from __future__ import annotations

import json
from collections.abc import Sequence

from proof.case import truth_of
from proof.plan import plan
from proof.score.one import Score, score
from proof.shown import SEEN, all_rows, pair_rows, parting, seen_rows
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


def counts(rows: Sequence[str]) -> list[list[str]]:
    """The last two cells of a table's rows."""
    return [row.rsplit("|", 3)[1:3] for row in rows[2:-1]]


def test_single_effects_are_counted_by_what_there_is_to_see():
    found = scores(
        right(0), {"verdict": "nothing_missing"}, {"verdict": "unknown_physics"}, {"verdict": "nothing_missing"}
    )
    effects = dict(zip((s.name for s in found), (seen(6, 1), seen(0.2, 1), seen(2, 1), seen(3, 1)), strict=True))
    rows = seen_rows(found, effects)
    assert counts(rows) == [[" 0/1 ", " 0/1 "], [" 1/1 ", " 0/1 "], [" 1/2 ", " 1/2 "], [" 2/4 ", " 1/4 "]]
    assert [row.split("|")[1].strip() for row in rows[2:-1]] == [*(title for *_, title in SEEN), "all"]


def test_cases_that_were_not_measured_have_a_row_of_their_own():
    found = scores(right(0), right(1), {"verdict": "nothing_missing"})
    rows = seen_rows(found, {found[0].name: seen(0.5, 1)})
    none = [" 0/0 ", " 0/0 "]
    assert counts(rows) == [[" 1/1 ", " 1/1 "], none, none, [" 1/2 ", " 1/2 "], [" 2/3 ", " 2/3 "]]
    assert rows[-3].startswith("| not measured |")


def test_no_table_where_none_was_measured():
    assert seen_rows(scores(right(0), right(1)), {}) == []
    assert seen_rows([], {}) == []


def test_pairs_are_counted_by_the_fainter_of_the_two():
    pairs = [c for c in plan("third") if c.group == "double"][:2]
    found = [score(json.loads(json.dumps(truth_of(c))), {"verdict": "unknown_physics"}) for c in pairs]
    both = dict(zip((s.name for s in found), ((6.0, 0.5), (9.0, 4.0)), strict=True))
    parts = {name: Visible(effect_db=10, drift_db=1, new_share=0.0, parts_db=two) for name, two in both.items()}
    rows = pair_rows(found, parts)
    assert counts(rows) == [[" 1/1 ", " 0/1 "], [" 0/0 ", " 0/0 "], [" 1/1 ", " 0/1 "], [" 2/2 ", " 0/2 "]]
    assert pair_rows(found, {s.name: seen(1, 1) for s in found}) == [], "parts were not measured"


def test_what_no_library_has_is_counted_by_what_there_is_to_see():
    unknown = [c for c in plan("third") if c.group == "open"][:2]
    found = [
        score(json.loads(json.dumps(truth_of(c))), {"verdict": w})
        for c, w in zip(unknown, ("unknown_physics", "nothing_missing"), strict=True)
    ]
    pair = score(json.loads(json.dumps(truth_of(next(c for c in plan("third") if c.group == "double")))), None)
    effects = {found[0].name: seen(6, 1), found[1].name: seen(2, 1), pair.name: seen(1, 1)}
    rows = all_rows([*found, pair], effects)
    assert counts(rows) == [[" 0/0 ", " 0/0 "], [" 0/1 ", " 0/1 "], [" 1/1 ", " 1/1 "], [" 1/2 ", " 1/2 "]]
    assert rows[0].startswith("| an effect that no library has") and len(rows) == 7, "no part of the pair was measured"


def test_a_measure_parts_what_it_orders_and_not_what_is_tied():
    found = scores(right(0), {"verdict": "nothing_missing"}, {"verdict": "unknown_physics"})
    effects = dict(zip((s.name for s in found), (seen(6, 1), seen(0.2, 1), seen(9, 1)), strict=True))
    text = " ".join(parting(found, effects))
    assert (
        "a detected single effect lies above an undetected one in 100 % of all couples (50 % by the share of new bins)"
        in text
    )
    assert "a named one above an unnamed one in 50 % of all couples (50 %" in text
    assert parting(found[:1], effects) == [], "nothing to hold it against"
