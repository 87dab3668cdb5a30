"""The picture is of the family that the answer names, though another is louder."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.kinematics import reconcile_kinematics
from reconcile.kinematics.picture import of_the_answer
from reconcile.report.page import page
from reconcile.verdict import Cause
from tests.reconcile.kinematics.test_vague import spec
from tests.strategies.impulses import recorded, sound, train


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


@pytest.mark.slow
def test_impacts_at_an_order_of_no_part_are_shown_in_their_own_band() -> None:
    struck = recorded(sound(2) + train(np.random.default_rng(5), 5.95, 1.0))
    report = reconcile_kinematics(spec(8), [struck], [recorded(sound(1))], seed=3)
    assert report.verdict == "unknown_physics" and "of the specification has that order" in report.sentence
    shown = report.pictures["envelope"]
    assert isinstance(shown, dict) and "family" not in shown
    low, high = shown["band_hz"]
    assert f"in {low:.0f}-{high:.0f} Hz of {shown['channel']}" in report.sentence
    assert shown["lines"][0] == {"label": f"{shown['order']:.4g}", "order": shown["order"], "kind": "own"}
    assert abs(shown["order"] - 5.95) < 0.05 and "comb of impacts 5.9" in page(report)
