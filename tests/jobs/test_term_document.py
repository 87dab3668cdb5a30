"""Effects as documents: complete, plain JSON, and lines that agree with the assembled machine's."""

from __future__ import annotations

import json

import pytest

from jobs.demonstration import demonstration, predicted
from jobs.term_document import term_document
from sim.assembly.assemble import BUILT_IN, assemble, predicted_lines
from sim.terms import REGISTRY
from sim.terms.cage_slip import TERM as CAGE_SLIP
from sim.terms.unbalance import TERM as UNBALANCE
from tests.strategies.systems import every_term_machine

ALL = [pytest.param(term, id=term.key) for term in REGISTRY]


@pytest.mark.parametrize("term", ALL)
def test_documents_are_complete_and_plain(term):
    document = term_document(term)
    assert json.loads(json.dumps(document, allow_nan=False))["key"] == term.key
    assert {p["name"] for p in document["parameters"]} == set(document["demo"]["values"])
    assert document["page"] == f"docs/physics/{term.key}.md"
    assert (document["demo"]["site"] == "") == (term.key in BUILT_IN)
    assert all(line["frequency_hz"] >= 0 and line["orders"] for line in document["predicted_lines"])


@pytest.mark.slow
@pytest.mark.parametrize("term", ALL)
def test_lines_without_tables_are_those_of_the_assembled_machine(term):
    machine = demonstration(term).machine
    system = assemble(machine)
    lines, bases = predicted_lines(machine)
    assert lines == system.lines
    assert bases == system.bases_hz


def test_lines_of_one_of_everything_are_those_of_the_assembled_machine():
    system = assemble(every_term_machine(), seed=3)
    assert predicted_lines(every_term_machine(), seed=3) == (system.lines, system.bases_hz)


def test_unbalance_turns_with_its_shaft():
    ((line, hz),) = predicted(UNBALANCE, demonstration(UNBALANCE))
    operating = demonstration(UNBALANCE).machine.operating
    assert (line.label, hz) == ("1*f_r1", operating.speed_hz)


def test_an_effect_that_moves_a_rate_predicts_the_lines_that_move():
    shown = demonstration(CAGE_SLIP)
    line, hz = predicted(CAGE_SLIP, shown)[0]
    slip = shown.values["share"]
    assert line.label == "1*f_o1" and 0 < slip < 1
    assert hz == pytest.approx((1 - slip) * predicted_lines(shown.without)[1]["f_o1"], rel=1e-12)
