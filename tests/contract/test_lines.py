"""Predicted lines do appear: each registered effect is simulated where it shows, with and without."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import pytest

from sim.assembly.assemble import assemble
from sim.core.lines import Line
from sim.core.spec import MachineSpec, TermSpec
from sim.core.terms import Term
from sim.presets import preset
from sim.terms import REGISTRY
from sim.terms.unbalance import TERM as UNBALANCE
from tests.contract.shown import BASE, demo_machines, promised, shown

ALL = [pytest.param(term, id=term.key) for term in REGISTRY]


def promises(term: Term) -> list[Line]:
    return _promised(term.key)


@cache
def _promised(key: str) -> list[Line]:
    term = REGISTRY.get(key)
    assert term is not None
    machine, plain = demo_machines(term)
    return promised(term, assemble(machine), assemble(plain))


@pytest.mark.parametrize("term", ALL)
def test_its_demonstration_is_a_machine_it_may_act_in(term):
    machine, plain = demo_machines(term)
    assert not term.idle(term.values(term.demo.values, "demo"))
    assert (machine == plain) == (term.key in BASE)


@pytest.mark.slow
@pytest.mark.parametrize("term", ALL)
def test_a_term_that_declares_lines_has_some_to_show(term):
    assert promises(term) or type(term).lines is Term.lines


@pytest.mark.slow
@pytest.mark.parametrize("term", ALL)
def test_predicted_lines_appear_in_the_spectrum(term):
    machine, plain = demo_machines(term)
    predicted = promises(term)
    found = shown(term, predicted, machine, plain) if predicted else []
    assert bool(found) == bool(predicted)
    assert all(line.plain for line in found), [line for line in found if not line.plain]


@pytest.mark.slow
def test_lines_that_nothing_excites_do_not_pass():
    plain = preset("paper-lightly-damped")
    machine = plain.model_copy(update={"terms": [TermSpec(term="unbalance", site="pinion")]})
    true = [line for line in assemble(machine).lines if line.mechanism == UNBALANCE.key]
    boasts = [replace(true[0], orders=orders) for orders in ((("f_i1", 1),), (("f_m", 2), ("f_r2", 1)))]
    assert [line.plain for line in shown(UNBALANCE, [*true, *boasts], machine, plain)] == [True, False, False]


def fast_rotor(speed_hz: float, moment: float, *more: TermSpec) -> MachineSpec:
    """The rotor, whose lowest modes are at 234 and 259 Hz, at two to three times that, with unbalance."""
    rotor = preset("rotor")
    assert rotor.operating is not None
    unbalance = TermSpec(term="unbalance", site="disc", parameters={"moment": moment})
    operating = rotor.operating.model_copy(update={"speed_hz": speed_hz})
    return rotor.model_copy(update={"operating": operating, "terms": [unbalance, *more]})


LOOSE = [
    TermSpec(term="pedestal_looseness", site=site, parameters={"loss": 0.8, "lift": 0.0})
    for site in ("bearing1", "bearing2")
]
RUB = TermSpec(
    term="rub", site="disc", parameters={"gap": 4e-6, "stiffness": 5e7, "friction": 0.05, "radius": 0.02, "loss": 0.5}
)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("key", "speed_hz", "moment", "terms", "expected"),
    [
        ("pedestal_looseness", 650.0, 3e-5, LOOSE, {"1/2*f_r1", "3/2*f_r1"}),
        ("rub", 800.0, 5e-6, [RUB], {"1/2*f_r1", "3/2*f_r1"}),
        ("rub", 700.0, 1.5e-5, [RUB], {"1/3*f_r1", "2/3*f_r1"}),
    ],
)
def test_fractional_orders_appear_at_two_and_three_times_the_natural_frequency(key, speed_hz, moment, terms, expected):
    """A rotor that lifts off or touches every second or third turn only; without the effect there is no such line."""
    machine, plain = fast_rotor(speed_hz, moment, *terms), fast_rotor(speed_hz, moment)
    lines = [x for x in assemble(machine).lines if x.mechanism == key and "/" in x.label]
    found = {line.label: line.plain for line in shown(REGISTRY.get(key), lines, machine, plain)}
    assert expected <= {label for label, plain_to_see in found.items() if plain_to_see}


@pytest.mark.slow
@pytest.mark.parametrize("terms", [LOOSE, [RUB]], ids=["looseness", "rub"])
def test_slow_rotors_answer_every_turn(terms):
    """Far below twice the natural frequency no fraction is excited: not in so long that the start-up weighs nothing."""
    machine, plain = fast_rotor(300.0, 5e-6, *terms), fast_rotor(300.0, 5e-6)
    lines = [x for x in assemble(machine).lines if x.mechanism == terms[0].term and "/" in x.label]
    assert not [x for x in shown(REGISTRY.get(terms[0].term), lines, machine, plain, span_s=2.0) if x.plain]
