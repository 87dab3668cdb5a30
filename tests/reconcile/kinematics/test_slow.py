"""Blows at one angle of a shaft of seven turns are told by that angle; blows at any are not."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import fftconvolve

from reconcile.kinematics import read_kinematic_spec, reconcile_kinematics
from reconcile.kinematics.slow import agreement, folded
from tests.strategies.brief import RATE_HZ, recorded

SPEED_HZ, SECONDS, TEETH, WHEEL = 20.0, 3.0, 18, 150
SPEC = read_kinematic_spec(
    {
        "kinematics": {
            "shafts": [{"name": "shaft"}, {"name": "out"}],
            "gears": [
                {"name": "pinion", "shaft": "shaft", "teeth": TEETH},
                {"name": "gear", "shaft": "out", "teeth": WHEEL},
            ],
            "meshes": [{"name": "mesh1", "gears": ["pinion", "gear"]}],
            "bearings": [{"name": "b", "shaft": "out", "catalogue": "6205"}],
        }
    }
)
UNGEARED = read_kinematic_spec(
    {
        "kinematics": {
            "shafts": [
                {"name": "shaft", "speed_hz": SPEED_HZ},
                {"name": "out", "speed_hz": SPEED_HZ * TEETH / WHEEL},
            ],
            "bearings": [{"name": "b", "shaft": "out", "catalogue": "6205"}],
        }
    }
)


def gearbox(seed: int, turns=()):  # type: ignore[no-untyped-def]
    """Mesh lines and noise, with blows where the slow shaft has made so many `turns`."""
    rng = np.random.default_rng(seed)
    n = round(SECONDS * RATE_HZ)
    angle = 2 * np.pi * SPEED_HZ * np.arange(n) / RATE_HZ
    mesh = sum(a * np.cos(k * TEETH * angle + k) for k, a in ((1, 1.0), (2, 0.5), (3, 0.3))) + 0.3 * np.cos(angle)
    times = np.asarray(turns, dtype=float) / (SPEED_HZ * TEETH / WHEEL)
    force = np.zeros(n)
    np.add.at(force, (times[times < SECONDS - 0.02] * RATE_HZ).astype(int), 3.0)
    ring = np.arange(int(0.01 * RATE_HZ)) / RATE_HZ
    blow = fftconvolve(force, np.exp(-ring * 900) * np.sin(2 * np.pi * 5200 * ring))[:n]
    return recorded(mesh + blow + 0.1 * rng.standard_normal(n), SPEED_HZ)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("spec", "said", "site"),
    [(SPEC, "local tooth fault on gear", "gear"), (UNGEARED, "at one angle of out", "out")],
)
def test_blows_at_one_angle_of_seven_turns_are_placed_there(spec, said: str, site: str) -> None:  # type: ignore[no-untyped-def]
    report = reconcile_kinematics(spec, [gearbox(2, np.arange(8) + 0.37)], [gearbox(1)], seed=0)
    assert report.verdict == "ambiguous" and said in report.sentence
    assert not any(c.named for c in report.causes)
    assert report.where.sites[0].site == site
    window = report.where.angle_window
    assert window is not None and window.shaft == "out"
    assert window.centre_deg == pytest.approx(0.37 * 360.0, abs=8.0)


@pytest.mark.slow
def test_blows_at_any_angle_keep_to_none() -> None:
    turns = np.sort(np.random.default_rng(5).uniform(0.0, 7.0, 7))
    for spec in (SPEC, UNGEARED):
        report = reconcile_kinematics(spec, [gearbox(2, turns)], [gearbox(1)], seed=0)
        assert "at one angle" not in report.sentence and "tooth" not in report.sentence


@pytest.mark.slow
def test_chances_of_turns_without_agreement_are_uniform() -> None:
    rng = np.random.default_rng(0)
    found = np.array([agreement(np.log(rng.chisquare(4, (8, 60))), rng)[2] for _ in range(200)])
    assert np.mean(found < 0.05) == pytest.approx(0.05, abs=2.5 * np.sqrt(0.05 * 0.95 / 200))
    assert np.mean(found < 0.5) == pytest.approx(0.5, abs=2.5 * np.sqrt(0.25 / 200))


def test_a_turn_is_folded_on_itself() -> None:
    """Ten turns of 240 steps with one high step each."""
    values = np.ones(2400)
    values[100::240] = 50.0
    table = folded(values, 240.0)
    assert table is not None and table.shape == (10, 60)
    level, score, chance = agreement(table, np.random.default_rng(1))
    assert int(np.argmax(level)) == 25 and chance == pytest.approx(1e-3) and score > 10.0


@pytest.mark.parametrize(("steps", "period"), [(700, 240.0), (2400, 50.0)])
def test_too_few_turns_and_too_wide_steps_are_not_folded(steps: int, period: float) -> None:
    assert folded(np.ones(steps), period) is None


@pytest.mark.slow
def test_a_shaft_of_many_turns_is_told_by_its_lines_not_by_angle(monkeypatch: pytest.MonkeyPatch) -> None:
    """A train at another order that a turning load makes louder at one angle would be one of the turn."""
    monkeypatch.setattr("reconcile.kinematics.slow.MOST_TURNS", 6)
    report = reconcile_kinematics(UNGEARED, [gearbox(2, np.arange(8) + 0.37)], [gearbox(1)], seed=0)
    assert "at one angle" not in report.sentence
