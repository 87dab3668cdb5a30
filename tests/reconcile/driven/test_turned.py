"""Polarity and sampling rate against a baseline, a delay beside a law, a cut-off motion that no law explains."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import scipy

from reconcile.driven import reconcile_driven
from reconcile.driven.channels import Driven, driven_of
from reconcile.driven.faulty import held_against
from reconcile.driven.machine import driven_site
from reconcile.driven.measured import OPPOSITE, clocked, look, remarks, turned_against
from reconcile.driven.model import Model
from reconcile.driven.spoiled import mended, proved, with_bad
from reconcile.driven.step import BESIDE_A_LAW, responded, stepped
from signals.recording import Recording
from sim.presets import preset
from tests.reconcile.driven.made import DAMPING, FREQUENCY, MASS, RATE

pytestmark = pytest.mark.slow  # oscillators are integrated

SPEC = preset("oscillator")
SITE = driven_site(SPEC)
W = 2 * np.pi * FREQUENCY
MOTION = 1


def data(one: Recording) -> Driven:
    return driven_of(one, SPEC)


def turned(one: Recording) -> Recording:
    samples = one.samples.copy()
    samples[MOTION] *= -1.0
    return replace(one, samples=samples)


def late(one: Recording, samples: int) -> Recording:
    moved = one.samples.copy()
    moved[MOTION, samples:] = one.samples[MOTION, :-samples]
    return replace(one, samples=moved)


def test_a_sign_that_is_not_the_baselines_is_said_and_put_right(linear: Recording, sound: Recording) -> None:
    held = held_against([data(turned(linear)), data(linear)], [data(sound)], SITE)
    assert [(f.kind, f.recordings) for f in held.faults] == [("polarity", ("test 1",))]
    assert np.allclose(held.data[0].answer, linear.samples[MOTION])
    report = reconcile_driven(SPEC, [turned(linear)], [sound], seed=1)
    assert report.verdict == "measurement_fault"
    assert "by baseline 1 displacement or force has the opposite sign" in report.sentence
    assert not turned_against(look(data(linear)), look(data(sound)))


def test_without_a_baseline_a_negative_mass_is_a_remark(linear: Recording) -> None:
    assert remarks([look(data(turned(linear)))], SITE) == (OPPOSITE,)
    assert OPPOSITE not in remarks([look(data(linear))], SITE)


@pytest.mark.parametrize("factor", [2.0, 0.5])
def test_a_sampling_rate_that_is_not_the_true_one(linear: Recording, sound: Recording, factor: float) -> None:
    wrong = replace(linear, sampling_rate_hz=factor * RATE)
    report = reconcile_driven(SPEC, [wrong], [sound], seed=1)
    assert report.verdict == "measurement_fault"
    assert report.fault is not None and report.fault.kind == "sampling_rate"
    assert f"the sampling rate is {RATE:g} Hz, not {factor * RATE:g} Hz" in report.sentence


@pytest.mark.parametrize("order", [0, 1, 2])
def test_only_a_wrong_rate_turns_all_three_numbers(linear: Recording, order: int) -> None:
    quantity = ("displacement", "velocity", "acceleration")[order]
    given = data(linear)
    shown = replace(given, answer_channel=replace(given.answer_channel, quantity=quantity))
    rested = replace(look(given), data=shown)
    s, d, g = rested.model.stiffness, rested.model.damping, rested.model.gain

    def of(stiffness: float, damping: float, gain: float) -> float | None:
        return clocked(replace(rested, model=Model(stiffness=stiffness, damping=damping, gain=gain)), rested)

    assert of(4 * s, 2 * d, g * 2.0 ** (2 - order)) == 2.0
    assert of(4 * s, d, g * 2.0 ** (2 - order)) is None, "another spring keeps the damping"
    assert of(4 * s, 2 * d, 0.7 * g * 2.0 ** (2 - order)) is None
    assert of(s, d, g) is None


def test_tests_of_which_one_has_a_wrong_rate_are_not_judged_together(linear: Recording, sound: Recording) -> None:
    given, twice = data(linear), 0.5 / RATE
    fine = scipy.signal.resample(linear.samples, 2 * linear.samples.shape[1], axis=1)
    right = replace(given, step_s=twice, drive=np.ascontiguousarray(fine[0]), answer=np.ascontiguousarray(fine[1]))
    held = held_against([replace(given, step_s=twice), right], [data(sound)], SITE)
    assert [(f.kind, f.recordings) for f in held.faults] == [("sampling_rate", ("test 1",))]
    assert held.undecided
    alike = held_against([replace(given, step_s=twice)] * 2, [data(sound)], SITE)
    assert not alike.undecided
    assert {round(1 / d.step_s) for d in alike.data} == {round(RATE)}


def test_a_delay_is_told_beside_a_law(stiffening: Recording, linear: Recording) -> None:
    one = look(data(late(stiffening, 2)))
    found = stepped(one, "test 1")
    assert found is not None, "a linear model leaves as much in step: the law is still missing"
    straight, fault = found
    assert (fault.kind, fault.channel) == ("out_of_step", "displacement")
    assert straight.left > 0.5 * one.left
    moved = (
        np.argmax(np.correlate(stiffening.samples[MOTION], straight.data.answer, "full")) - straight.data.answer.size
    )
    assert abs(moved + 1 - 24) <= 1, "within half a sample of where it was, less the ends"
    assert stepped(look(data(stiffening)), "test 1") is None
    seen = responded(data(stiffening))
    assert seen.left(0, 1.0 / RATE) > BESIDE_A_LAW * seen.left(0, 0.0)


def test_a_motion_cut_off_that_nothing_explains_is_at_fault(stiffening: Recording) -> None:
    samples = stiffening.samples.copy()
    samples[MOTION] = np.maximum(samples[MOTION], -1.2 * samples[MOTION].std())
    read = mended(replace(stiffening, samples=samples), "test 1")
    given = with_bad(data(read.recording), read)
    model = Model(stiffness=W * W, damping=2 * DAMPING * W, gain=1 / MASS)
    assert [f.kind for f in proved(read.findings, [given], model, False, True)] == ["clipped"]
    bad = Model(stiffness=0.1 * W * W, damping=2 * DAMPING * W, gain=1 / MASS)
    assert not proved(read.findings, [given], bad, False), "a tank that overflows is cut off too"
    free = mended(stiffening, "test 1")
    assert not proved(free.findings, [data(stiffening)], model, False, True)
