"""The picture is of the family that the answer names, though another is louder."""

from __future__ import annotations

from types import SimpleNamespace

from reconcile.kinematics.picture import of_the_answer
from reconcile.verdict import Cause


def candidate(site: str, kind: str) -> SimpleNamespace:
    return SimpleNamespace(family=SimpleNamespace(site=site, kind=kind))


def test_the_answers_family_comes_first() -> None:
    every = [candidate("motor", "turn"), candidate("drive_end", "ball"), candidate("drive_end", "inner")]
    cause = Cause(term="inner_spall", site="drive_end", score=9.0, named=True)
    shown = of_the_answer(every, [cause])  # type: ignore[arg-type]
    assert shown == [every[2], every[0], every[1]]


def test_without_a_cause_of_its_own_lines_the_firmest_stays_first() -> None:
    every = [candidate("motor", "turn"), candidate("drive_end", "ball")]
    rub = Cause(term="rub", site="motor", score=9.0, named=False)
    assert of_the_answer(every, []) == every  # type: ignore[arg-type]
    assert of_the_answer(every, [rub]) == every  # type: ignore[arg-type]
