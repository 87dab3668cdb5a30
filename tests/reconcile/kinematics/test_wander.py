"""A speed that wanders is no fault: what it does to teeth and slow shafts in short recordings is told from one."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.kinematics import read_kinematic_spec, reconcile_kinematics
from reconcile.kinematics import without_part as module
from reconcile.kinematics.families import ties
from reconcile.kinematics.gears import GearEvidence, gear_evidence
from reconcile.kinematics.lines import at_half_of_speeds
from reconcile.kinematics.observe import observe
from reconcile.kinematics.shafts import shaft_changes
from tests.strategies.brief import RATE_HZ, recorded

TEETH, WHEEL = 23, 81
SECONDS = 1.2
SPEC = read_kinematic_spec(
    {
        "kinematics": {
            "shafts": [{"name": "shaft"}, {"name": "out"}],
            "gears": [
                {"name": "pinion", "shaft": "shaft", "teeth": TEETH},
                {"name": "gear", "shaft": "out", "teeth": WHEEL},
            ],
            "meshes": [{"name": "mesh1", "gears": ["pinion", "gear"]}],
        }
    }
)
TIE = ties(SPEC, "shaft")
WANDER_HZ = np.geomspace(0.3, 6.0, 6)


def turned(seed: int, speed_hz: float, wander: float, seconds: float = SECONDS):  # type: ignore[no-untyped-def]
    """Angle of the pinion's shaft whose speed wanders by `wander`, rms, at 0.3 to 6 Hz."""
    rng = np.random.default_rng(seed)
    t = np.arange(round(seconds * RATE_HZ)) / RATE_HZ
    sizes = rng.uniform(0.3, 1.0, WANDER_HZ.size)
    sizes *= wander * np.sqrt(2.0) / np.linalg.norm(sizes)
    places = WANDER_HZ * rng.uniform(0.85, 1.15, WANDER_HZ.size)
    phases = rng.uniform(0.0, 2.0 * np.pi, WANDER_HZ.size)
    swing = sum(a / f * np.cos(2 * np.pi * f * t + p) for a, f, p in zip(sizes, places, phases, strict=True))
    return 2 * np.pi * speed_hz * t - speed_hz * swing


def gearbox(seed: int, speed_hz: float, *, wander: float = 0.0, fault: float = 0.0, seconds: float = SECONDS):  # type: ignore[no-untyped-def]
    """Three mesh lines with weak runout; `fault` takes this share of a tenth of each turn of the gear."""
    angle = turned(seed, speed_hz, wander, seconds)
    out = angle * TEETH / WHEEL
    runout = 1 + 0.003 * sum(np.cos(m * angle + m) + np.cos(m * out - m) for m in range(1, 4))
    dip = np.exp(-0.5 * ((np.mod(out, 2 * np.pi) - 2.0) / 0.1) ** 2)
    mesh = sum(a * np.cos(k * TEETH * angle + k) for k, a in ((1, 1.0), (2, 0.5), (3, 0.3)))
    noise = np.random.default_rng(seed).standard_normal(angle.size)
    return (runout - fault * dip) * mesh + 0.01 * noise


def seen(rows, speed_hz: float, label: str):  # type: ignore[no-untyped-def]
    return observe(recorded(rows, speed_hz), TIE, label, stated_hz=None, seed=0)


def told(seed: int, *, wander: float, fault: float, speeds=(22.5, 30.0, 39.0)) -> tuple[GearEvidence, ...]:  # type: ignore[no-untyped-def]
    before = [seen(gearbox(seed + k, hz, wander=0.001), hz, f"baseline {k}") for k, hz in enumerate(speeds)]
    now = [seen(gearbox(seed + 50 + k, hz, wander=wander, fault=fault), hz, f"test {k}") for k, hz in enumerate(speeds)]
    return gear_evidence(now, before, TIE)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_wander_is_no_tooth_fault(seed: int) -> None:
    assert not any(g.grown for g in told(seed, wander=0.004, fault=0.0))


@pytest.mark.slow
def test_a_tooth_fault_is_one_with_wander_too() -> None:
    first = told(0, wander=0.002, fault=0.8)[0]
    assert first.grown and first.gear == "gear"
    assert first.contrast_db > 6.0 and first.multiples >= 3


