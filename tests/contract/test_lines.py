"""Predicted lines do appear: each registered effect is simulated where it shows, with and without."""

from __future__ import annotations

from dataclasses import replace

import pytest

from sim.assembly.assemble import assemble
from sim.core.lines import Line
from sim.core.terms import Term
from sim.terms import REGISTRY
from sim.terms.unbalance import TERM as UNBALANCE
from tests.contract.shown import BASE, demo_machines, promised, shown

ALL = [pytest.param(term, id=term.key) for term in REGISTRY]


def promises(term: Term) -> list[Line]:
    machine, plain = demo_machines(term)
    return promised(term, assemble(machine), assemble(plain))


@pytest.mark.parametrize("term", ALL)
def test_its_demonstration_is_a_machine_it_may_act_in(term):
    machine, plain = demo_machines(term)
    assert not term.idle(term.values(term.demo.values, "demo"))
    assert (machine == plain) == (term.key in BASE)


@pytest.mark.parametrize("term", ALL)
def test_a_term_that_declares_lines_has_some_to_show(term):
    assert promises(term) or type(term).lines is Term.lines


SHOWING = [p for p in ALL if promises(p.values[0])]


@pytest.mark.slow
@pytest.mark.parametrize("term", SHOWING)
def test_predicted_lines_appear_in_the_spectrum(term):
    machine, plain = demo_machines(term)
    found = shown(term, promises(term), machine, plain)
    assert found
    assert all(line.plain for line in found), [line for line in found if not line.plain]


@pytest.mark.slow
def test_lines_that_nothing_excites_do_not_pass():
    machine, plain = demo_machines(UNBALANCE)
    true = promises(UNBALANCE)
    boasts = [replace(true[0], orders=orders) for orders in ((("f_i1", 1),), (("f_m", 2), ("f_r2", 1)))]
    assert [line.plain for line in shown(UNBALANCE, [*true, *boasts], machine, plain)] == [True, False, False]
