"""Of channels that were held for a good part only what is whole between is read, or nothing at all."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reconcile.gate import inspect_measurement
from reconcile.gate.findings import Gate
from reconcile.gate.spoiled import GONE, without_spoiled
from reconcile.gate.whole import LEAST_TURNS, TOLERATED, whole_stretches
from reconcile.kinematics import read_kinematic_spec, reconcile_kinematics
from signals.checks import held
from signals.recording import Operating, Recording
from tests.strategies.impulses import N, recorded, sound, train

RATE_HZ, SPEED_HZ = 2000.0, 20.0
SPEC = read_kinematic_spec(
    {"kinematics": {"shafts": [{"name": "shaft"}], "bearings": [{"name": "b", "shaft": "shaft", "catalogue": "6205"}]}}
)


def stuck(row, *stretches: tuple[float, float], value: float | None = None):  # type: ignore[no-untyped-def]
    """The row held over these shares of its length."""
    row = row.copy()
    for a, b in stretches:
        first, stop = int(a * row.size), int(b * row.size)
        row[first:stop] = row[first] if value is None else value
    return row


def made(*rows, speed_hz: float = SPEED_HZ) -> Recording:  # type: ignore[no-untyped-def]
    one = replace(recorded(np.array(rows)), sampling_rate_hz=RATE_HZ)
    return replace(one, operating=Operating(shaft="shaft", speed_hz=speed_hz) if speed_hz else None)


def row(seed: int, seconds: float = 4.0):  # type: ignore[no-untyped-def]
    return np.random.default_rng(seed).standard_normal(int(seconds * RATE_HZ))


def gate(tests: list[Recording], baselines: list[Recording]) -> Gate:
    return Gate(findings=(), baselines=tuple(baselines), tests=tuple(tests), fault=None, usable=True)


def cut(tests: list[Recording], baselines: list[Recording] | None = None, nominal_hz: float | None = None):  # type: ignore[no-untyped-def]
    return whole_stretches(gate(tests, baselines or []), tests, baselines or [], nominal_hz)


def test_held_samples_are_those_of_stuck_stretches_and_dropouts() -> None:
    x = row(1)
    assert not np.any(held(x)) and np.all(held(np.full(100, 2.0)))
    mask = held(stuck(stuck(x, (0.1, 0.2)), (0.5, 0.6), value=0.0))
    assert np.flatnonzero(mask).tolist() == [*range(800, 1600), *range(4000, 4800)]
    x[40:60] = x[40]  # shorter than a fault
    assert not np.any(held(x))


def test_few_held_samples_change_nothing() -> None:
    one = made(stuck(row(1), (0.5, 0.5 + 0.9 * TOLERATED)))
    found = cut([one], [made(row(2))])
    assert (found.gate.tests, found.told, found.lost) == ((one,), (), frozenset())


def test_the_longest_whole_stretch_is_read() -> None:
    x = stuck(row(1), (0.2, 0.5), (0.9, 1.0))
    found = cut([made(x)], [made(row(2))])
    (left,) = found.gate.tests
    assert np.array_equal(left.samples[0], x[4000:7200]) and left.start_s == pytest.approx(2.0)
    assert found.gate.usable and found.gate.baselines[0].samples.shape[1] == 8000
    assert found.told == ("test 1: 40 % of the samples were held, zero or away: only 2 to 3.6 s of a0 were read",)


def test_what_is_left_must_hold_enough_turns() -> None:
    x = stuck(row(1), *((k / 10, k / 10 + 0.05) for k in range(10)))
    found = cut([made(x)])
    assert not found.gate.usable and found.gate.fault is not None and found.lost == {"test 1"}
    assert (found.gate.fault.kind, found.gate.fault.channel) == ("stuck", "a0")
    assert "50 % of the samples" in found.gate.fault.detail and "no whole stretch" in found.gate.fault.detail
    long = stuck(row(1), (0.0, 0.65))
    for speed_hz, usable in ((LEAST_TURNS / 1.3, True), (LEAST_TURNS / 1.5, False)):
        assert cut([made(long, speed_hz=speed_hz)]).gate.usable == usable
        assert cut([made(long, speed_hz=0.0)], nominal_hz=speed_hz).gate.usable == usable
    assert cut([made(long, speed_hz=0.0)]).gate.usable


def test_recordings_without_such_a_stretch_are_lost_beside_others() -> None:
    bad = made(stuck(row(1), (0.1, 0.9)))
    found = cut([bad, made(row(2))], [bad])
    assert found.gate.usable and found.lost == {"test 1", "baseline 1"} and len(found.told) == 2


def test_of_two_channels_both_are_read_where_they_were_held_together_else_the_better() -> None:
    together = made(stuck(row(1), (0.0, 0.4)), stuck(row(2), (0.0, 0.4)))
    assert cut([together]).gate.tests[0].names == ("a0", "a1")
    apart = made(stuck(row(1), (0.0, 0.7)), stuck(row(2), (0.3, 0.5)))
    assert cut([apart]).gate.tests[0].names == ("a1",)
    assert cut([apart], [made(row(3), row(4))]).gate.baselines[0].names == ("a1",)


@pytest.mark.slow
@pytest.mark.parametrize("baseline", [True, False])
def test_a_sensor_stuck_for_most_of_the_recording_names_nothing(baseline: bool) -> None:
    rng = np.random.default_rng(4)
    edges = np.sort(rng.uniform(0.0, 0.39, 40)) + 0.61 / 40 * np.arange(40)
    pit = sound(2) + train(rng, 3.5848, 1.5)
    past = [recorded(sound(1))] if baseline else []
    for x in (pit, sound(3)):
        spoiled = recorded(stuck(x, *((a, a + 0.61 / 40) for a in edges)))
        report = reconcile_kinematics(SPEC, [spoiled], past, seed=3)
        assert report.verdict == "measurement_fault" and report.fault is not None and report.causes == ()
        assert (report.fault.kind, report.fault.channel) == ("stuck", "a0") and "61 %" in report.sentence


@pytest.mark.slow
def test_a_pit_is_named_by_what_is_left_and_the_gap_is_told() -> None:
    pit = sound(2) + train(np.random.default_rng(4), 3.5848, 1.5)
    report = reconcile_kinematics(SPEC, [recorded(stuck(pit, (0.3, 0.7)))], [recorded(sound(1))], seed=3)
    assert (report.verdict, report.causes[0].term) == ("explained", "outer_spall")
    assert any("40 % of the samples were held" in text and "were read" in text for text in report.where.limits)
    quiet = reconcile_kinematics(SPEC, [recorded(stuck(sound(5), (0.3, 0.7)))], [recorded(sound(1))], seed=3)
    assert quiet.verdict == "measurement_fault" and quiet.fault is not None and quiet.fault.kind == "stuck"
    both = recorded([stuck(sound(5), (0.3, 0.7)), pit])
    assert both.samples.shape[1] == N
    left = without_spoiled(inspect_measurement([], [both]), GONE)
    assert left.tests[0].names == ("a1",)  # another channel is whole: it is read all along
