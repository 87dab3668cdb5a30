"""A family of harmonics far from the stated speed is found where it is one, and nothing else is taken for one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reconcile.speed import estimate_speed
from reconcile.speed.elsewhere import HIGHEST, LOWEST, harmonics_of, lines_elsewhere, lines_near
from tests.reconcile.speed.test_speed import RATE_HZ, comb, recorded

STATED_HZ = 25.0
TIME = np.arange(int(5 * RATE_HZ)) / RATE_HZ


def lines(*hz: float, seed: int = 1):  # type: ignore[no-untyped-def]
    rng = np.random.default_rng(seed)
    noise = 0.3 * rng.standard_normal(TIME.size)
    return noise + 0.3 * sum(np.sin(2 * np.pi * f * TIME + rng.uniform(0, 6)) for f in hz)


def family(hz: float, *multiples: float) -> tuple[float, ...]:
    return tuple(k * hz for k in multiples)


def found(*hz: float, **how):  # type: ignore[no-untyped-def]
    return lines_elsewhere(recorded(lines(*hz), STATED_HZ), STATED_HZ, **how)


@pytest.mark.parametrize("speed_hz", [14.1, 16.73, 19.3, 22.0, 28.4, 32.0, 37.1, 45.9])
@pytest.mark.parametrize("multiples", [(1, 2, 3), (1, 2, 4, 5), (1, 3, 4, 6)])
def test_a_shaft_is_found_where_its_lines_are(speed_hz: float, multiples: tuple[int, ...]) -> None:
    one = found(*family(speed_hz, *multiples))
    assert one is not None and one.harmonics == multiples and not one.own and not one.by_teeth
    assert one.speed_hz == pytest.approx(speed_hz, rel=1e-3)
    assert estimate_speed(recorded(lines(*family(speed_hz, *multiples)), STATED_HZ)).method == "stated"


def test_a_speed_that_wanders_is_followed_from_line_to_line() -> None:
    wander = 2e-3 * np.cumsum(np.sin(2 * np.pi * 0.35 * TIME)) / RATE_HZ
    angle = 2 * np.pi * 32.0 * (TIME + wander)
    one = lines_elsewhere(recorded(comb(angle, (1, 2, 3, 4, 5), 2), STATED_HZ), STATED_HZ)
    assert one is not None and {1, 2, 3} <= set(one.harmonics)


def test_what_falls_on_the_mains_counts_but_not_alone() -> None:
    """Twice of 24.97 Hz lies at 50 Hz."""
    hummed = lines_elsewhere(recorded(lines(*family(24.97, 1, 2, 3)), 33.0), 33.0)
    assert hummed is not None and hummed.harmonics == (1, 2, 3)
    assert lines_elsewhere(recorded(lines(24.97, 49.94, 99.88), 33.0), 33.0) is None
    assert lines_elsewhere(recorded(lines(*family(50.05, 1, 2, 3, 4)), 33.0), 33.0) is None
    assert lines_elsewhere(recorded(lines(*family(59.95, 1, 2, 3, 4)), 40.0), 40.0) is None


@pytest.mark.parametrize(
    "others",
    [
        (),
        (32.0,),
        (32.0, 64.0),  # two lines are no family
        (64.0, 96.0, 128.0),  # nor are lines without their fundamental
        family(9.95, 2, 3, 4, 5, 6, 7, 8, 9, 10, 12, 14),  # a cage's: each of its multiples is no shaft's
        family(10.7, 1, 2, 3, 4, 5, 6, 7, 8, 9),  # slower than half the stated speed
        family(26.5, 1, 2, 3),  # within a tenth: the search of the stated speed
        (14.1, 17.9, 22.3, 31.7, 36.1, 41.3, 47.2, 55.5, 66.7, 77.3, 88.1, 91.9),
    ],
)
def test_what_is_no_family_is_not_taken_for_one(others: tuple[float, ...]) -> None:
    assert found(*others) is None


def test_noise_and_lines_anywhere_seldom_make_a_family() -> None:
    """Twelve lines between half and nine times the stated speed: of 60 such records two at most."""
    rng = np.random.default_rng(4)
    met = 0
    for seed in range(60):
        hz = rng.uniform(0.5, 9.0, 12) * STATED_HZ
        met += lines_elsewhere(recorded(lines(*hz, seed=seed), STATED_HZ), STATED_HZ) is not None
    assert met <= 2


def test_a_line_of_its_own_near_the_stated_speed_is_told() -> None:
    one = found(25.6, *family(32.0, 1, 2, 3))
    assert one is not None and one.own
    assert found(50.9, *family(32.0, 1, 2, 3)).own
    slow = 0.8 * 32.0  # of another shaft
    assert not found(slow, *family(32.0, 1, 2, 3), ratios=(0.8,)).own


def test_another_shaft_at_the_stated_speed_says_nothing_against_it() -> None:
    assert found(*family(0.64 * STATED_HZ, 1, 2, 3), ratios=(0.64,)) is None
    assert found(*family(1.28 * STATED_HZ, 1, 2, 3), ratios=(0.64,)) is None
    assert found(*family(1.28 * STATED_HZ, 1, 2, 3), ratios=(0.9,)) is not None


@pytest.mark.slow
@pytest.mark.parametrize("factor", [0.7, 1.3, 1.6])
def test_teeth_tell_without_a_line_of_the_shaft(factor: float) -> None:
    true_hz = factor * STATED_HZ
    rows = recorded(lines(*family(23 * true_hz, 1, 2, 3, 1 - 1 / 23, 1 + 1 / 23)), STATED_HZ)
    one = lines_elsewhere(rows, STATED_HZ, teeth=(23.0,))
    assert one is not None and one.by_teeth and one.speed_hz == pytest.approx(true_hz, rel=1e-3)
    assert lines_elsewhere(rows, STATED_HZ) is None
    assert lines_elsewhere(replace(rows, samples=lines()[np.newaxis]), STATED_HZ, teeth=(23.0,)) is None


def test_the_range_is_half_to_nearly_twice_the_stated_speed() -> None:
    for factor in (0.9 * LOWEST, 1.05 * HIGHEST):
        assert found(*family(factor * STATED_HZ, 1, 2, 3)) is None


OTHERS = (41.7, 55.3, 70.9, 83.1, 103.9, 117.7, 124.1, 137.3)
"""Lines that a defect makes beside a shaft's."""


