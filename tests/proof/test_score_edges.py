"""Where a score turns: a share that is off by a hair's breadth must not be told from one that is right by luck."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import pytest

from proof.score.one import score
from proof.targets import wrong_rates
from tests.proof import test_score
from tests.proof.test_score import cause, right

truth = cache(test_score.truth)
"""Nothing here changes a case, and to plan all of them takes a while."""

VERDICTS = {
    "nothing_missing": False,
    "not_decidable": False,
    "explained": True,
    "ambiguous": True,
    "unknown_physics": True,
    "measurement_fault": True,
}
"""Of a machine on which nothing is hidden: whether the verdict sends somebody to look for what is not there."""


@pytest.mark.parametrize("group", ["null", "misset"])
@pytest.mark.parametrize(("verdict", "alarm"), VERDICTS.items())
def test_whatever_sends_somebody_to_a_sound_machine_is_an_alarm(group, verdict, alarm):
    assert score(truth(group), {"verdict": verdict}).alarm is alarm


@pytest.mark.parametrize(
    ("low", "high", "covered"),
    [(0.9, 1.1, True), (1.0, 1.1, True), (0.9, 1.0, True), (1.001, 1.2, False), (0.8, 0.999, False)],
)
def test_an_interval_covers_a_size_that_lies_between_its_ends(low, high, covered):
    case = truth("single", "loose_fit")
    (effect,) = case["effects"]
    size, name = effect["value"], effect["severity"]["name"]
    told = cause(effect["terms"][0], effect["sites"][0], size, name=name, low=low * size, high=high * size)
    assert score(case, {"verdict": "explained", "causes": [told]}).severity_covered is covered


def held_out(**changes):
    case = truth("single", "outer_pit")
    report = right(case)
    return score(case, report | {"held_out": report["held_out"] | changes})


@pytest.mark.parametrize(("gain", "beats"), [(0.401, True), (0.4, False), (0.399, False)])
def test_a_gain_is_held_against_its_rivals_own(gain, beats):
    assert held_out(gain=gain, black_box=0.4, retuned=0.1).beats_black_box is beats
    assert held_out(gain=gain, black_box=0.1, retuned=0.4).beats_retuned is beats


@pytest.mark.parametrize(("placebo", "improves"), [(0.04, False), (0.05, False), (0.06, True), (-0.5, False)])
def test_a_placebo_improves_from_a_twentieth_of_the_distance_on(placebo, improves):
    assert held_out(placebo=placebo).placebo_improves is improves


def test_a_set_that_holds_nothing_but_the_right_effect_names_neither_kind_nor_place():
    case = truth("single", "outer_pit")
    (effect,) = case["effects"]
    listed = [cause(effect["terms"][0], effect["sites"][0], named=False)]
    found = score(case, {"verdict": "ambiguous", "causes": listed})
    assert (found.mechanism, found.place) == (False, False)
    assert found.verdict_right and found.top_three


def test_a_name_on_a_case_that_no_library_has_is_wrong_whatever_is_scored_of_its_place():
    """Scores that are stored by an older engine, or of another kind of case, may hold no place."""
    named = score(truth("open"), {"verdict": "explained", "causes": [cause("unbalance", "gear")]})
    told = [replace(named, place=place) for place in (None, False, True)]
    *_, of_open, of_all = wrong_rates([*told, score(truth("open"), {"verdict": "unknown_physics"})])
    assert (of_open.hits, of_open.n) == (3, 4)
    assert (of_all.hits, of_all.n) == (3, 3)
