"""What is scored on held-out data is searched and fitted on the rest alone, and the placebo is searched as the name."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reconcile.kinematics import read_kinematic_spec
from reconcile.kinematics.combs import Stretch
from reconcile.kinematics.families import ties
from reconcile.kinematics.heldout import best_fit, gain_interval, held_out
from reconcile.kinematics.observe import Observation, observe
from reconcile.kinematics.parted import LEAST_TURNS, parted, turns_of
from reconcile.verdict import HeldOut
from signals.recording import Tacho
from tests.strategies.half import RATE_HZ, SPEED_HZ, N, recorded, sound, train

BEARING = {"name": "bearing1", "shaft": "shaft", "catalogue": "6205"}
TIE = ties(read_kinematic_spec({"kinematics": {"shafts": [{"name": "shaft"}], "bearings": [BEARING]}}))
OUTER, INNER = (next(f for f in TIE.families if f.kind == kind) for kind in ("outer", "inner"))
SLIP = 0.011
pytestmark = pytest.mark.slow


def rows(seed: int, height: float = 1.0):  # type: ignore[no-untyped-def]
    return sound(seed) + train(np.random.default_rng(seed), OUTER.order * (1 - SLIP), height)


def seen(samples, label: str = "test 1", **more: object) -> Observation:  # type: ignore[no-untyped-def]
    return observe(replace(recorded(samples), **more), TIE, label, stated_hz=None, seed=0)  # type: ignore[arg-type]


BASELINE = seen(sound(1), "baseline 1")


def scored(*tests: Observation, placebo=INNER) -> HeldOut:  # type: ignore[no-untyped-def]
    found = held_out(OUTER, placebo, tests, [BASELINE], TIE, np.random.default_rng(0), 0)
    assert found is not None
    return found


def order_of(test: Observation) -> tuple[float, str]:
    parts = parted([test], TIE, 0)
    assert parts is not None
    fit = best_fit(OUTER, parts, [BASELINE], TIE, np.random.default_rng(0))
    assert fit is not None
    return fit.train.order, fit.channel


def test_the_true_family_as_placebo_gains_what_the_named_one_does() -> None:
    test = seen(rows(3))
    other, same = scored(test), scored(test, placebo=OUTER)
    assert other.placebo is not None and same.placebo is not None
    assert same.placebo == pytest.approx(same.gain, abs=0.02)
    assert other.placebo < 0.3 * other.gain and other.gain == same.gain and other.gain_low > other.placebo


def test_a_change_of_the_later_half_alone_moves_no_order_but_the_score() -> None:
    first, middle = rows(3), N // 2
    changed = first.copy()
    later = sound(9) + train(np.random.default_rng(9), OUTER.order * (1 + SLIP), 2.0)
    changed[middle:] = later[middle:]
    one, two = seen(first), seen(changed)
    assert order_of(one) == order_of(two)
    assert order_of(one)[0] == pytest.approx(OUTER.order * (1 - SLIP), rel=0.003)
    assert scored(two).gain < scored(one).gain - 0.1
    assert scored(one).held == "a later time of the same record"


def test_the_channel_is_chosen_on_the_fitted_half() -> None:
    """A defect that comes to the second sensor in the later half only, where it is the stronger."""
    deaf, heard = sound(5), rows(3, 0.7)
    deaf[N // 2 :] = rows(6, 3.0)[N // 2 :]
    assert order_of(seen(np.stack([deaf, heard])))[1] == "a1"


def test_all_other_tests_are_scored() -> None:
    fitted, second, same, other = seen(rows(3)), seen(rows(4)), seen(rows(6)), seen(sound(7))
    two, alike, three = scored(fitted, second), scored(fitted, second, same), scored(fitted, second, other)
    assert two.held == f"another recording, at {second.speed.speed_hz:.4g} Hz"
    assert three.held.startswith("2 other recordings, at ")
    assert alike.gain == pytest.approx(two.gain, abs=0.1)
    assert three.gain < two.gain - 0.1, "the third has no defect"
    assert three.gain_low < three.gain < three.gain_high
    assert three.gain_high - three.gain_low > alike.gain_high - alike.gain_low, "recordings that differ say less"


def test_a_test_too_short_is_no_part_and_neither_are_short_halves() -> None:
    fitted, short = seen(rows(3)), seen(rows(4)[: int(18 / SPEED_HZ * RATE_HZ)])
    assert turns_of(short) < LEAST_TURNS
    parts = parted([fitted, short], TIE, 0)
    assert parts is not None and parts.told == "a later time of the same record"
    assert parted([seen(rows(4)[: int(40 / SPEED_HZ * RATE_HZ)])], TIE, 0) is None


def test_pulses_of_a_half_are_its_own() -> None:
    times = np.arange(0.01, N / RATE_HZ, 1 / SPEED_HZ)
    parts = parted([seen(rows(3), tacho=Tacho(shaft="shaft", pulse_times_s=times))], TIE, 0)
    assert parts is not None
    early, late = (one.recording.tacho for one in (parts.fit, parts.held[0]))
    assert early is not None and late is not None
    assert early.pulse_times_s[-1] < N / RATE_HZ / 2 <= late.pulse_times_s[0]
    assert early.pulse_times_s.size + late.pulse_times_s.size == times.size


def test_the_interval_of_a_gain_is_the_ninety_percent_one() -> None:
    """Against the closed form: the mean of many independent blocks is normal."""
    rng, blocks, width = np.random.default_rng(5), 400, 10
    fit = Stretch(log_power=np.zeros(blocks * width), orders=np.arange(1, blocks * width + 1) / width)
    squares = np.repeat(rng.uniform(0.1, 0.5, blocks), width)
    before, after = np.ones((1, squares.size)), np.sqrt(squares)[None]
    low, high = gain_interval(before, after, fit, rng)
    mean, error = float(np.mean(squares)), float(np.std(squares)) / np.sqrt(blocks)
    expected = [1 - np.sqrt(mean + 1.645 * error), 1 - np.sqrt(mean - 1.645 * error)]
    assert high - low == pytest.approx(expected[1] - expected[0], rel=0.15)
    assert (low + high) / 2 == pytest.approx(1 - np.sqrt(mean), abs=0.2 * error)
