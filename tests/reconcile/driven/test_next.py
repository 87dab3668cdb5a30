"""What is advised where no law is named: by acceleration another motion or sensor, else more amplitude."""

from __future__ import annotations

import pytest

from reconcile.driven.answer import BY_DISPLACEMENT, _next
from reconcile.driven.judge import Judgement
from reconcile.verdict import Word


@pytest.mark.parametrize(
    ("verdict", "accelerated", "displacement"),
    [("unknown_physics", True, True), ("unknown_physics", False, False), ("ambiguous", True, False)],
)
def test_a_law_that_an_acceleration_leaves_open_is_asked_of_the_displacement(
    verdict: Word, accelerated: bool, displacement: bool
) -> None:
    advised = _next(Judgement(verdict=verdict, reasons=("none",), rivals=()), accelerated)
    assert advised is not None and (advised.sentence == BY_DISPLACEMENT) is displacement
    assert displacement or "twice the amplitude" in advised.sentence
