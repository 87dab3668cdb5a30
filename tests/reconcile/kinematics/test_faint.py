"""Impacts of no order are a ball's only if its order is hinted at."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from reconcile.kinematics import faint, read_kinematic_spec, reconcile_kinematics
from reconcile.kinematics.faint import impulsive_report
from reconcile.kinematics.shafts import Impulsiveness
from tests.strategies.brief import N, recorded, sound

FOUND = Impulsiveness(channel="a0", now=9.0, before=0.0, band_hz=(2000.0, 4000.0), label="test 1")


@pytest.mark.parametrize(("z", "likely"), [(1.5, False), (4.0, True)])
def test_a_ball_is_likely_where_its_order_is_hinted_at(z: float, likely: bool) -> None:
    ball: Any = SimpleNamespace(family=SimpleNamespace(kind="ball", site="bearing1"), z=z)
    report = impulsive_report(FOUND, [ball], ["bearing1", "bearing2"])
    assert report.verdict == "ambiguous" and ("is likely" in report.sentence) is likely
    assert ("from outside" in report.sentence) is not likely
    assert (report.causes[0].score > report.causes[-1].score) is likely


def candidate(kind: str, z: float, *, risen: bool = True, deep: bool = False) -> Any:
    family = SimpleNamespace(key=f"bearing1.{kind}", kind=kind, site="bearing1")
    best = SimpleNamespace(depth=0.2, slip=0.0)
    return SimpleNamespace(family=family, best=best, z=z, growth_db=12.0, risen=risen, deep=deep)


@pytest.mark.parametrize(
    ("risen", "others", "score", "reason"),
    [
        (["outer"], [("ball", 2.5, False)], 2.5, "its own lines did not rise"),
        (["outer"], [], 0.0, "its own lines did not rise"),
        (["outer", "inner"], [("ball", 2.5, False)], np.hypot(9.0, 8.0), "lines of both races rose"),
        (["outer"], [("ball", 2.5, False), ("cage", 12.0, True)], 12.0, "come and go with the cage"),
        (["outer"], [("ball", 2.5, False), ("cage", 12.0, False)], 2.5, "its own lines did not rise"),
    ],
)
def test_a_ball_in_a_set_of_shallow_lines_stands_with_what_of_it_was_heard(
    monkeypatch: pytest.MonkeyPatch, risen: list[str], others: list[Any], score: float, reason: str
) -> None:
    monkeypatch.setattr(faint, "lines_of", lambda *_: ())
    monkeypatch.setattr(faint, "loudest", lambda *_: None)
    up = [candidate(kind, z) for kind, z in zip(risen, (9.0, 8.0), strict=False)]
    every = [*up, *(candidate(kind, z, risen=deep, deep=deep) for kind, z, deep in others)]
    report = faint.shallow_report(up, every, [], [])
    (ball,) = (c for c in report.causes if c.term == "ball_spall")
    assert ball.score == pytest.approx(score) and ball.reasons[0].startswith(("lines of", "impacts", "its own"))
    assert reason in ball.reasons[0] and "likely" not in report.sentence
    assert [c.score for c in report.causes] == sorted((c.score for c in report.causes), reverse=True)
    races = {c.term: c.score for c in report.causes if c.term != "ball_spall"}
    assert races == {f"{kind}_spall": c.z for kind, c in zip(risen, up, strict=True)}


@pytest.mark.slow
def test_noise_alone_is_no_sound_machine() -> None:
    bearing = {"name": "bearing1", "shaft": "shaft", "catalogue": "6205"}
    spec = read_kinematic_spec({"kinematics": {"shafts": [{"name": "shaft"}], "bearings": [bearing]}})
    noise = reconcile_kinematics(spec, [recorded(np.random.default_rng(3).standard_normal(N))], [], seed=0)
    assert noise.verdict == "not_decidable" and "not heard" in noise.sentence and not noise.causes
    assert reconcile_kinematics(spec, [recorded(sound(3))], [], seed=0).verdict == "nothing_missing"
