"""Operators of a step are made once for machines of one linear part, and are what they would be made anew."""

from __future__ import annotations

import numpy as np

from sim.assembly.assemble import assemble
from sim.core.spec import TermSpec
from sim.core.system import System
from sim.presets import preset
from sim.solve import operators
from sim.solve.collocation import collocation
from sim.solve.operators import StepOperators, coordinates, step_operators

RULE = collocation(3)


def rig(change_m: float, stiffness: float = 1.0) -> System:
    machine = preset("paper-lightly-damped")
    term = TermSpec(term="radial_clearance", site="bearing1", parameters={"change": change_m})
    first, *rest = machine.bearings
    x = stiffness * first.support.stiffness_x_n_per_m
    support = first.support.model_copy(update={"stiffness_x_n_per_m": x})
    bearings = [first.model_copy(update={"support": support}), *rest]
    return assemble(machine.model_copy(update={"terms": (*machine.terms, term), "bearings": bearings}))


def of(system: System, h: float = 1e-5) -> tuple[StepOperators, ...]:
    return step_operators(system, coordinates(system), RULE, h, 2)


def test_machines_that_differ_in_a_contact_share_them() -> None:
    assert of(rig(1e-6)) is of(rig(2e-6))


def test_another_stiffness_or_step_has_its_own() -> None:
    system = rig(1e-6)
    assert not np.array_equal(of(system)[0].end_state, of(rig(1e-6, stiffness=2.0))[0].end_state)
    assert [level.h for level in of(system, 2e-5)] == [2e-5, 1e-5]


def test_kept_ones_are_those_made_anew() -> None:
    kept = of(rig(1e-6))
    operators._step_operators.cache_clear()
    anew = of(rig(2e-6))
    for before, after in zip(kept, anew, strict=True):
        assert before is not after
        for name in ("node_state", "node_force", "node_load", "end_state", "end_force", "end_load"):
            np.testing.assert_array_equal(getattr(before, name), getattr(after, name))
