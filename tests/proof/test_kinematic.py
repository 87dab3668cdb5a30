"""Cases told by drawings alone: what the engine is given, and what its answers are worth."""

from __future__ import annotations

import pytest

from proof.case import told
from proof.kinematic import answer, kinematics, told_table
from proof.machine import document
from proof.plan import plan
from reconcile.kinematics import read_kinematic_spec
from reconcile.kinematics.families import ties

PIT = {"law": "inner_pit", "sites": ["bearing1"]}
LOOSE = {"law": "loose_seat", "sites": ["bearing2"]}


def truth(*effects, fault=None):  # type: ignore[no-untyped-def]
    return {"effects": list(effects), "fault": fault}


def report(verdict, *causes):  # type: ignore[no-untyped-def]
    return {"verdict": verdict, "causes": [{"term": t, "site": s, "named": named} for t, s, named in causes]}


RIGHT, OTHER = ("inner_spall", "bearing1"), ("inner_spall", "bearing2")


def test_the_engine_reads_what_it_is_given_and_gets_drawings_only() -> None:
    given = kinematics(document(told(plan("dev")[0])))
    found = ties(read_kinematic_spec(given), "input")
    assert set(given) == {"kinematics"}
    assert found.mesh_orders == pytest.approx((23.0,))
    assert found.shafts["output"] == pytest.approx(23 / 81)
    assert {f.site for f in found.families if f.kind == "outer"} == {f"bearing{k}" for k in (1, 2, 3, 4)}


@pytest.mark.parametrize(
    ("hidden", "said", "worth"),
    [
        (truth(PIT), report("explained", (*RIGHT, True)), "named with its place"),
        (truth(PIT), report("explained", (*RIGHT, True), (*OTHER, True)), "a wrong name"),
        (truth(PIT), report("explained", (*OTHER, True), (*RIGHT, False)), "a wrong name"),
        (truth(PIT), report("ambiguous", (*OTHER, False), (*RIGHT, False)), "in the set"),
        (truth(PIT), report("explained", (*OTHER, True)), "other (explained)"),
        (truth(PIT), report("nothing_missing"), "quiet"),
        (truth(LOOSE), report("ambiguous", ("rub", "output", False)), "other (ambiguous)"),
        (truth(), report("not_decidable"), "quiet"),
        (truth(), report("ambiguous", (*RIGHT, False)), "other (ambiguous)"),
        (truth(fault="clipping"), report("measurement_fault"), "fault of the measurement"),
        (truth(fault="clipping"), report("explained", (*RIGHT, True)), "other (explained)"),
        (truth(PIT), None, "failed"),
    ],
)
def test_what_an_answer_is_worth(hidden, said, worth) -> None:  # type: ignore[no-untyped-def]
    assert answer(hidden, said) == worth


def test_the_table_counts_every_case() -> None:
    quiet = report("nothing_missing")
    cases = [(truth(), quiet), (truth(), report("ambiguous")), (truth(PIT, LOOSE), quiet), (truth(LOOSE), quiet)]
    assert told_table(cases).splitlines()[2:] == [
        "| a pit and more | 1 | quiet 1 |",
        "| nothing | 2 | quiet 1, other (ambiguous) 1 |",
        "| other effects | 1 | quiet 1 |",
    ]
