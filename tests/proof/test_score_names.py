"""What counts as a wrong name, and as one in a wrong place."""

from __future__ import annotations

from proof.score.one import score
from tests.proof.test_score import cause, right, truth


def test_a_name_beside_the_right_one_is_wrong_and_a_set_names_no_pair():
    case = truth("single", "outer_pit")
    report = right(case)
    assert score(case, report).verdict_right and score(case, report).false_name is False
    report["causes"] = [*report["causes"], cause("rub", "gear")]
    found = score(case, report)
    assert not found.verdict_right and found.false_name and not found.mechanism and not found.place
    pair = truth("double")
    listed = [cause(e["terms"][0], e["sites"][0], named=False) for e in pair["effects"]]
    assert score(pair, {"verdict": "ambiguous", "causes": listed}).both is False
    assert score(pair, right(pair)).both is True
    beside = right(pair)
    beside["causes"] = [*beside["causes"], cause("squeeze_film", "bearing4")]
    assert score(pair, beside).both is False


def test_the_right_effect_named_at_a_wrong_place_too_is_wrong_in_place_alone():
    case = truth("single", "outer_pit")
    report = right(case)
    (named,) = report["causes"]
    report["causes"] = [named, {**named, "site": "nowhere"}]
    found = score(case, report)
    assert found.mechanism and found.false_name and not found.place and not found.verdict_right
    pair = truth("double")
    report = right(pair)
    report["causes"] = [report["causes"][0], {**report["causes"][1], "site": "nowhere"}]
    found = score(pair, report)
    assert found.false_name and found.both is False
