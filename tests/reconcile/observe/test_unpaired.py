"""Tests that no baseline was recorded beside are left out, and that is told."""

from __future__ import annotations

import numpy as np

from reconcile.observe.observation import unpaired
from signals.recording import Operating, Recording
from sim.core.response import Channel
from sim.presets import preset

MACHINE = preset("paper-lightly-damped")


def at(speed_hz: float, label: str) -> Recording:
    return Recording(
        sampling_rate_hz=20480.0,
        channels=(Channel(name="a", quantity="acceleration", unit="m/s^2", location="bearing1", axis="y"),),
        samples=np.zeros((1, 20480)),
        operating=Operating(shaft="input", speed_hz=speed_hz),
        label=label,
    )


def test_which_tests_are_left_out_and_what_the_baselines_were_is_told() -> None:
    tests = [at(24.0, "t1.json"), at(30.0, "t2.json"), at(36.0, "t3.json")]
    (told,) = unpaired(MACHINE, tests, [at(30.1, "b.json")])
    left_out, _, rest = told.partition(";")
    assert left_out == "left out: tests at 24 Hz, torque ratio 1 (t1.json)"
    assert "36 Hz, torque ratio 1 (t3.json)" in rest and "t2.json" not in told and "30.1 Hz" in rest


def test_nothing_is_told_without_baselines_or_where_all_have_one() -> None:
    tests = [at(24.0, "t1.json"), at(30.0, "t2.json")]
    assert unpaired(MACHINE, tests, []) == ()
    assert unpaired(MACHINE, tests, [at(24.0, "b1.json"), at(30.0, "b2.json")]) == ()
