"""When a sensor's fault is the answer."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from reconcile.machine.answer import _doubtful
from reconcile.verdict import SensorFault


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
