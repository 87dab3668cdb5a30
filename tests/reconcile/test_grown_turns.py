"""Where a machine's change is usual as a whole, a shaft's line that grew far is told all the same."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reconcile.grown_turns import USUAL, with_grown_turns
from reconcile.verdict import Report, Where
from signals.recording import Operating, Recording
from sim.core.response import Channel
from sim.presets import preset

RATE_HZ, SPEED_HZ, SECONDS = 12_800.0, 30.1, 3.0
RIG = preset("bearing-rig")
QUIET = Report(
    verdict="nothing_missing", sentence="Nothing is missing.", level="machine", where=Where(limits=("a limit",))
)


def recorded(once: float, seed: int, hum: float = 0.0, speed_hz: float = SPEED_HZ) -> Recording:
    """Two channels that hear four multiples of the shaft, the first `once` times as strong, in noise."""
    assert RIG.operating is not None
    at, rng = np.arange(round(SECONDS * RATE_HZ)) / RATE_HZ, np.random.default_rng(seed)
    turns = 2 * np.pi * speed_hz * at
    lines = once * np.sin(turns) + sum(0.4 * np.sin(k * turns + k) for k in (2, 3, 4))
    supply = sum(np.sin(2 * np.pi * hz * at) for hz in (50.0, 150.0, 250.0))
    both = [gain * (lines + hum * supply) + rng.standard_normal(at.size) for gain in (1.0, 0.7)]
    return Recording(
        sampling_rate_hz=RATE_HZ,
        channels=tuple(Channel(name=n, quantity="acceleration", unit="m/s^2", location="", axis="y") for n in "ab"),
        samples=np.array(both),
        operating=Operating(shaft=RIG.operating.shaft, speed_hz=speed_hz),
    )


def told(report: Report, test: Recording, baseline: Recording) -> Report:
    return with_grown_turns(report, RIG, [test], [baseline], 0)


@pytest.mark.slow
def test_a_line_that_grew_is_told_and_nothing_is_said_to_be_sound() -> None:
    found = told(QUIET, recorded(2.0, 1), recorded(0.2, 2))
    assert found.verdict == "not_decidable" and USUAL in found.sentence
    assert found.sentence.startswith("1 times the speed of motor grew by 2") and "at this level" not in found.sentence
    (line,) = found.where.lines
    assert line.frequency_hz == pytest.approx(SPEED_HZ, rel=1e-3) and line.change_db == pytest.approx(20.0, abs=4.0)
    assert found.where.limits == ("a limit",) and [s.site for s in found.where.sites] == ["motor"]
    assert {c.term for c in found.causes} >= {"unbalance", "bent_shaft"} and not any(c.named for c in found.causes)
    assert found.next_experiment is not None and "motor" in found.next_experiment.sentence


@pytest.mark.slow
@pytest.mark.parametrize("once", [0.2, 0.35])
def test_what_hardly_grew_changes_nothing(once: float) -> None:
    assert told(QUIET, recorded(once, 1), recorded(0.2, 2)) is QUIET


@pytest.mark.slow
def test_hum_at_twice_the_speed_is_no_line_of_the_shaft() -> None:
    humming, before = recorded(0.2, 1, hum=3.0, speed_hz=24.9), recorded(0.2, 2, speed_hz=24.9)
    assert told(QUIET, humming, before) is QUIET


def test_other_answers_stay() -> None:
    for verdict in ("explained", "ambiguous", "unknown_physics", "not_decidable", "measurement_fault"):
        other = replace(QUIET, verdict=verdict)
        assert told(other, recorded(2.0, 1), recorded(0.2, 2)) is other
    assert with_grown_turns(QUIET, RIG, [recorded(2.0, 1)], [], 0) is QUIET
