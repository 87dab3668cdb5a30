"""Where pulses tell the turn, a miscounted gear is told by the whole multiple at which its lines stand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reconcile.kinematics import known_turn, reconcile_kinematics
from reconcile.report.revised import to_do
from signals.recording import Recording, Tacho
from tests.reconcile.kinematics.test_teeth import SPEED_HZ, TRUE, gearbox, spec
from tests.strategies.brief import RATE_HZ, recorded


def measured(seed: int, *, fan: float = 0.0, blades: int = 27, shaft: bool = False, thrice: float = 0.0) -> Recording:
    """`fan`: height of lines of `blades`, three multiples; `shaft`: every multiple of the turn is there;
    `thrice`: height of sidebands three and six turns from the teeth's lines."""
    samples = gearbox(seed)
    angle = 2 * np.pi * SPEED_HZ * np.arange(samples.size) / RATE_HZ
    samples = samples + fan * sum(np.cos(k * blades * angle) / k for k in (1, 2, 3))
    for k, far in ((k, far) for k in (1, 2, 3) for far in (-6, -3, 3, 6)):
        samples = samples + thrice / abs(far) * np.cos((k * TRUE + far) * angle + far)
    if shaft:
        samples = samples + sum(2.0 * np.cos(k * angle + k * k) for k in range(1, 90))
    seconds = samples.size / RATE_HZ
    pulses = Tacho(shaft="shaft", pulse_times_s=np.arange(0.0, seconds, 1.0 / SPEED_HZ))
    return replace(recorded(samples, SPEED_HZ), tacho=pulses)


def said(teeth: int, **how: float):  # type: ignore[no-untyped-def]
    return reconcile_kinematics(spec(teeth), [measured(2, **how)], [measured(1, **how)], seed=0)


@pytest.mark.slow
@pytest.mark.parametrize("teeth", [21, 25, 28])
def test_the_line_that_shows_it_is_told(teeth: int) -> None:
    report = said(teeth)
    assert report.sentence.startswith(
        f"In its teeth the machine file does not fit: {teeth} of pinion, but mesh1 stands"
    )
    assert "at 575 Hz" in report.sentence and f"{TRUE} times the line of the turn" in report.sentence
    assert "correct the machine file first" in to_do(report)
    assert report.next_experiment is not None and "Correct the teeth of pinion" in report.next_experiment.sentence


@pytest.mark.slow
def test_sidebands_three_turns_apart_are_no_lines_of_the_files_teeth() -> None:
    """Three times 21 is six from three times 23: that line stands alone among its next neighbours."""
    report = said(21, thrice=0.3)
    assert report.sentence.startswith("In its teeth the machine file does not fit: 21 of pinion")


@pytest.mark.slow
@pytest.mark.parametrize("how", [{}, {"fan": 3.0}, {"shaft": True}], ids=["alone", "louder blades", "all multiples"])
def test_right_teeth_are_left_alone(how: dict[str, float]) -> None:
    assert "machine file" not in said(TRUE, **how).sentence


@pytest.mark.slow
def test_where_every_multiple_of_the_turn_is_as_loud_nothing_is_told() -> None:
    assert "machine file" not in said(21, shaft=True).sentence


def asked(**levels: float) -> list[int]:
    """Which numbers are heard where the file has 23, by dB at multiples of the turn `n<multiple>`, 5 elsewhere."""
    excess = np.full(160, 5.0)
    for name, level in levels.items():
        excess[int(name[1:])] = level
    return [z for z in range(14, 37) if z != 23 and known_turn._all_loudest(excess, z) and _none(excess, z)]


def _none(excess: np.ndarray, heard: int) -> bool:
    return known_turn._none_at(excess, 23, heard)


@pytest.mark.parametrize("other", [21, 22, 24, 25])
def test_louder_lines_of_another_part_next_to_the_teeths_are_no_miscount(other: int) -> None:
    """Blades of a fan on the shaft, one more than its gear has teeth: the gear's own lines stand."""
    own = {f"n{k * 23}": 25.0 for k in (1, 2, 3)}
    blades = {f"n{k * other}": 40.0 for k in (1, 2, 3)}
    assert asked(**blades) == [other], "the file's are none"
    assert asked(**own, **blades) == []
    low = {f"n{k * 23}": 20.0 for k in (1, 2, 3)}
    assert asked(**low, **blades) == [], "however far below"


def test_the_files_lines_must_be_far_below_on_the_mean_and_none_near() -> None:
    heard = {"n25": 40.0, "n50": 40.0, "n75": 40.0}
    beside = {"n22": 33.0, "n24": 33.0, "n45": 33.0, "n47": 33.0, "n68": 33.0, "n70": 33.0}
    assert asked(**heard, **beside, n23=33.0, n46=29.0, n69=27.0) == [25], "10.3 dB on the mean, 7 at one"
    assert asked(**heard, **beside, n23=34.5, n46=20.0, n69=20.0) == [], "5.5 dB at one"
    assert asked(**heard, **beside, n23=31.0, n46=31.0, n69=31.0) == [], "9 dB on the mean"
