"""Canonical line labels, and errors a caller can act on."""

from __future__ import annotations

import pytest

from sim.core.errors import Diverged, Meaningless, Problem, SidebandError, SpecError, TooStiff, UnknownName
from sim.core.lines import Line


@pytest.mark.parametrize(
    ("orders", "label", "frequency"),
    [
        ((("f_o1", 2),), "2*f_o1", 200.0),
        ((("f_m", 1), ("f_r1", -1)), "1*f_m-1*f_r1", 660.0),
        ((("f_m", 1), ("f_r1", 0)), "1*f_m", 690.0),
        ((("f_r1", 1), ("f_m", -1)), "1*f_r1-1*f_m", 660.0),
    ],
)
def test_label_and_frequency(orders, label, frequency):
    line = Line(orders=orders, component="mesh1", mechanism="mesh", family="mesh")
    assert line.label == label
    assert line.frequency_hz({"f_o1": 100.0, "f_m": 690.0, "f_r1": 30.0}) == pytest.approx(frequency)


def test_errors_inherit_what_a_caller_expects():
    assert issubclass(SpecError, ValueError)
    assert issubclass(UnknownName, KeyError)
    assert issubclass(Diverged, ArithmeticError)
    assert all(issubclass(kind, SidebandError) for kind in (SpecError, UnknownName, Diverged, Meaningless, TooStiff))


def test_messages_say_what_to_change():
    problem = Problem(field="gears.0.teeth", message="too few", given=3, allowed="6 to 2000", unit="1")
    assert str(SpecError(problem)) == "gears.0.teeth: too few (given 3); allowed: 6 to 2000"
    assert problem.to_dict()["given"] == 3
    unknown = str(UnknownName("preset", "papper", ("paper",)))
    assert unknown == "unknown preset 'papper' (did you mean paper?); known: paper"
    assert "t = 0.25 s in ring.x" in str(Diverged(time_s=0.25, dof="ring.x", advice="shorten the step"))
