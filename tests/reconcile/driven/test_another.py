"""The oscillator against its baseline: a unit beside a change, and a baseline that shows more than the tests."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from reconcile.driven import reconcile_driven
from reconcile.driven.channels import driven_of
from reconcile.driven.measured import look, scaled
from signals.recording import Recording
from sim.presets import preset
from tests.reconcile.driven.linear import DAMPING, MASS, STIFFNESS, made, pair

SPEC = preset("oscillator")


@pytest.fixture(scope="module")
def baseline() -> Recording:
    return made(900)


def larger(one: Recording, factor: float) -> Recording:
    """The motion times a factor, as of another unit."""
    samples = one.samples.copy()
    samples[1] *= factor
    return replace(one, samples=samples)


@pytest.mark.slow
def test_a_unit_is_told_beside_a_changed_spring(baseline: Recording) -> None:
    tests = [larger(one, 1e3) for one in pair(930, numbers=(MASS, 1.15 * STIFFNESS, DAMPING))]
    report = reconcile_driven(SPEC, tests, [baseline])
    assert report.verdict == "explained"
    assert {(f.kind, f.channel) for f in report.measurement_faults} == {("unit_mismatch", "x")}
    size = report.causes[0].severity
    assert size is not None and size.name == "stiffness" and size.low < 1.15 * STIFFNESS < size.high


@pytest.mark.slow
@pytest.mark.parametrize(("factor", "told"), [(1.0, False), (4.0, False), (1e3, True), (1e-3, True)])
def test_a_unit_is_told_of_a_motion_that_no_linear_model_fits(baseline: Recording, factor: float, told: bool) -> None:
    """Levels and gains tell a thousand, though not a factor that a law may make."""
    cubic = made(940, lambda x, _v, _t: 12.0 * STIFFNESS * x**3 / 1e-6)
    one = look(driven_of(larger(cubic, factor), SPEC))
    assert one.left > 0.5
    found = scaled(one, look(driven_of(baseline, SPEC)))
    assert (found is not None) == told
    assert found is None or (found.factor == factor and found.drives is False and found.unit)


@pytest.mark.slow
def test_a_baseline_that_lacks_a_law_is_not_taken_for_the_sound_machine() -> None:
    cubic = made(950, lambda x, _v, _t: STIFFNESS * x**3 / 1e-6)
    report = reconcile_driven(SPEC, pair(955), [cubic])
    assert report.verdict == "not_decidable"
    assert "exchanged" in report.sentence and not report.causes and report.machine is None


@pytest.mark.slow
def test_a_noisy_baseline_lacks_nothing() -> None:
    assert reconcile_driven(SPEC, pair(957), [made(958, noise=0.3)]).verdict == "nothing_missing"


@pytest.mark.slow
def test_a_mass_that_friction_holds_is_no_dropout(baseline: Recording) -> None:
    """It stands still while the force acts, and so does the model with friction."""
    tests = pair(960, lambda _x, v, _t: 22.0 * math.tanh(v / 2e-4), noise=0.001, n=5000)
    report = reconcile_driven(SPEC, tests, [baseline])
    assert report.verdict == "explained" and report.causes[0].term == "coulomb_friction"
    assert not report.measurement_faults
