"""How rates stand against what is asked."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest

from proof.case import truth_of
from proof.plan import plan
from proof.score.one import Score, score
from proof.score.rates import Rate
from proof.targets import Target, cut_rows, written, wrong_rows

SINGLES = [json.loads(json.dumps(truth_of(c))) for c in plan("third") if c.group == "single"]


def right(truth: dict) -> dict:
    effect = truth["effects"][0]
    cause = {"term": effect["terms"][0], "site": effect["sites"][0], "severity": None, "named": True, "score": 9.0}
    return {"verdict": "explained", "causes": [cause]}


@pytest.mark.parametrize(
    ("least", "most", "hits", "n", "words"),
    [
        (0.95, None, 46, 93, "missed by 46 points"),
        (None, 0.05, 5, 93, "missed by 0.4 points, within the interval"),
        (None, 8 / 300, 1, 69, "held, though the interval reaches beyond"),
        (None, 0.05, 0, 200, "held"),
        (0.85, 0.95, 90, 100, "held, though the interval reaches beyond"),
        (0.85, 0.95, 99, 100, "missed by 4 points"),
        (0.85, 0.95, 900, 1000, "held"),
    ],
)
def test_a_rate_stands_against_its_target(
    least: float | None, most: float | None, hits: int, n: int, words: str
) -> None:
    target = Target(group="single", measure="place", words="", least=least, most=most)
    stands = target.standing(Rate(hits=hits, n=n))
    assert stands is not None and stands.text() == words


def test_nothing_stands_without_a_target_or_a_count() -> None:
    assert Target(group="double", measure="false_name", words="").standing(Rate(hits=0, n=43)) is None
    assert Target(group="double", measure="both", words="", least=0.7).standing(Rate(hits=0, n=0)) is None
    assert written(Rate(hits=0, n=0)) == "-"


def test_halved_distances_count_the_undetected_too() -> None:
    missed, halved, hopeless = (score(t, right(t)) for t in SINGLES[:3])
    found = [
        replace(missed, gain=None, ceiling=None),
        replace(halved, gain=0.6, ceiling=0.7),
        replace(hopeless, gain=0.2, ceiling=0.3),
    ]
    of_all, of_room = cut_rows(found)
    assert "1/3 = 33 %" in of_all and "1/1 = 100 %" in of_room


def test_wrong_names_are_counted_in_kind_and_place_and_where_nothing_is_hidden() -> None:
    elsewhere = right(SINGLES[1])
    elsewhere["causes"][0]["site"] = "nowhere"
    answers = (right(SINGLES[0]), elsewhere, {"verdict": "nothing_missing"})
    singles: list[Score] = [score(t, said) for t, said in zip(SINGLES, answers, strict=False)]
    healthy = next(c for c in plan("third") if c.group == "null")
    sound = score(json.loads(json.dumps(truth_of(healthy))), right(SINGLES[0]))
    strange = next(c for c in plan("third") if c.group == "open")
    named = score(json.loads(json.dumps(truth_of(strange))), right(SINGLES[0]))
    flagged = score(json.loads(json.dumps(truth_of(strange))), {"verdict": "unknown_physics"})
    one, nothing, unknown, every = wrong_rows([*singles, sound, named, flagged])
    assert "1/3" in one and "1/1" in nothing and "1/2" in unknown
    assert "3/4" in every, "the right one, and three that are wrong"
