"""Prescribed motion: recordings held against each other, and laws that are no more than the nearest ones."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest

from reconcile.driven import reconcile_driven
from reconcile.driven.channels import Driven, driven_of
from reconcile.driven.prescribed.analysis import Findings
from reconcile.driven.prescribed.faults import doubted_sizes, held_motions
from reconcile.driven.prescribed.resistance import DRAG, ELASTIC, GRADUAL, PLAY, STRUCTURES, Motion, Structure
from reconcile.driven.prescribed.rich import beside_law
from reconcile.driven.prescribed.told import undecided
from reconcile.report.page import page
from signals.recording import Recording
from sim.core.response import Channel
from sim.presets import preset

pytestmark = pytest.mark.slow  # each run of a motion is fitted

RATE = 500.0
SPEC = preset("oscillator")
CHANNELS = (
    Channel(name="displacement", quantity="displacement", unit="m", location="input"),
    Channel(name="force", quantity="force", unit="N", location="output"),
)
MOTION, FORCE = 0, 1


def swing(size_m: float) -> Motion:
    t = np.arange(int(10 * RATE)) / RATE
    x = size_m * np.sin(2 * math.pi * t) * (1 + 0.01 * np.sin(2 * math.pi * 0.07 * t))
    return Motion(displacement=x, velocity=np.gradient(x, 1 / RATE), step_s=1 / RATE)


def recording(size_m: float, *, seed: int = 0, friction_n: float = 0.0, added: np.ndarray | None = None) -> Recording:
    rng, m = np.random.default_rng(seed), swing(size_m)
    force = 4e5 * m.displacement + 2e3 * m.velocity + friction_n * np.tanh(m.velocity / 0.002)
    force = force * 1.0 if added is None else force + force.std() * added
    force = force + 0.01 * force.std() * rng.standard_normal(force.size)
    return Recording(sampling_rate_hz=RATE, channels=CHANNELS, samples=np.vstack([m.displacement, force]))


def times(one: Recording, row: int, factor: float) -> Recording:
    samples = one.samples.copy()
    samples[row] *= factor
    return replace(one, samples=samples)


def data(one: Recording) -> Driven:
    return driven_of(one, SPEC, motion_drives=True)


@pytest.mark.parametrize(
    ("row", "factor", "kind", "channel"),
    [
        (MOTION, 1e3, "unit_mismatch", "displacement"),
        (FORCE, 1e-3, "unit_mismatch", "force"),
        (FORCE, 1 / 4.44822, "unit_mismatch", "force"),
        (FORCE, -1.0, "polarity", ""),
    ],
)
def test_units_and_sign_are_those_of_the_baseline(row: int, factor: float, kind: str, channel: str) -> None:
    tests = [recording(0.008, seed=1, friction_n=300.0), recording(0.012, seed=2, friction_n=300.0)]
    held = held_motions([data(times(t, row, factor)) for t in tests], [data(recording(0.008))])
    assert [(f.kind, f.channel, f.recordings) for f in held.faults] == [
        (kind, channel, ("test 1",)),
        (kind, channel, ("test 2",)),
    ]
    assert not held.undecided
    for right, mended in zip(tests, held.data, strict=True):
        assert np.allclose(mended.drive * mended.answer, right.samples[0] * right.samples[1], rtol=1e-4)
        assert np.allclose(abs(mended.drive), abs(right.samples[0]))


def test_sound_recordings_of_other_amplitudes_and_with_friction_stay_as_they_are() -> None:
    tests = [recording(0.002, seed=1, friction_n=900.0), recording(0.02, seed=2, friction_n=900.0)]
    for rested in ([], [data(recording(0.008))]):
        held = held_motions([data(t) for t in tests], rested)
        assert not held.faults and not held.remarks and not held.undecided


def test_a_large_unit_is_told_though_the_law_changes_the_force() -> None:
    base, test = recording(0.008), recording(0.008, seed=1, friction_n=6000.0)
    held = held_motions([data(times(test, MOTION, 1e3))], [data(base)])
    assert [f.detail for f in held.faults] == [
        "test 1: by baseline 1 displacement is 1000 times too large (mm against m)"
    ]


def test_tests_that_tell_different_units_are_not_put_right() -> None:
    tests = [times(recording(0.008, seed=s), MOTION, f) for s, f in ((1, 1e3), (2, 39.3701))]
    assert held_motions([data(t) for t in tests], [data(recording(0.008))]).undecided


def test_without_a_baseline_one_of_two_tests_is_in_another_unit() -> None:
    report = reconcile_driven(SPEC, [recording(0.008), times(recording(0.012, seed=2), MOTION, 1e3)], seed=1)
    assert report.verdict == "measurement_fault"
    assert "by test 1 displacement is 1000 times too large" in report.sentence
    assert report.undecidable and not report.causes


def test_sizes_that_no_part_has_are_doubted() -> None:
    assert doubted_sizes([data(recording(0.008))]) == ()
    (said,) = doubted_sizes([data(times(recording(0.008), MOTION, 1e3))])
    assert said == "displacement goes over 16.2 m: if that is not so, its unit is wrong, and all sizes with it."
    (said,) = doubted_sizes([data(times(recording(0.008), FORCE, 1e6))])
    assert said.startswith("force reaches")


def test_doubted_sizes_stand_in_the_sentence_of_the_answer() -> None:
    several = [times(recording(size, friction_n=900.0), MOTION, 1e3) for size in (0.008, 0.012)]
    report = reconcile_driven(SPEC, several, seed=1)
    assert "goes over 16.2 m: if that is not so, its unit is wrong" in report.sentence
    assert "its unit is wrong" in report.where.limits[0]


def test_a_zero_that_wanders_is_in_the_gates_findings_once() -> None:
    wandering = np.linspace(0.0, 1.0, int(10 * RATE))
    report = reconcile_driven(SPEC, [recording(size, added=wandering) for size in (0.008, 0.012)], seed=1)
    gates = [s for s in report.stages if s["stage"] == "gate"]
    assert len(gates) == 1
    assert "nothing wrong" not in str(gates[0]) and "its zero wanders" in str(gates[0])
    assert [f.kind for f in report.measurement_faults] == ["drift", "drift"]


def test_lines_that_the_motion_does_not_foretell_are_not_decided() -> None:
    t = np.arange(int(10 * RATE)) / RATE
    report = reconcile_driven(
        SPEC, [recording(size, added=0.2 * np.sin(2 * math.pi * 37.3 * t)) for size in (0.008, 0.012)], seed=1
    )
    assert report.verdict == "not_decidable", report.sentence
    assert "nothing that the motion foretells" in report.sentence
    assert not report.causes and not report.where.sites and report.held_out is None


def falling(m: Motion) -> np.ndarray:
    """Friction that falls with speed."""
    v = m.velocity
    return np.asarray(2e5 * m.displacement + np.tanh(v / 0.001) * (1500 + 1200 * np.exp(-((v / 0.015) ** 2))))


def wandering(size_m: float, seed: int) -> Motion:
    """Random, from 0.3 to 5 Hz."""
    rng = np.random.default_rng(seed)
    n = int(20 * RATE)
    hz = np.fft.rfftfreq(n, 1 / RATE)
    x = np.fft.irfft(np.where((hz > 0.3) & (hz < 5.0), rng.normal(size=hz.size) + 1j * rng.normal(size=hz.size), 0), n)
    x *= size_m / np.max(np.abs(x))
    return Motion(displacement=x, velocity=np.gradient(x, 1 / RATE), step_s=1 / RATE)


def test_what_other_signals_tell_beside_a_law_is_measured() -> None:
    m = wandering(0.012, 3)
    dry = 2e5 * m.displacement + 1700 * np.tanh(m.velocity / 0.002)
    noise = 20.0 * np.random.default_rng(1).standard_normal(dry.size)
    right = beside_law(m, dry + noise, dry, 1000)
    assert right.share < 0.1 and right.size < 0.01
    wrong = beside_law(m, falling(m) + noise, dry, 1000)
    assert wrong.share > 0.5 and wrong.size > 0.05


def test_friction_that_falls_with_speed_is_not_called_dry_friction() -> None:
    runs = []
    for seed, size in ((5, 0.008), (6, 0.012)):
        m = wandering(size, seed)
        force = falling(m)
        force = force + 0.01 * force.std() * np.random.default_rng(seed).standard_normal(force.size)
        runs.append(Recording(sampling_rate_hz=RATE, channels=CHANNELS, samples=np.vstack([m.displacement, force])))
    report = reconcile_driven(SPEC, runs, seed=1)
    assert report.verdict == "unknown_physics", report.sentence
    assert not any(c.named for c in report.causes)
    assert "Nearest comes" in report.sentence or "comes as near as any" in report.sentence
    rows = report.pictures["ranking"]
    assert isinstance(rows, list) and not any(row["named"] for row in rows), "the chart names none either"
    assert len(rows) == len(STRUCTURES) == len({c.score for c in report.causes}), "every law tried is in the table"
    told = page(report)
    assert "the nearest law" in told and "the named law" not in told and "with what comes nearest in it" in told


def found(*errors: tuple[Structure, float]) -> Findings:
    """Structures in the order of the answer with the mean square error each left on the stretch kept for choosing."""
    trials = tuple((SimpleNamespace(structure=s, values={}), np.full(8, error)) for s, error in errors)
    chosen = SimpleNamespace(structure=errors[0][0], values={})
    return cast(Findings, SimpleNamespace(trials=trials, chosen=chosen, rival=None, outcomes=()))


def test_a_wider_law_that_left_less_is_told_beside_the_simpler_one() -> None:
    (said,) = undecided(found((ELASTIC, 1.0), (GRADUAL, 0.7), (PLAY, 0.8), (DRAG, 3.0)))
    assert GRADUAL.words in said and PLAY.words in said and DRAG.words not in said and "not surely less" in said
    assert undecided(found((ELASTIC, 1.0), (PLAY, 1.2))) == ()
