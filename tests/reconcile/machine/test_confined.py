"""What one sensor shows at one operating point decides nothing, unless one place or impacts answer for it."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.atlas.plan import Point
from reconcile.machine.answer import _next
from reconcile.machine.confined import unless_confined
from reconcile.machine.decide import AT_ONE, DETECT_P, Decision
from reconcile.machine.setting import Found, Setting
from reconcile.machine.words import sentence
from tests.reconcile.judge.cells import LINES, changed, noise, space

NAMES = ("torque_ripple@output", "outer_waviness@bearing1")
SET = Decision(word="ambiguous", chosen=NAMES, p=1e-5, reasons=("they look alike",))


def one_point() -> np.ndarray:
    """A sensor far out at 30 Hz, and its neighbour by a fifth of it."""
    cube = noise(4)
    cube[1, 2, :LINES] += 24.0
    cube[1, 0, :LINES] += 4.0
    return cube


def asked(decision: Decision, cube: np.ndarray, *, gears: int = 2, baseline: bool = True, p: float = 1.0) -> Decision:
    changes = changed(cube)
    changes.with_baseline = baseline  # type: ignore[misc]
    setting: Setting = SimpleNamespace(  # type: ignore[assignment]
        data=tuple(SimpleNamespace(point=Point(speed_hz=hz)) for hz in (20.0, 30.0, 40.0)),
        channels=("a.x", "b.x", "c.x"),
        machine=SimpleNamespace(gears=(None,) * gears),
        changes=changes,
        direct=SimpleNamespace(p=p),
    )
    found: Found = SimpleNamespace(fitted=space())  # type: ignore[assignment]
    return unless_confined(decision, setting, found)


@pytest.mark.parametrize("word", ["ambiguous", "unknown_physics"])
def test_effects_of_several_places_or_none_of_the_known_are_not_decided_by_it(word: str) -> None:
    given = Decision(word=word, chosen=NAMES, p=1e-5, reasons=("?",))  # type: ignore[arg-type]
    told = asked(given, one_point())
    assert told.word == "not_decidable" and told.chosen == NAMES and told.p == given.p
    assert told.reasons[0].startswith(f"{AT_ONE}, 30 Hz, and there by far the most on c.x;")


@pytest.mark.parametrize(
    "given",
    [
        Decision(word="explained", chosen=NAMES[:1], p=1e-5, reasons=()),
        Decision(
            word="ambiguous", chosen=("fit_clearance@bearing1", "radial_clearance@bearing1"), p=0.0, reasons=("?",)
        ),
        Decision(word="nothing_missing", chosen=(), p=0.9, reasons=("p = 0.9",)),
    ],
)
def test_a_name_a_set_of_one_place_and_a_sound_machine_stay(given: Decision) -> None:
    assert asked(given, one_point()) is given


def test_it_stays_with_impacts_without_teeth_or_baseline_and_where_another_speed_shows_it_too() -> None:
    both = one_point()
    both[2, 2, :LINES] += 12.0
    assert asked(SET, one_point(), p=DETECT_P) is SET
    assert asked(SET, one_point(), gears=0) is SET
    assert asked(SET, one_point(), baseline=False) is SET
    assert asked(SET, both) is SET
    assert asked(SET, one_point()) is not SET


def test_the_sentence_says_where_and_the_advice_is_to_record_there_again() -> None:
    told = asked(SET, one_point())
    assert sentence(told, None, None) == (
        f"Whether anything is missing is not decided: the change is unusual (p < 0.001), but {told.reasons[0]}; "
        "nearest is torque ripple at output."
    )
    advice = _next(None, None, told, None)  # type: ignore[arg-type]
    assert advice is not None and advice.sentence.startswith("Record baseline and test once more where it shows")
