"""What a linear model of one steady mass lacks without any law of the motion is told as what it is."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from reconcile.driven import reconcile_driven
from reconcile.report import page, strict_json
from reconcile.verdict import Report
from signals.recording import Recording
from sim.presets import preset
from tests.reconcile.driven.linear import DAMPING, MASS, RATE, STIFFNESS, made, pair

SPEC = preset("oscillator")
FREQUENCY = math.sqrt(STIFFNESS / MASS) / (2 * math.pi)
Change = Callable[[np.ndarray], np.ndarray]


@pytest.fixture(scope="module")
def baseline() -> Recording:
    return made(900)


@pytest.fixture(scope="module")
def sound() -> list[Recording]:
    return pair(910)


def moved(several: list[Recording], change: Change) -> list[Recording]:
    """With another motion channel; `change` keeps its length or cuts its end off."""
    found = []
    for one in several:
        motion = change(one.samples[1])
        found.append(replace(one, samples=np.vstack([one.samples[0][: motion.size], motion])))
    return found


def stage(report: Report, name: str) -> dict[str, object]:
    return next(dict(s) for s in report.stages if s.get("stage") == name)


def drawn(report: Report, which: str) -> float:
    """Root mean square of the error curve of the held-out stretch."""
    (error,) = [dict(t) for t in report.pictures["traces"] if "Error" in t["title"]]  # type: ignore[attr-defined]
    return float(np.sqrt(np.mean(np.square(error[which]))))


@pytest.mark.slow
def test_a_sound_oscillator_has_nothing_missing(sound: list[Recording], baseline: Recording) -> None:
    report = reconcile_driven(SPEC, sound, [baseline])
    assert report.verdict == "nothing_missing"
    assert not report.causes
    assert not report.measurement_faults
    assert stage(report, "baseline")["changed"] == {}


@pytest.mark.slow
@pytest.mark.parametrize("with_baseline", [True, False])
def test_an_unmeasured_force_of_one_frequency_is_told_with_it(baseline: Recording, with_baseline: bool) -> None:
    """12 N at 27.4 Hz on the mass, which no channel holds."""
    tests = pair(920, lambda _x, _v, t: -12.0 * math.cos(2 * math.pi * 27.4 * t))
    report = reconcile_driven(SPEC, tests, [baseline] if with_baseline else [])
    assert report.verdict == "unknown_physics"
    assert "27.4 Hz" in report.sentence
    force = float(report.sentence.partition("a force of ")[2].split(" N")[0])
    assert force == pytest.approx(12.0, rel=0.1)
    assert not report.measurement_faults


@pytest.mark.slow
def test_hum_on_the_motion_alone_is_the_measurement(sound: list[Recording], baseline: Recording) -> None:
    report = reconcile_driven(
        SPEC,
        moved(sound, lambda x: x + 0.3 * x.std() * np.sin(2 * np.pi * 50.0 * np.arange(x.size) / RATE)),
        [baseline],
    )
    assert report.verdict == "measurement_fault"
    assert report.fault is not None
    assert report.fault.kind == "mains_hum"


@pytest.mark.slow
@pytest.mark.parametrize(("samples", "words"), [(4, "4 ms too late"), (-5, "5 ms too early")])
def test_channels_out_of_step_are_told_by_how_much(sound: list[Recording], samples: int, words: str) -> None:
    report = reconcile_driven(SPEC, moved(sound, lambda x: np.roll(x, samples)))
    assert report.verdict == "measurement_fault"
    assert report.fault is not None
    assert report.fault.kind == "out_of_step"
    assert words in report.fault.detail


@pytest.mark.slow
def test_a_velocity_described_as_a_displacement_is_told(sound: list[Recording], baseline: Recording) -> None:
    report = reconcile_driven(SPEC, moved(sound, lambda x: np.gradient(x, 1 / RATE)), [baseline])
    assert report.verdict == "measurement_fault"
    assert report.fault is not None
    assert report.fault.kind == "other_motion"
    assert "is a velocity, not a displacement" in report.fault.detail


@pytest.mark.slow
def test_a_zero_that_wanders_is_told(sound: list[Recording], baseline: Recording) -> None:
    report = reconcile_driven(SPEC, moved(sound, lambda x: x + np.linspace(0, 2, x.size) * x.std()), [baseline])
    assert report.verdict == "measurement_fault"
    assert report.fault is not None
    assert report.fault.kind == "drift"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("extra", "kind", "hz", "size"),
    [
        (lambda x, _v, t: 0.15 * STIFFNESS * math.cos(2 * math.pi * 6.0 * t) * x, "stiffness", 6.0, 0.15),
        (lambda _x, v, t: 0.5 * DAMPING * math.cos(2 * math.pi * 4.0 * t) * v, "damping", 4.0, 0.5),
        (lambda x, _v, t: 0.04 * STIFFNESS * t * x, "stiffness", 0.0, 0.12),
    ],
)
def test_what_varies_while_it_is_recorded_is_told(
    baseline: Recording, extra: Callable[[float, float, float], float], kind: str, hz: float, size: float
) -> None:
    """The drift: 4 % a second over a fitted stretch of 3 s."""
    report = reconcile_driven(SPEC, pair(940, extra), [baseline])
    assert report.verdict == "unknown_physics"
    found = stage(report, "varies")
    assert found["kind"] == kind
    assert found["hz"] == pytest.approx(hz, abs=0.05)
    assert found["size"] == pytest.approx(size, rel=0.3)
    assert "varies while it is recorded" in report.sentence
    assert strict_json(report)


@pytest.mark.slow
@pytest.mark.parametrize("noise", [0.01, 0.2])
def test_a_second_resonance_is_told_with_its_frequency(baseline: Recording, noise: float) -> None:
    """Both by the eigenvalues of the two masses; at 20 % noise most of what is left is noise."""
    mass, spring = 0.15, 25e3
    stiffness = np.array([[STIFFNESS + spring, -spring], [-spring, spring]])
    own = np.sqrt(np.sort(np.linalg.eigvals(stiffness / np.array([[MASS], [mass]])).real)) / (2 * np.pi)
    report = reconcile_driven(SPEC, pair(950, hung=(mass, spring, 1.5), noise=noise), [baseline])
    assert report.verdict == "unknown_physics"
    found = stage(report, "second_resonance")
    assert sorted([found["first_hz"], found["second_hz"]]) == pytest.approx(own, rel=0.01)
    assert report.held_out is not None
    assert report.held_out.gain_low > 0.1
    assert drawn(report, "after") < drawn(report, "before"), "the curves are of one and of two resonances"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("numbers", "name"),
    [
        ((MASS, 0.85 * STIFFNESS, DAMPING), "stiffness"),
        ((1.1 * MASS, STIFFNESS, DAMPING), "mass"),
        ((MASS, STIFFNESS, 1.4 * DAMPING), "damping"),
    ],
)
def test_a_change_against_the_baseline_is_an_explained_one(
    baseline: Recording, numbers: tuple[float, float, float], name: str
) -> None:
    report = reconcile_driven(SPEC, pair(960, numbers=numbers), [baseline])
    assert report.verdict == "explained"
    (cause,) = report.causes
    assert cause.named
    assert cause.severity is not None
    assert cause.severity.name == name
    truth = {"mass": numbers[0], "stiffness": numbers[1], "damping": numbers[2]}[name]
    assert cause.severity.low < truth < cause.severity.high
    assert report.held_out is not None
    assert report.held_out.after < 0.02 < report.held_out.before
    assert drawn(report, "before") > 3.0 * drawn(report, "after"), "the curves are the baseline's and its own"
    assert report.where.sites[0].site == "mass"
    assert page(report).startswith("<!doctype html>")
    assert strict_json(report)


@pytest.mark.slow
def test_mass_and_spring_that_change_alike_are_not_told_from_a_sensitivity(baseline: Recording) -> None:
    report = reconcile_driven(SPEC, pair(970, numbers=(1.15 * MASS, 1.15 * STIFFNESS, 1.15 * DAMPING)), [baseline])
    assert report.verdict == "ambiguous"
    assert not any(c.named for c in report.causes)
    assert "sensitivity" in report.undecidable[-1]


@pytest.mark.slow
def test_a_weak_law_is_still_named_beside_an_unchanged_baseline(baseline: Recording) -> None:
    """What comes back is the law, and no change of the oscillator beside it."""
    tests = pair(980, lambda x, _v, _t: 0.2 * STIFFNESS * x**3 / 1e-6)
    report = reconcile_driven(SPEC, tests, [baseline])
    assert report.verdict == "explained"
    assert report.causes[0].term == "cubic_support"
    assert not any("not the baseline's" in said for said in report.undecidable)
