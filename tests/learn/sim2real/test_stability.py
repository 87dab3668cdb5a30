from dataclasses import replace

import numpy as np
import pytest

from learn.sim2real import stability as command
from learn.sim2real.stability import CHANGES, answered, counts, stability


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
    halves = [found[n].channels[0].tolist() for n in ("first half alone", "second half")]
    assert halves[0] + halves[1] == list(range(100))
    assert found["speed -0.1 %"].speed_hz == pytest.approx(0.999 * one.speed_hz)
    assert found["speed +0.1 %"].speed_hz == pytest.approx(1.001 * one.speed_hz)


def test_an_answer_that_holds_by_the_speed_alone_is_counted_so(made):
    one = made.case("a", "outer")

    def way(unit):
        return made.answer(unit.case, "outer" if unit.case.speed_hz <= one.speed_hz else "ball")

    row = stability(answered([one], way)).splitlines()[-1]
    assert row == "| a | outer | outer | outer | outer | outer | outer | outer | outer | ball | outer | 7 of 8 |"


def test_recordings_of_bearings_of_unknown_size_are_not_counted(made):
    cases = [made.case("a", "outer"), made.case("m", "healthy", orders=None)]
    row = counts({"all": answered(cases, lambda unit: made.answer(unit.case, "outer"))}).splitlines()[-1]
    assert row == "| all |" + " 1 of 1 |" * len(CHANGES)


def test_sound_bearings_are_changed_too_and_gears_are_not(made, monkeypatch, capsys):
    cases = [
        made.case("o", "outer"),
        made.case("n", "healthy"),
        made.case("m", "healthy", orders=None),
        made.case("g", "healthy", teeth=(32, 80)),
        made.case("x", "other"),
    ]
    monkeypatch.setattr(command, "available", lambda: True)
    monkeypatch.setattr(command, "index", lambda: [{"dataset": "cwru", "at": k} for k in range(len(cases))])
    monkeypatch.setattr(command, "case", lambda entry: cases[entry["at"]])
    monkeypatch.setattr(command, "ByModel", lambda model: lambda unit: made.answer(unit.case, "outer"))
    monkeypatch.setattr(command, "by_detector", lambda unit: made.answer(unit.case, "healthy"))
    assert command.main(["--processes", "1"]) == 0
    faulty, sound, right = (part.splitlines()[2:] for part in capsys.readouterr().out.split("\n\n"))
    assert [row.split(" | ")[0] for row in faulty] == ["| o"]
    assert [row.split(" | ")[0] for row in sound] == ["| n", "| m"]
    assert sound[0].endswith("| 0 of 8 |")
    assert [row.split(" | ")[1] for row in right] == ["1 of 2", "1 of 2"]
