"""A new line at an odd multiple of the supply's frequency is hum without 50 Hz; the machine's own lines are none."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reconcile.gate import inspect_measurement
from reconcile.gate.findings import Gate
from signals.recording import Recording
from tests.strategies.impulses import RATE_HZ, SPEED_HZ, N, recorded, shaft_lines

pytestmark = pytest.mark.slow
T = np.arange(N) / RATE_HZ
LINE = 0.15


def sound(seed: int, *, speed_hz: float = SPEED_HZ, hz: float = 0.0, also_hz: float = 0.0) -> Recording:
    """Two sensors; the first with lines at `hz` and `also_hz`."""
    rng = np.random.default_rng(seed)
    rows = np.asarray([shaft_lines(rng, speed_hz) + 0.1 * rng.standard_normal(N) for _ in range(2)])
    rows[0] += sum(LINE * np.sin(2 * np.pi * f * T + seed) for f in (hz, also_hz) if f)
    return recorded(rows, speed_hz)


def told(gate: Gate) -> list[tuple[str, str]]:
    return [(f.kind, f.channel) for f in gate.findings if f.fault]


@pytest.mark.parametrize("hz", [150.0, 149.95, 180.0, 250.0, 350.0, 420.0])
def test_a_new_odd_multiple_is_hum_and_is_taken_out(hz: float) -> None:
    gate = inspect_measurement([sound(1)], [sound(2, hz=hz)])
    assert told(gate) == [("mains_hum", "a0")]
    assert gate.fault is not None and "a narrow line" in gate.fault.detail
    left = gate.tests[0].samples[0] - sound(2).samples[0]
    assert np.std(left) < 0.1 * LINE


@pytest.mark.parametrize("hz", [147.0, 152.0, 200.0, 300.0])
def test_other_lines_are_not(hz: float) -> None:
    assert told(inspect_measurement([sound(1)], [sound(2, hz=hz)])) == []


def test_what_the_baseline_has_or_no_baseline_tells_is_not() -> None:
    assert told(inspect_measurement([sound(1, hz=150.0)], [sound(2, hz=150.0)])) == []
    assert told(inspect_measurement([], [sound(2, hz=150.0)])) == []


def test_a_line_of_the_machine_s_own_is_not() -> None:
    own = 150.0 / SPEED_HZ
    assert told(inspect_measurement([sound(1)], [sound(2, hz=150.0)], orders=[own])) == []
    assert told(inspect_measurement([sound(1, speed_hz=30.0)], [sound(2, speed_hz=30.0, hz=150.0)])) == []


def test_a_line_that_follows_the_speed_is_not() -> None:
    """The baseline turned faster and has it at the same order; or another test has it elsewhere."""
    faster = 1.02 * SPEED_HZ
    gate = inspect_measurement([sound(1, speed_hz=faster, hz=153.0)], [sound(2, hz=150.0)])
    assert told(gate) == []
    both = [sound(2, hz=150.0), sound(3, speed_hz=1.5 * SPEED_HZ, hz=225.0)]
    assert told(inspect_measurement([sound(1), sound(4, speed_hz=1.5 * SPEED_HZ)], both)) == []


def test_two_multiples_are_told_as_one_hum() -> None:
    gate = inspect_measurement([sound(1)], [sound(2, hz=150.0, also_hz=250.0)])
    assert told(gate) == [("mains_hum", "a0")]
    assert gate.fault is not None and "150, 250 Hz" in gate.fault.detail


def loosened(one: Recording, speed_hz: float, count: int) -> Recording:
    """The first sensor with lines at 0.5, 1.5 ... times the speed."""
    rows = one.samples.copy()
    rows[0] += sum(LINE * np.sin(2 * np.pi * (k + 0.5) * speed_hz * T + k) for k in range(count))
    return replace(one, samples=rows)


@pytest.mark.parametrize("speed", [150.0 / 6.5, 180.0 / 5.5, 20.0])
def test_half_multiples_of_a_shaft_are_no_hum(speed: float) -> None:
    loose = sound(2, speed_hz=speed)
    loose = loosened(loose, speed, 12)
    assert told(inspect_measurement([sound(1, speed_hz=speed)], [loose])) == []


@pytest.mark.parametrize("speed", [150.0 / 6.5, 20.5, 24.3, 29.7])
def test_hum_beside_half_multiples_is_told_where_others_are_none(speed: float) -> None:
    loose = sound(2, speed_hz=speed, hz=150.0, also_hz=250.0)
    loose = loosened(loose, speed, 6)
    assert told(inspect_measurement([sound(1, speed_hz=speed)], [loose])) == [("mains_hum", "a0")]


def test_half_multiples_of_another_shaft_are_no_hum() -> None:
    base, test = sound(1), sound(2, hz=150.0)
    own = 150.0 / 7.5 / SPEED_HZ
    assert told(inspect_measurement([base], [test], shaft_orders=[1.0, own])) == []
