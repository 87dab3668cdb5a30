"""When a sensor's fault is the answer, and when a revised machine is given."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from reconcile.machine.answer import _doubtful, _machine
from reconcile.machine.decide import Decision
from reconcile.verdict import SensorFault, Word
from sim.presets import preset


@pytest.mark.parametrize(
    ("kind", "points", "word", "doubtful"),
    [
        ("loose_sensor", 1, "nothing_missing", True),
        ("loose_sensor", 3, "nothing_missing", False),
        ("loose_sensor", 1, "not_decidable", False),
        ("gain_change", 1, "nothing_missing", False),
    ],
)
def test_a_loose_sensor_at_one_point_is_no_answer_where_nothing_else_is_unusual(
    kind: str, points: int, word: str, doubtful: bool
) -> None:
    gate = SimpleNamespace(fault=SensorFault(kind=kind, channel="a", detail="its transfer changed"))  # type: ignore[arg-type]
    setting = SimpleNamespace(data=[None] * points)
    assert _doubtful(gate, setting, word) is doubtful  # type: ignore[arg-type]


@pytest.mark.parametrize(("word", "given"), [("explained", True), ("ambiguous", True), ("unknown_physics", False)])
def test_a_machine_is_given_only_with_an_effect_that_is_claimed(word: Word, given: bool) -> None:
    revision = SimpleNamespace(machine=preset("paper-lightly-damped"))
    decision = Decision(word=word, chosen=("rub@gear",), p=1e-4, reasons=())
    assert (_machine(revision, None, decision) is not None) == given  # type: ignore[arg-type]
    assert _machine(None, None, decision) is None
