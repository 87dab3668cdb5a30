"""A pattern beneath the burst of a tooth is asked first, where it is clearly another effect's."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reconcile.judge.adequacy import Rest
from reconcile.judge.screen import Screen
from reconcile.machine.beneath import beneath_a_tooth
from reconcile.machine.decide import STRUCK, decide
from reconcile.machine.weigh import FAR_AHEAD, HOPELESS
from tests.reconcile.machine.screens import screen

NAMES = (
    "tooth_spall@pinion",
    "tooth_crack@pinion",
    "missing_tooth@pinion",
    "fit_clearance_series@bearing2",
    "fit_clearance@bearing2",
    "cubic_support@gear",
)
FIT = NAMES[3]


def told(patterns: list[float], burst: float = 23.0, names: tuple[str, ...] = NAMES) -> Screen:
    """Of m038: all faults of a tooth of the pinion have the burst."""
    direct = np.array([burst, burst, burst, 0.0, 0.0, 0.0])
    left = Rest(unmet=3.3, kept=0.2, pooled=0.07, elsewhere=3.3, rough=False)
    made = screen(list(np.array(patterns) + direct), names, rest=left)
    return replace(made, direct=direct)


M038 = [4.3, 1.0, 0.5, 18.0, 4.1, 4.7]


def test_a_loose_fit_beneath_the_burst_is_the_first() -> None:
    found = decide(told(M038), views=9)
    assert (found.word, found.chosen) == ("explained", (FIT,))
    assert not found.reasons, "what is left is known of the tooth alone"


@pytest.mark.parametrize(
    ("patterns", "burst", "why"),
    [
        ([4.3, 1.0, 0.5, HOPELESS - 0.1, 0.0, 0.0], 23.0, "faint"),
        ([18.0 - FAR_AHEAD + 0.1, 1.0, 0.5, 18.0, 4.1, 4.7], 23.0, "the tooth has nearly as much of a pattern"),
        ([4.3, 1.0, 0.5, 18.0, 4.1, 18.0 - FAR_AHEAD + 0.1], 23.0, "another effect has"),
        ([11.0, 1.0, 0.5, 18.0, 4.1, 4.7], STRUCK - 0.1, "the burst is not sure"),
        ([-9.0, -9.0, -9.0, 40.0, 4.1, 4.7], 23.0, "the fit leads anyway"),
    ],
)
def test_else_none(patterns: list[float], burst: float, why: str) -> None:
    assert beneath_a_tooth(told(patterns, burst), STRUCK) == (), why


def test_another_form_of_the_fit_does_not_stand_against_it() -> None:
    assert beneath_a_tooth(told([4.3, 1.0, 0.5, 18.0, 17.0, 4.7]), STRUCK) == (FIT,)


def test_a_pit_of_a_bearing_brings_a_pattern_of_its_own() -> None:
    names = ("outer_spall@bearing1", "outer_spall@bearing2", "ball_spall@bearing1", *NAMES[3:])
    assert beneath_a_tooth(told(M038, names=names), STRUCK) == ()


def test_a_second_pattern_with_impacts_is_none() -> None:
    made = told(M038)
    heard = replace(
        made, direct=np.array([23.0, 23.0, 23.0, 4.0, 0.0, 0.0]), evidence=np.add(made.evidence, [0, 0, 0, 4, 0, 0])
    )
    assert beneath_a_tooth(heard, STRUCK) == ()