def test_lines_that_another_recording_foretells_are_met_among_those_of_a_defect() -> None:
    speed_hz, clean = 32.0, recorded(lines(*family(32.05, 1, 2, 3)), STATED_HZ)
    told = (32.05, harmonics_of(clean, 32.05))
    assert told[1] == (1, 2, 3)
    struck = recorded(lines(*family(speed_hz, 1, 2, 3), *OTHERS), STATED_HZ)
    assert lines_elsewhere(struck, STATED_HZ) is None
    near = lines_near(struck, STATED_HZ, [told])
    assert near is not None and near.harmonics == (1, 2, 3) and near.speed_hz == pytest.approx(speed_hz, rel=1e-3)
    for hz, harmonics in ((34.0, (1, 2, 3)), (32.05, (1, 4, 5)), (32.05, (1, 2))):
        assert lines_near(struck, STATED_HZ, [(hz, harmonics)]) is None, "not where or which they are said to be"
    assert lines_near(recorded(lines(*OTHERS), STATED_HZ), STATED_HZ, [told]) is None
    own = recorded(lines(*family(STATED_HZ, 1, 2, 3), *OTHERS), STATED_HZ)
    assert lines_near(own, STATED_HZ, [(STATED_HZ, (1, 2, 3))]) is None, "the stated speed is none elsewhere"