@pytest.mark.slow
def test_growth_at_one_speed_of_three_is_seldom() -> None:
    speeds = (22.5, 30.0, 39.0)
    before = [seen(gearbox(k, hz), hz, f"baseline {k}") for k, hz in enumerate(speeds)]
    faults = (0.8, 0.0, 0.0)
    now = [
        seen(gearbox(9 + k, hz, fault=f), hz, f"test {k}") for k, (hz, f) in enumerate(zip(speeds, faults, strict=True))
    ]
    assert not any(g.grown for g in gear_evidence(now, before, TIE))
    assert gear_evidence(now[:1], before, TIE)[0].grown, "alone it is all there is"
    report = reconcile_kinematics(SPEC, [o.recording for o in now], [o.recording for o in before], seed=0)
    assert any("at fewer than half of the speeds: sidebands of out" in text for text in report.undecidable)


@pytest.mark.slow
def test_the_newest_of_several_tests_at_one_speed_is_enough() -> None:
    before = [seen(gearbox(1, 30.0), 30.0, "baseline")]
    now = [seen(gearbox(9 + k, 30.0, fault=f), 30.0, f"test {k}") for k, f in enumerate((0.0, 0.0, 0.8))]
    assert gear_evidence(now, before, TIE)[0].grown


@pytest.mark.slow
@pytest.mark.parametrize("seconds", [0.65, 0.8, 1.0, 1.3])
def test_a_tooth_fault_is_found_in_few_turns_of_its_gear(seconds: float) -> None:
    """5.5 to 11 turns, in which its sidebands are as wide as half their distance."""
    before, now = (seen(gearbox(k, 30.0, fault=f, seconds=seconds), 30.0, "r") for k, f in ((1, 0.0), (2, 0.8)))
    assert gear_evidence([now], [before], TIE)[0].gear == "gear"
    assert gear_evidence([now], [before], TIE)[0].grown


@pytest.mark.parametrize(
    ("tests", "held"),
    [
        ([], True),
        ([(30.0, False)], False),
        ([(30.0, False), (30.2, False), (30.4, True)], True),
        ([(22.5, False), (30.0, True), (39.0, False)], False),
        ([(22.5, False), (30.0, True), (39.0, True)], True),
    ],
)
def test_half_of_the_speeds(tests: list[tuple[float, bool]], held: bool) -> None:
    assert at_half_of_speeds(tests) is held


def test_few_periods_of_a_slow_line_are_not_compared() -> None:
    """Half the speed of the slow shaft makes four periods in 1.2 s, and thirty in ten."""
    hz, half = 24.0, 0.5 * TEETH / WHEEL

    def changes(seconds: float):  # type: ignore[no-untyped-def]
        rows = [gearbox(k, hz, seconds=seconds) for k in (1, 2)]
        rows[1] = rows[1] + 3.0 * np.sin(half * turned(0, hz, 0.0, seconds))
        test, base = (seen(x, hz, "r") for x in reversed(rows))
        return {(c.shaft, c.multiple): c for c in shaft_changes([test], [base], TIE)}

    assert ("out", 0.5) not in changes(1.2)
    assert changes(10.0)["out", 0.5].grown


@pytest.mark.slow
@pytest.mark.parametrize(("depth", "told"), [(0.22, False), (0.37, True)])
def test_shallow_impacts_of_a_turn_are_runout_under_load(
    depth: float, told: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A sound gearbox under 1.6 times the load reached 0.22."""
    turn = SimpleNamespace(
        family=SimpleNamespace(kind="turn", site="shaft", key="shaft.turn"),
        present=True,
        risen=True,
        depth=depth,
        z=5.3,
    )
    monkeypatch.setattr(module, "turn_report", lambda *_, **__: "a turn")
    rows = [seen(gearbox(seed, 24.0), 24.0, f"{word} 1") for seed, word in ((2, "test"), (1, "baseline"))]
    found = module.without_a_part(SPEC, TIE, rows[:1], rows[1:], [turn], (), [], 0, None)  # type: ignore[list-item]
    assert (found == "a turn") is told  # type: ignore[comparison-overlap]
