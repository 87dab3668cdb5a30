"""Lines of effects that follow a shaft are found where they are predicted, at two speeds."""

from __future__ import annotations

import pytest

from sim.assembly.assemble import assemble
from sim.terms import REGISTRY
from tests.contract.shown import demo_machines, promised, shown

KEYS = (
    "unbalance",
    "bent_shaft",
    "parallel_misalignment",
    "angular_misalignment",
    "torque_ripple",
    "shaft_crack",
    "pedestal_looseness",
    "rub",
)


def turning_at(machine, hz):
    """The machine at another speed, its unbalances such that their forces stay what they were."""
    faster = machine.operating.speed_hz / hz
    terms = [_scaled(term, faster**2) if term.term == "unbalance" else term for term in machine.terms]
    operating = machine.operating.model_copy(update={"speed_hz": hz})
    return machine.model_copy(update={"operating": operating, "terms": terms})


def _scaled(term, factor):
    moment = term.parameters["moment"] * factor
    return term.model_copy(update={"parameters": {**term.parameters, "moment": moment}})


@pytest.mark.slow
@pytest.mark.parametrize("speed_hz", [27.0, 40.0])
@pytest.mark.parametrize("key", KEYS)
def test_line_at_its_speed(key, speed_hz):
    term = REGISTRY.get(key)
    with_term, plain = (turning_at(m, speed_hz) for m in demo_machines(term))
    lines = promised(term, assemble(with_term), assemble(plain))[:1]
    assert lines[0].frequency_hz(assemble(with_term).bases_hz) % speed_hz == pytest.approx(0.0, abs=1e-9)
    found = shown(term, lines, with_term, plain)
    assert all(line.plain for line in found), found
