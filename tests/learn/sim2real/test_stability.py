from dataclasses import replace

import numpy as np
import pytest

from learn.sim2real.stability import CHANGES, stability


def test_what_is_changed_is_what_the_column_says(made):
    one = replace(made.case("a", "outer"), channels=np.arange(100.0)[None])
    found = {name: change(one) for name, change in CHANGES.items()}
    assert [found[n].channels[0, 0] for n in ("as it is", "first 10 % dropped", "first 20 %", "last 20 %")] == [
        0,
        10,
        20,
        0,
    ]
    assert [found[n].channels[0, -1] for n in ("as it is", "first 20 %", "last 10 %", "last 20 %")] == [99, 99, 89, 79]
    assert found["speed -0.1 %"].speed_hz == pytest.approx(0.999 * one.speed_hz)
    assert found["speed +0.1 %"].speed_hz == pytest.approx(1.001 * one.speed_hz)


def test_an_answer_that_holds_by_the_speed_alone_is_counted_so(made):
    one = made.case("a", "outer")

    def way(unit):
        return made.answer(unit.case, "outer" if unit.case.speed_hz <= one.speed_hz else "ball")

    row = stability([one], way).splitlines()[-1]
    assert row == "| a | outer | outer | outer | outer | outer | outer | ball | outer | 5 of 6 |"
