"""Lines are listed as measured: those that are there, each with its own change."""

from __future__ import annotations

import numpy as np
import pytest

from reconcile.kinematics import read_kinematic_spec, reconcile_kinematics
from reconcile.kinematics.families import ties
from reconcile.kinematics.measured import measured_lines
from reconcile.kinematics.observe import Observation, observe
from tests.strategies.brief import RATE_HZ, SPEED_HZ, N, recorded, sound, train

SHAFT = {"name": "shaft"}
BEARING = {"name": "bearing1", "shaft": "shaft", "catalogue": "6205"}
SPEC = read_kinematic_spec({"kinematics": {"shafts": [SHAFT], "bearings": [BEARING]}})
BAND = (2000.0, 8000.0)


def modulated(seed: int, *depths: tuple[float, float]) -> Observation:
    """Noise whose power is modulated at orders with depths."""
    t = np.arange(N) / RATE_HZ
    power = 1.0 + sum(d * np.cos(2 * np.pi * order * SPEED_HZ * t) for order, d in depths)
    row = np.sqrt(power) * np.random.default_rng(seed).standard_normal(N)
    return observe(recorded(row), ties(SPEC), f"test {seed}", stated_hz=None, seed=0)


@pytest.mark.slow
def test_a_line_has_its_own_change_against_the_baseline() -> None:
    test, base = modulated(1, (3.6, 0.8), (7.2, 0.4)), modulated(2, (3.6, 0.2), (7.2, 0.4))
    wanted = [("one", 3.6), ("two", 7.2), ("absent", 10.8), ("none", -1.0), ("beyond", 1e4)]
    found = measured_lines(wanted, "a0", BAND, test, [base], "bearing1.outer")
    assert [line.label for line in found] == ["one", "two"]
    assert found[0].frequency_hz == pytest.approx(3.6 * SPEED_HZ, rel=0.003)
    assert found[0].change_db == pytest.approx(20 * np.log10(4.0), abs=2.0)
    assert found[1].change_db == pytest.approx(0.0, abs=2.0)
    assert {(x.channel, x.locked_to, x.speed_hz) for x in found} == {("a0", "bearing1.outer", SPEED_HZ)}
    alone = measured_lines(wanted, "a0", BAND, test, [])
    assert [line.label for line in alone] == ["one", "two"]
    assert alone[0].change_db - alone[1].change_db == pytest.approx(20 * np.log10(2.0), abs=4.0)


@pytest.mark.slow
def test_a_report_lists_only_what_stands_out_with_its_speed() -> None:
    rng = np.random.default_rng(2)
    hit = sound(2) + train(rng, 5.4152 * 0.992, 1.0)  # an inner race whose impacts the load does not change
    report = reconcile_kinematics(SPEC, [recorded(hit)], [recorded(sound(1))], seed=3)
    lines = report.where.lines
    assert report.causes[0].term == "inner_spall"
    assert lines[0].label == "1 BPFI" and not any("shaft" in line.label for line in lines)
    assert all(line.speed_hz == pytest.approx(SPEED_HZ, rel=1e-3) for line in lines)
    assert len({round(line.change_db, 3) for line in lines}) == len(lines)
