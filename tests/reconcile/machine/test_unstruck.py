"""Pits that fit best and strike nowhere are no known effect."""

from dataclasses import replace
from types import SimpleNamespace

import pytest

from reconcile.machine.decide import Decision
from reconcile.machine.decided import decided
from reconcile.machine.direct import NOTHING, UNHEARD
from reconcile.machine.unstruck import BEHIND, CLEAR, SILENT, TOO_FAINT, unless_silent
from tests.reconcile.machine.screens import screen

PITS = ("inner_spall@bearing4", "ball_spall@bearing4")
DECISION = Decision(word="ambiguous", chosen=PITS, p=1e-6, reasons=("alike",))
LOOKED = replace(NOTHING, looked=True)


def after(decision=DECISION, direct=LOOKED, evidence=CLEAR, points=3, views=9, behind=0.0):
    told = {name: evidence - behind * (name not in PITS) for name in decision.chosen}
    return unless_silent(decision, direct, told, points=points, views=views)


def test_pits_that_are_not_heard_are_no_answer():
    assert after().word == "unknown_physics"
    assert after().chosen == PITS
    assert after().reasons == (SILENT,)
    assert after(replace(DECISION, word="explained", chosen=PITS[:1])).word == "unknown_physics"


def test_a_faint_change_does_not_exclude_a_pit_that_is_not_heard():
    told = after(evidence=CLEAR - 0.1)
    assert (told.word, told.chosen, told.reasons) == ("ambiguous", PITS, ("alike", TOO_FAINT))
    one = replace(DECISION, word="explained", chosen=PITS[:1], reasons=("a part of the change is left",))
    named = after(one, evidence=CLEAR - 0.1)
    assert (named.word, named.chosen, named.reasons) == ("not_decidable", PITS[:1], (TOO_FAINT,))


def test_a_pit_that_has_grown_strikes_before_and_after():
    assert after(direct=replace(LOOKED, present=frozenset(PITS[:1]))) is DECISION


def test_the_decision_asks_who_is_heard():
    pit = "inner_spall@bearing1"
    seen = screen([0.0, 0.0, 30.0], p_any=1e-6, p_best=1e-6, strongest=20.0)
    setting = SimpleNamespace(
        channels=("a", "b", "c"),
        data=(0, 0, 0),
        changes=SimpleNamespace(with_baseline=True),
        direct=LOOKED,
        machine=SimpleNamespace(gears=()),
    )
    told = decided(setting, SimpleNamespace(screen=seen))  # type: ignore[arg-type]
    assert (told.word, told.chosen, told.reasons) == ("unknown_physics", (pit,), (SILENT,))
    setting.direct = replace(LOOKED, evidence={pit: 8.0})
    assert decided(setting, SimpleNamespace(screen=seen)).word == "explained"  # type: ignore[arg-type]


@pytest.mark.parametrize("evidence", [UNHEARD, 8.0, -20.0])
def test_what_is_heard_or_ruled_out_by_another_part_is_no_matter_of_silence(evidence):
    assert after(direct=replace(LOOKED, evidence={PITS[0]: evidence})) is DECISION


@pytest.mark.parametrize(
    ("points", "views", "direct"), [(1, 9, LOOKED), (2, 2, LOOKED), (3, 9, NOTHING)], ids=["point", "views", "unlooked"]
)
def test_where_little_is_heard_silence_says_nothing(points, views, direct):
    assert after(points=points, views=views, direct=direct) is DECISION


@pytest.mark.parametrize("also", ["unbalance@pinion", "tooth_crack@pinion", "no_such_effect@pinion"])
def test_a_set_with_something_else_stays(also):
    decision = replace(DECISION, chosen=(*PITS, also))
    assert after(decision) is decision


def test_a_set_with_something_far_behind_is_one_of_pits():
    """Knocks near a bearing fitted its pits with 31 and more play of it with 4.5."""
    decision = replace(DECISION, chosen=(*PITS, "radial_clearance@bearing4"))
    told = after(decision, evidence=31.0, behind=27.0)
    assert (told.word, told.chosen) == ("unknown_physics", decision.chosen[:3])
    assert after(decision, evidence=31.0, behind=BEHIND - 0.1) is decision


@pytest.mark.parametrize("word", ["nothing_missing", "not_decidable", "unknown_physics"])
def test_other_answers_stay(word):
    decision = replace(DECISION, word=word)
    assert after(decision) is decision
