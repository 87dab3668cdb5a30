"""Hum is multiples of one frequency that a supply has; turns of a shaft that come near them are none."""

from __future__ import annotations

import numpy as np
import pytest

from reconcile.gate.mains import hum_findings, hum_lines
from signals.recording import Recording
from tests.strategies.impulses import RATE_HZ, N, recorded

NOTHING = np.zeros(0)


def lines(*hz: float, seconds: float = 5.0) -> Recording:
    count = min(N, int(seconds * RATE_HZ))
    t = np.arange(count) / RATE_HZ
    rng = np.random.default_rng(1)
    return recorded(0.1 * rng.standard_normal(count) + sum(np.cos(2 * np.pi * f * t + f) for f in hz))


@pytest.mark.parametrize("supply", [50.0, 49.97, 60.0, 60.03])
def test_multiples_of_a_supply_are_hum(supply: float) -> None:
    found = hum_lines(lines(supply, 3 * supply, 5 * supply), "a0", NOTHING)
    assert [hz for hz, _ in found] == pytest.approx([supply, 3 * supply, 5 * supply], abs=0.3)


@pytest.mark.parametrize("shaft", [29.91, 29.85, 24.93])
def test_even_turns_of_a_motor_are_none(shaft: float) -> None:
    """Of a label that is wrong the shaft's lines are not expected where they are."""
    assert not hum_lines(lines(*(k * shaft for k in (2, 6, 10))), "a0", NOTHING)


def test_true_hum_beside_such_turns_stays() -> None:
    found = [hz for hz, _ in hum_lines(lines(120.0, 240.0, 360.0, 6 * 29.91), "a0", NOTHING)]
    assert found == pytest.approx([120.0, 240.0, 360.0], abs=0.3)


@pytest.mark.parametrize(("grown_db", "fault"), [(4.0, False), (5.0, False), (7.0, True), (12.0, True)])
def test_hum_is_a_fault_from_a_doubled_level_on(grown_db: float, fault: bool) -> None:
    """Hum that was there before wanders by a few dB with the load of the supply."""
    t = np.arange(N) / RATE_HZ
    base, test = (
        recorded(0.1 * np.random.default_rng(seed).standard_normal(N) + height * np.cos(2 * np.pi * 50.0 * t))
        for seed, height in ((1, 1.0), (2, 10 ** (grown_db / 20)))
    )
    (found,) = hum_findings(test, "test 1", NOTHING, [base])
    assert found.fault is fault
    assert f"{grown_db:+.0f} dB against the baseline" in found.detail
