"""A file whose teeth are miscounted is told so and judged with those that are heard; a wrong speed is not mistaken for
it."""

from __future__ import annotations

import numpy as np
import pytest

from reconcile.kinematics import read_kinematic_spec, reconcile_kinematics
from reconcile.report.action import to_do
from tests.strategies.brief import RATE_HZ, recorded

TRUE, WHEEL = 23, 57
SPEED_HZ, SECONDS = 25.0, 4.0


def spec(teeth: int):  # type: ignore[no-untyped-def]
    return read_kinematic_spec(
        {
            "kinematics": {
                "shafts": [{"name": "shaft"}, {"name": "out"}],
                "gears": [
                    {"name": "pinion", "shaft": "shaft", "teeth": teeth},
                    {"name": "gear", "shaft": "out", "teeth": WHEEL},
                ],
                "meshes": [{"name": "mesh1", "gears": ["pinion", "gear"]}],
            }
        }
    )


def gearbox(seed: int, *, turned_hz: float = SPEED_HZ, first: float = 0.3):  # type: ignore[no-untyped-def]
    angle = 2 * np.pi * turned_hz * np.arange(round(SECONDS * RATE_HZ)) / RATE_HZ
    mesh = sum(a * np.cos(k * TRUE * angle + k) for k, a in ((1, 1.0), (2, 0.5), (3, 0.3)))
    shaft = first * np.cos(angle) + 0.3 * first * np.cos(2 * angle)
    return mesh + shaft + 0.05 * np.random.default_rng(seed).standard_normal(angle.size)


def said(teeth: int, **how: float):  # type: ignore[no-untyped-def]
    """The report where the description states `SPEED_HZ`."""
    test, base = (recorded(gearbox(seed, **how), SPEED_HZ) for seed in (2, 1))
    return reconcile_kinematics(spec(teeth), [test], [base], seed=0)


@pytest.mark.slow
@pytest.mark.parametrize("teeth", [25, 22])
def test_teeth_that_do_not_fit_are_told_with_those_that_do(teeth: int) -> None:
    report = said(teeth)
    assert f"{teeth} of pinion" in report.sentence and f"{TRUE} times the line of the turn" in report.sentence
    assert report.verdict == "nothing_missing"
    assert "correct the machine file first" in to_do(report)
    assert not any("from the stated" in text for text in report.where.limits), "the stated speed is right"


@pytest.mark.slow
def test_the_right_teeth_are_left_alone() -> None:
    assert "machine file" not in said(TRUE).sentence


@pytest.mark.slow
def test_a_wrong_speed_is_told_and_the_teeth_stay() -> None:
    """At this speed 23 teeth are 25 at the stated one."""
    report = said(TRUE, turned_hz=SPEED_HZ * 25 / TRUE)
    assert "machine file" not in report.sentence
    assert any("turned at 27.17 Hz" in text and "+8.7 %" in text for text in report.where.limits)


@pytest.mark.slow
def test_without_a_line_of_the_turn_nothing_decides() -> None:
    assert "machine file" not in said(25, first=0.0).sentence


def far_off(teeth: int, stated: tuple[float, ...], turned: tuple[float, ...]):  # type: ignore[no-untyped-def]
    """Tests and baselines at these speeds, the shaft's own lines too faint to tell."""
    tests, baselines = (
        [
            recorded(gearbox(seed + k, turned_hz=hz, first=0.0), told)
            for k, (told, hz) in enumerate(zip(stated, turned, strict=True))
        ]
        for seed in (2, 12)
    )
    return reconcile_kinematics(spec(teeth), tests, baselines, seed=0)


@pytest.mark.slow
@pytest.mark.parametrize("teeth", [29, 31])
def test_teeth_far_from_those_of_the_file_are_told_in_most_recordings_alike(teeth: int) -> None:
    report = far_off(teeth, (22.5, 30.0, 39.0), (22.5, 30.0, 39.0))
    assert report.sentence.startswith("In its teeth the machine file does not fit, or most stated speeds")
    assert f"{teeth} of pinion" in report.sentence and f"{TRUE} times the stated speed" in report.sentence
    assert report.verdict == "nothing_missing" and not any(c.named for c in report.causes)
    assert f"whether pinion has {TRUE} teeth" in report.undecidable[0]
    assert report.next_experiment is not None and "Correct the teeth of pinion" in report.next_experiment.sentence
    assert not any("left out" in text for text in report.where.limits)


@pytest.mark.slow
def test_speeds_that_are_wrong_by_no_whole_number_of_teeth_are_no_miscount() -> None:
    stated = (22.5, 30.0, 39.0)
    report = far_off(TRUE, stated, tuple(0.85 * hz for hz in stated))  # 19.55 teeth
    assert "machine file does not fit" not in report.sentence and not any(c.named for c in report.causes)
    assert report.verdict == "measurement_fault" and "stated speed does not hold" in report.sentence
