"""The picture is of the family that the answer names, though another is louder."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.kinematics import reconcile_kinematics
from reconcile.kinematics.picture import _others, of_the_answer
from reconcile.report.page import page
from reconcile.verdict import Cause
from tests.reconcile.kinematics.test_vague import spec
from tests.strategies.impulses import recorded, sound, train


def candidate(site: str, kind: str, present: bool = True, driven: bool = False) -> SimpleNamespace:
    return SimpleNamespace(family=SimpleNamespace(site=site, kind=kind), present=present, driven=driven)


def shown(every: list[SimpleNamespace], *causes: Cause) -> object:
    return of_the_answer(every, causes)  # type: ignore[arg-type]


def cause(term: str, site: str, named: bool = False) -> Cause:
    return Cause(term=term, site=site, score=9.0, named=named)


def test_the_answers_family_comes_first() -> None:
    every = [candidate("motor", "turn"), candidate("drive_end", "ball"), candidate("drive_end", "inner", False)]
    assert shown(every, cause("inner_spall", "drive_end", True)) is every[2]
    assert shown(every, cause("inner_spall", "drive_end")) is every[0], "not named, and not there"


def test_impacts_once_a_turn_are_shown_not_the_bearing_that_they_may_be_too() -> None:
    every = [candidate("motor", "turn"), candidate("drive_end", "inner", False)]
    assert shown(every, cause("rub", "motor"), cause("inner_spall", "drive_end")) is every[0]


def test_without_a_cause_of_its_own_lines_the_first_that_is_there_is_shown_or_none() -> None:
    every = [candidate("drive_end", "ball", False), candidate("motor", "turn")]
    assert shown(every) is every[1] and shown(every, cause("broken_tooth", "mesh1")) is every[1]
    assert shown([candidate("drive_end", "ball", False)]) is None
    blows = candidate("drive_end", "ball", False, True)
    assert shown([candidate("motor", "turn", False), blows]) is blows


@pytest.mark.parametrize(("present", "order"), [(True, 4.6), (False, 4.71)])
def test_a_part_that_is_not_heard_stands_where_the_drawing_has_it(present: bool, order: float) -> None:
    """Within its slip another part's sideband is the best place for it."""
    family = SimpleNamespace(site="drive_end", kind="ball", order=4.71)
    ball = SimpleNamespace(family=family, present=present, best=SimpleNamespace(order=4.6))
    own = SimpleNamespace(family=SimpleNamespace(site="drive_end", kind="outer", order=3.58))
    (line,) = _others(own, [own, ball])  # type: ignore[arg-type, list-item]
    assert line == {"label": "2 BSF", "order": order, "kind": "other"}


@pytest.mark.slow
def test_of_noise_no_line_is_marked() -> None:
    """Lines of a ball were, where nothing stands."""
    noise = recorded(np.random.default_rng(3).standard_normal(sound(2).shape))
    picture = reconcile_kinematics(spec(8), [noise], [], seed=3).pictures["envelope"]
    assert isinstance(picture, dict) and picture["lines"] == [] and "family" not in picture
    assert len(picture["test"]["depth"]) > 100


@pytest.mark.slow
def test_impacts_at_an_order_of_no_part_are_shown_in_their_own_band() -> None:
    struck = recorded(sound(2) + train(np.random.default_rng(5), 5.95, 1.0))
    report = reconcile_kinematics(spec(8), [struck], [recorded(sound(1))], seed=3)
    assert report.verdict == "unknown_physics" and "of the specification has that order" in report.sentence
    drawn = report.pictures["envelope"]
    assert isinstance(drawn, dict) and "family" not in drawn
    low, high = drawn["band_hz"]
    assert f"in {low:.0f}-{high:.0f} Hz of {drawn['channel']}" in report.sentence
    assert drawn["lines"][0] == {"label": f"{drawn['order']:.4g}", "order": drawn["order"], "kind": "own"}
    assert abs(drawn["order"] - 5.95) < 0.05 and "comb of impacts 5.9" in page(report)
