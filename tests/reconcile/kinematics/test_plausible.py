"""Orders that no bearing has are refused with what one would have."""

from __future__ import annotations

from dataclasses import asdict

import numpy as np
import pytest

from reconcile.kinematics import read_kinematic_spec
from reconcile.kinematics.plausible import implausible, spin_of
from sim.core.errors import SpecError
from sim.parts.bearing import catalogue, defect_orders


@pytest.mark.parametrize(
    ("bpfo", "bpfi", "field", "told"),
    [
        (5.4, 3.5, "orders.bpfo", "exchanged"),
        (4.5, 4.5, "orders.bpfo", "not below bpfi"),
        (0.4, 0.6, "orders", "no number of balls"),
        (1.0, 40.0, "orders.bpfo", "do not fit"),
        (1e-6, 5.0, "orders.bpfo", "do not fit"),
        (107.4, 162.2, "orders", "not Hz"),
        (1e308, 1.7e308, "orders", "not Hz"),
    ],
)
def test_races_that_cannot_be(bpfo: float, bpfi: float, field: str, told: str) -> None:
    (problem,) = implausible("orders", bpfo, bpfi, None, None)
    assert problem.field == field and told in problem.message and problem.allowed and problem.given is not None


@pytest.mark.parametrize(
    ("bsf", "ftf", "field", "told"),
    [
        (0.1, None, "orders.bsf", "neither spin nor line"),
        (9.4, None, "orders.bsf", "neither spin nor line"),
        (None, 0.9, "orders.ftf", "cage"),
        (None, 25.0, "orders.ftf", "cage"),
    ],
)
def test_balls_and_cages_that_cannot_be(bsf: float | None, ftf: float | None, field: str, told: str) -> None:
    (problem,) = implausible("orders", 3.585, 5.415, bsf, ftf)
    assert problem.field == field and told in problem.message
    assert problem.given == (bsf if ftf is None else ftf) and problem.allowed


def test_those_of_an_outer_ring_that_turns_can() -> None:
    assert not list(implausible("orders", 3.585, 5.415, 2.357, 0.602))


def test_every_bearing_of_the_catalogue_can_also_with_rounded_orders() -> None:
    for row in catalogue().values():
        o = defect_orders(row.geometry())
        for digits in (1, 4):
            numbers = (round(x, digits) for x in (o.outer_pass, o.inner_pass, o.ball_spin, o.cage))
            assert not list(implausible("orders", *numbers)), asdict(row)


def test_the_refusal_names_the_field_of_the_document() -> None:
    bearing = {"name": "de", "shaft": "a", "orders": {"bpfo": 107.4, "bpfi": 162.2}}
    with pytest.raises(SpecError) as refused:
        read_kinematic_spec({"kinematics": {"shafts": [{"name": "a"}], "bearings": [bearing]}})
    assert [p.field for p in refused.value.problems] == ["kinematics.bearings.0.orders"]


@pytest.mark.parametrize("ratio", [0.1, 0.2035, 0.35])
@pytest.mark.parametrize("degrees", [0.0, 25.0, 45.0])
def test_a_ball_is_known_by_its_spin_or_by_its_line(ratio: float, degrees: float) -> None:
    cosine = float(np.cos(np.radians(degrees)))
    gamma = ratio * cosine
    races, spin = (4.5 * (1 - gamma), 4.5 * (1 + gamma)), cosine * (1 - gamma**2) / (2 * gamma)
    for stated in (spin, 2 * spin):
        assert not list(implausible("orders", *races, stated, None))
        assert spin_of(*races, stated) == pytest.approx(spin)
