"""Two motions of a base and its mass: what one sensor says of the other."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from reconcile.driven import reconcile_driven
from reconcile.driven.base import from_base
from reconcile.driven.channels import Driven, driven_of
from reconcile.driven.pair import Paired, paired
from reconcile.driven.passed import passed, transfer
from signals.recording import Recording
from tests.reconcile.driven.test_base import DAMPING, OMEGA, RATE, SPEC, shaken

pytestmark = pytest.mark.slow
OWN = 2.0 * math.pi * 50.0
"""Of the machine file, and not the pair's."""


def changed(how: Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]], seed: int = 1) -> Recording:
    """An acceleration pair with samples changed."""
    sound = shaken(2, seed)
    return replace(sound, samples=np.vstack(how(*sound.samples)))


def held(recording: Recording, *baselines: Recording) -> Paired:
    return paired(driven_of(recording, SPEC), OWN, "test 1", [driven_of(b, SPEC) for b in baselines])


def kinds(found: Paired) -> list[tuple[str, str]]:
    return [(f.kind, f.channel) for f in found.faults]


def near(one: Driven, other: Driven) -> float:
    """Share of the relative motion by which two differ."""
    return float(np.std(one.answer - other.answer) / other.answer.std())


@pytest.mark.parametrize("order", [0, 1, 2])
def test_a_sound_pair_stays_as_it_is(order: int) -> None:
    found, as_given = held(shaken(order)), from_base(driven_of(shaken(order), SPEC))
    assert (found.faults, found.limits) == ((), ())
    assert np.array_equal(found.data.answer, as_given.answer)


def test_the_transfer_tells_the_machine_from_any_start() -> None:
    seen = transfer(driven_of(shaken(2), SPEC))
    assert seen is not None
    found = passed(seen, OWN, gain=True, delay=True)
    assert math.sqrt(found.stiffness) == pytest.approx(OMEGA, rel=0.01)
    assert found.damping == pytest.approx(2 * DAMPING * OMEGA, rel=0.03)
    assert found.gain == pytest.approx(1.0, abs=0.005)
    assert abs(found.delay_s) < 0.05 / RATE


def test_calibration_is_taken_off_and_said_and_no_fault() -> None:
    found = held(changed(lambda base, mass: (base, 1.03 * mass)))
    assert found.faults == ()
    assert re.search(r"\+(2\.9|3\.[01]) %", found.limits[0]), found.limits
    assert near(found.data, from_base(driven_of(shaken(2), SPEC))) < 0.005


def test_a_gain_of_one_channel_is_not_said_of_which_one() -> None:
    found = held(changed(lambda base, mass: (base, 1.1 * mass)), shaken(2, 2))
    assert kinds(found) == [("gain_change", "")]
    assert re.search(r"1\.(09\d*|1|10\d) times", found.faults[0].detail), found.faults
    assert near(found.data, from_base(driven_of(shaken(2), SPEC))) < 0.01


def test_less_than_all_may_be_a_spring_to_the_ground() -> None:
    found = held(changed(lambda base, mass: (base, 0.9 * mass)))
    assert kinds(found) == [("gain_change", "")]
    assert re.search(r"a spring with (9\.\d|10) % of the stiffness", found.faults[0].detail), found.faults


def test_and_the_sentence_has_both() -> None:
    report = reconcile_driven(SPEC, [changed(lambda base, mass: (base, 0.9 * mass))], seed=1)
    assert report.verdict == "ambiguous" and report.sentence.startswith("A gain or a spring")
    assert "holds the mass to the ground. Apart from it the linear model" in report.sentence
    assert report.fault is not None and report.fault.doubtful and report.measurement_faults == (report.fault,)
    assert report.next_experiment is not None and "a gain stays" in report.next_experiment.sentence
    more = reconcile_driven(SPEC, [changed(lambda base, mass: (base, 1.1 * mass))], seed=1)
    assert more.verdict == "measurement_fault" and "spring" not in more.sentence, "no spring makes it follow by more"


@pytest.mark.parametrize("wrong", ["base", "mass"])
def test_levels_of_a_baseline_tell_whose_unit_it_is(wrong: str) -> None:
    given = changed(lambda base, mass: (base / 9.80665, mass) if wrong == "base" else (base, mass / 9.80665))
    alone, beside = held(given), held(given, shaken(2, 2))
    assert kinds(alone) == [("unit_mismatch", "")]
    assert any("if base is the one that is wrong" in said for said in alone.limits)
    assert kinds(beside) == [("unit_mismatch", wrong)]
    assert beside.data.drive.std() == pytest.approx(from_base(driven_of(shaken(2), SPEC)).drive.std(), rel=0.01)


def test_a_channel_turned_round() -> None:
    found = held(changed(lambda base, mass: (base, -mass)))
    assert kinds(found) == [("polarity", "")]
    assert near(found.data, from_base(driven_of(shaken(2), SPEC))) < 0.01


@pytest.mark.parametrize("samples", [-3, 2, 20])
def test_a_channel_out_of_step(samples: int) -> None:
    found = held(changed(lambda base, mass: (base, np.roll(mass, samples))))
    assert kinds(found) == [("out_of_step", "mass")]
    way = "late" if samples > 0 else "early"
    assert f"{1e3 * abs(samples) / RATE:.2g} ms too {way}" in found.faults[0].detail


def test_channels_exchanged() -> None:
    found = held(changed(lambda base, mass: (mass, base)))
    assert kinds(found) == [("swapped_channels", "base")]
    assert near(found.data, from_base(driven_of(shaken(2), SPEC))) < 0.01


def test_a_damper_to_the_ground_is_no_delay() -> None:
    given = shaken(2)
    w = 2 * np.pi * np.fft.rfftfreq(given.samples.shape[1], 1 / RATE)
    up = OMEGA**2 + 2j * DAMPING * OMEGA * w
    slower = (up - w**2) / (up - w**2 + 2j * 0.1 * OMEGA * w)
    mass = np.fft.irfft(np.fft.rfft(given.samples[1]) * slower, given.samples.shape[1])
    assert held(replace(given, samples=np.vstack([given.samples[0], mass]))).faults == ()


def test_the_answer_with_small_and_large_gains() -> None:

    def answered(gain: float) -> tuple[str, str, tuple[str, ...]]:
        tests = [changed(lambda base, mass: (base, gain * mass), seed) for seed in (1, 2)]
        report = reconcile_driven(SPEC, tests, seed=1)
        return report.verdict, report.sentence, report.where.limits

    verdict, sentence, limits = answered(1.03)
    assert verdict == "nothing_missing", sentence
    assert any("may be the calibration of both" in said for said in limits)
    verdict, sentence, limits = answered(1.1)
    assert verdict == "measurement_fault", sentence
    assert "Apart from it the linear model explains the recordings" in sentence
