"""Lines half way between those of a defect say that it is struck half as often, missing odd ones twice as often."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reconcile.kinematics import read_kinematic_spec, reconcile_kinematics
from reconcile.kinematics.candidate import Candidate
from reconcile.kinematics.families import ties
from reconcile.kinematics.judge import candidates
from reconcile.kinematics.observe import Observation, observe
from reconcile.kinematics.octaves import octave_of
from signals.recording import Tacho
from tests.strategies.brief import SECONDS, SPEED_HZ, N, recorded, train

SPEC = read_kinematic_spec(
    {
        "kinematics": {
            "shafts": [{"name": "shaft"}],
            "bearings": [{"name": "bearing1", "shaft": "shaft", "catalogue": "6205"}],
        }
    }
)
TIE = ties(SPEC)
ORDERS = {"outer": 3.5848, "inner": 5.4152, "ball": 4.7135}


def noise(seed: int, kind: str | None = None, height: float = 1.0):  # type: ignore[no-untyped-def]
    rng = np.random.default_rng(seed)
    hit = 0.0 if kind is None else train(rng, 0.992 * ORDERS[kind], height, load=0.6 if kind == "inner" else 0.0)
    return 0.3 * rng.standard_normal(N) + hit


def judged(kind: str, factor: float, *, pulses: bool = False) -> tuple[Candidate, tuple[Candidate, ...], Observation]:
    """The candidate of the kind, where the speed is stated wrong by `factor`."""
    recording = recorded(noise(2, kind), factor * SPEED_HZ)
    if pulses:
        times = np.arange(int(SECONDS * factor * SPEED_HZ)) / (factor * SPEED_HZ)
        recording = replace(recording, tacho=Tacho(shaft="shaft", pulse_times_s=times))
    seen = observe(recording, TIE, "test 1", stated_hz=None, seed=0)
    every = candidates([seen], [], TIE, 0)
    return next(c for c in every if c.family.kind == kind), every, seen


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["outer", "inner"])
@pytest.mark.parametrize(("factor", "octave"), [(1.0, None), (2.0, 0.5), (0.5, 2.0)])
def test_a_race_tells_a_speed_that_is_wrong_by_two(kind: str, factor: float, octave: float | None) -> None:
    chosen, every, seen = judged(kind, factor)
    assert octave_of(chosen, every, [seen]) == octave


@pytest.mark.slow
def test_balls_and_pulses_are_not_asked() -> None:
    for factor in (1.0, 2.0):
        chosen, every, seen = judged("ball", factor)
        assert octave_of(chosen, every, [seen]) is None
    chosen, every, seen = judged("inner", 2.0, pulses=True)
    assert seen.speed.method == "tacho" and octave_of(chosen, every, [seen]) is None


@pytest.mark.slow
def test_most_of_the_tests_must_say_so() -> None:
    chosen, every, wrong = judged("inner", 2.0)
    right = judged("inner", 1.0)[2]
    both = replace(chosen, evidence=chosen.evidence * 2)
    twice = [replace(c, evidence=c.evidence * 2) for c in every]
    assert octave_of(both, twice, [wrong, wrong]) == 0.5
    assert octave_of(both, twice, [wrong, right]) is None


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["outer", "inner"])
@pytest.mark.parametrize("factor", [1.0, 2.0])
def test_without_lines_of_the_shaft_a_race_is_named_at_the_right_speed_only(kind: str, factor: float) -> None:
    rows = noise(2, kind, 3.0), noise(1)
    test, base = (recorded(x, factor * SPEED_HZ) for x in rows)
    report = reconcile_kinematics(SPEC, [test], [base], seed=3)
    assert report.causes[0].term == f"{kind}_spall"
    if factor == 1.0:
        assert (report.verdict, report.causes[0].named) == ("explained", True)
        return
    assert report.verdict == "ambiguous" and not any(c.named for c in report.causes)
    assert f"bearing lines fit {SPEED_HZ:g} Hz, half the stated speed" in report.sentence
    assert f"At {SPEED_HZ:g} Hz: A local defect" in report.sentence
    assert f"whether shaft turns at {2 * SPEED_HZ:g} Hz as stated or at {SPEED_HZ:g} Hz" in report.undecidable[0]
