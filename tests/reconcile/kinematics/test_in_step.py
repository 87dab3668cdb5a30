"""Blows several times a turn that keep step with a shaft are no bearing's, however the speed wanders."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter1d

from reconcile.kinematics import read_kinematic_spec, reconcile_kinematics
from reconcile.kinematics.families import ties
from reconcile.kinematics.in_step import blows, keeps_step, new_blows
from reconcile.kinematics.observe import Observation, observe
from reconcile.verdict import Report
from signals.recording import Recording, Tacho
from signals.series import FloatArray
from tests.strategies.brief import RATE_HZ, SPEED_HZ, N, recorded

WANDER = 0.001


def spec(catalogue: str):  # type: ignore[no-untyped-def]
    bearing = {"name": "bearing1", "shaft": "shaft", "catalogue": catalogue}
    return read_kinematic_spec({"kinematics": {"shafts": [{"name": "shaft"}], "bearings": [bearing]}})


def turns(seed: int, wander: float = WANDER) -> FloatArray:
    """Of a shaft whose speed wanders slowly by a thousandth, (N,)."""
    slow = gaussian_filter1d(np.random.default_rng(seed + 50).standard_normal(N // 100), 100.0, mode="wrap")
    speed = 1.0 + wander * np.interp(np.arange(N) / 100.0, np.arange(slow.size), slow / np.std(slow))
    return np.asarray(np.cumsum(speed) * SPEED_HZ / RATE_HZ, dtype=np.float64)


def made(
    seed: int, order: float = 0.0, *, wander: float = WANDER, drift: float = 0.0, sizes: tuple[float, ...] = (1.0,)
) -> Recording:
    """Lines of a shaft, noise, and blows at `order`, of `sizes` by turns; `drift`: share by which they slip."""
    rng = np.random.default_rng(seed)
    turned = turns(seed, wander)
    x = 0.3 * rng.standard_normal(N)
    x += sum(a * np.sin(2 * np.pi * k * turned + k) for k, a in ((1, 0.5), (2, 0.3), (3, 0.2)))
    ring = np.arange(200) / RATE_HZ
    count = int(turned[-1] * order) - 2 if order else 0
    place = np.interp((np.arange(count) + 0.3) / max(order * (1 + drift), 1.0), turned, np.arange(N))
    for k, p in enumerate(place[place < N - 250]):
        first = int(np.ceil(p))
        late = ring + (first - p) / RATE_HZ
        x[first : first + 200] += 4 * sizes[k % len(sizes)] * np.exp(-1800 * late) * np.sin(2 * np.pi * 4200 * late)
    return recorded(x)


def seen(recording: Recording, catalogue: str = "6205") -> tuple[Observation, tuple[float, float]]:
    """With the most impulsive band."""
    one = observe(recording, ties(spec(catalogue)), "test 1", stated_hz=None, seed=0)
    return one, one.channels[0].band(int(np.argmax(one.channels[0].kurtosis)))


@pytest.mark.slow
@pytest.mark.parametrize("number", [5, 7, 9])
def test_blows_in_step_are_counted(number: int) -> None:
    one, band = seen(made(number, number))
    found = blows(one, ties(spec("6205")), "a0", band)
    assert found is not None and (found.shaft, found.number, found.order) == ("shaft", number, number)


@pytest.mark.slow
def test_what_slips_or_comes_once_a_turn_or_differs_much_is_none() -> None:
    tie = ties(spec("6205"))
    one, band = seen(made(2, 5, drift=0.004))
    assert not keeps_step(one, "a0", band, 5.0) and blows(one, tie, "a0", band) is None
    for unlike in (made(3, 1), made(3, 7, sizes=(1.0, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1))):
        one, band = seen(unlike)
        assert blows(one, tie, "a0", band) is None


@pytest.mark.slow
def test_pulses_tell_the_turning_and_without_any_there_is_no_step() -> None:
    one = made(4, 7)
    whole = np.arange(1, int(turns(4)[-1]))
    times = np.interp(whole, turns(4), np.arange(N) / RATE_HZ)
    timed, band = seen(replace(one, tacho=Tacho(shaft="shaft", pulse_times_s=times)))
    assert timed.speed.method == "tacho" and keeps_step(timed, "a0", band, 7.0)
    silent = replace(timed, speed=replace(timed.speed, method="stated"))
    assert not keeps_step(silent, "a0", band, 7.0)


@pytest.mark.slow
def test_teeth_of_the_file_are_no_blows() -> None:
    tie = ties(spec("6205"))
    one, band = seen(made(5, 7))
    toothed = replace(tie, meshes=(("m", 7.0, ("shaft", "slow"), ("a", "b")),))
    assert blows(one, tie, "a0", band) is not None and blows(one, toothed, "a0", band) is None


def told(catalogue: str, number: int, based: bool) -> Report:
    base = [made(1)] if based else []
    return reconcile_kinematics(spec(catalogue), [made(2, number)], base, seed=3)


@pytest.mark.slow
@pytest.mark.parametrize(("catalogue", "number"), [("6205", 7), ("6308", 5), ("6204", 5)])
def test_a_pump_is_neither_a_race_nor_another_speed(catalogue: str, number: int) -> None:
    """Half of seven is the outer race's order within slip, five the inner race's of the others."""
    report = told(catalogue, number, True)
    assert report.verdict == "unknown_physics" and not report.causes
    assert report.sentence.startswith(f"Impacts {number} times a turn of shaft") and "keep step" in report.sentence
    assert report.where.lines and report.where.lines[0].locked_to == "shaft"
    alone = told(catalogue, number, False)
    assert alone.verdict == "nothing_missing" and f"mpacts {number} times a turn of shaft" in alone.sentence
    assert any(text.startswith(f"whether impacts {number} times a turn") for text in alone.undecidable)


@pytest.mark.slow
@pytest.mark.parametrize(("catalogue", "order", "term"), [("6308", 4.93, "inner_spall"), ("6205", 3.56, "outer_spall")])
def test_a_race_close_to_a_whole_number_is_named_still(catalogue: str, order: float, term: str) -> None:
    report = reconcile_kinematics(spec(catalogue), [made(2, order)], [made(1)], seed=3)
    assert [(c.term, c.named) for c in report.causes] == [(term, True)]


@pytest.mark.slow
def test_what_the_baseline_has_too_is_not_new() -> None:
    tie = ties(spec("6205"))
    tests, bases = [seen(made(2, 7))[0]], [seen(made(1, 7))[0]]
    assert new_blows(tests, bases, tie) is None
    alone = new_blows(tests, [], tie)
    assert alone is not None and alone[1] is None
