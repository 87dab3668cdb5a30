"""Force and motion a part of a sample apart: put in step and said, and no second resonance is told for it."""

from __future__ import annotations

import math

import numpy as np
import pytest

from reconcile.driven import reconcile_driven
from reconcile.driven.channels import driven_of
from reconcile.driven.measured import look
from reconcile.driven.skew import Skew, skewed
from signals.recording import Recording
from sim.core.response import Channel
from sim.core.spec import MachineSpec
from sim.presets import preset
from tests.reconcile.driven.linear import made

RATE, SAMPLES, TOP_HZ = 1000.0, 8000, 150.0
MASS, STIFFNESS, DAMPING = 1.07, 0.95e5, 33.0
CHANNELS = (
    Channel(name="force", quantity="force", unit="N", location="input"),
    Channel(name="motion", quantity="displacement", unit="m", location="output"),
)
SPEC = MachineSpec.model_validate(preset("oscillator").model_dump(mode="json"))
Hung = tuple[float, float, float]
"""Mass, kg, and frequency, Hz, of a second mass on the first, and its damping ratio."""


def apart(
    samples: float, noise: float, seed: int, hung: Hung | None = None, relaxing: tuple[float, float] | None = None
) -> Recording:
    """A mass on a spring by its frequency response, its motion so many samples late; white noise on the motion."""
    rng = np.random.default_rng(seed)
    n = 8 * SAMPLES  # periodic; a part in the middle is cut out
    hz = np.fft.rfftfreq(n, 1.0 / RATE)
    lines = np.where((hz > 0.0) & (hz < TOP_HZ), np.exp(2j * np.pi * rng.uniform(size=hz.size)), 0.0)
    omega = 2.0 * np.pi * hz
    below = STIFFNESS - MASS * omega**2 + 1j * omega * DAMPING
    if hung is not None:
        mass, own = hung[0], 2.0 * math.pi * hung[1]
        spring = mass * (own**2 + 2j * hung[2] * own * omega)
        below = below + spring - spring**2 / (spring - mass * omega**2)
    if relaxing is not None:
        late = 1j * omega * relaxing[1]
        below = below + relaxing[0] * late / (1.0 + late)
    there = slice(SAMPLES, 2 * SAMPLES)
    force, motion = (np.fft.irfft(x, n)[there] for x in (lines, lines / below * np.exp(-1j * omega * samples / RATE)))
    size = 20.0 / force.std()
    motion = motion + noise * motion.std() * rng.normal(size=SAMPLES)
    return Recording(sampling_rate_hz=RATE, channels=CHANNELS, samples=size * np.stack([force, motion]))


def second_hz(sentence: str) -> float:
    return float(sentence.partition("Hz one at ")[2].partition(" Hz")[0])


def put_in_step(one: Recording) -> Skew | None:
    return skewed(look(driven_of(one, SPEC)))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("samples", "noise"), [(0.0625, 0.001), (-0.1, 0.003), (0.1, 0.01), (-0.25, 0.01), (0.5, 0.001), (1.2, 0.003)]
)
def test_a_delay_is_measured_and_leaves_the_noise_alone(samples: float, noise: float) -> None:
    found = put_in_step(apart(samples, noise, 3))
    assert found is not None
    assert found.samples == pytest.approx(samples, abs=0.02 * abs(samples) + 0.1 * noise)
    assert found.look.left == pytest.approx(noise, rel=0.15)
    assert found.before > 1.3 * found.after


@pytest.mark.slow
def test_in_step_or_with_a_second_mass_there_is_no_delay() -> None:
    assert put_in_step(apart(0.0, 0.001, 3)) is None
    for hung in ((0.1, 60.0, 0.02), (0.05, 50.0, 0.08), (0.02, 55.0, 0.08), (0.3, 100.0, 0.05)):
        assert put_in_step(apart(0.0, 0.003, 5, hung)) is None, hung


@pytest.mark.slow
@pytest.mark.parametrize(("samples", "noise", "rested"), [(0.25, 0.01, False), (-0.1, 0.003, True)])
def test_a_sound_mass_a_part_of_a_sample_late_lacks_nothing(samples: float, noise: float, rested: bool) -> None:
    baselines = [apart(samples, noise, 7)] if rested else []
    report = reconcile_driven(SPEC, [apart(samples, noise, 14)], baselines)
    assert report.verdict == "nothing_missing"
    assert not report.measurement_faults
    (remark,) = [x for x in report.where.limits if "of a sample" in x]
    assert f"{abs(samples):.2g} of a sample" in remark
    assert f"too {'late' if samples > 0 else 'early'} for force" in remark


@pytest.mark.slow
def test_a_sample_and_more_is_a_fault_of_the_measurement_however_little_it_leaves() -> None:
    one = made(910, n=8000, numbers=(1.2, 8e3, 25.0), noise=0.002)  # 13 Hz: 1.2 samples leave less than a tenth
    shifted = np.fft.irfft(
        np.fft.rfft(one.samples[1]) * np.exp(-2j * np.pi * 1.2 * np.fft.rfftfreq(one.samples.shape[1])),
        one.samples.shape[1],
    )
    samples = np.stack([one.samples[0], shifted])[:, 100:-100]
    late = Recording(sampling_rate_hz=RATE, channels=one.channels, samples=samples)
    assert look(driven_of(late, SPEC)).left < 0.1
    report = reconcile_driven(SPEC, [late])
    assert report.verdict == "measurement_fault"
    assert report.fault is not None
    assert report.fault.kind == "out_of_step"
    assert "1.2 ms too late" in report.fault.detail


@pytest.mark.slow
@pytest.mark.parametrize(("samples", "hung"), [(0.0, (0.1, 60.0, 0.02)), (0.1, (0.05, 40.0, 0.05))])
def test_a_second_mass_stays_told_beside_a_delay_but_for_one_of_the_baseline(samples: float, hung: Hung) -> None:
    test = apart(samples, 0.003, 5, hung)
    report = reconcile_driven(SPEC, [test], [apart(samples, 0.003, 9)])
    assert report.verdict == "unknown_physics"
    assert "second resonance" in report.sentence
    alike = reconcile_driven(SPEC, [test], [apart(samples, 0.003, 9, hung)])
    assert alike.verdict == "nothing_missing"
    assert "both have a second resonance" in alike.sentence


@pytest.mark.slow
@pytest.mark.parametrize("ratio", [0.02, 0.05])
def test_a_faint_second_mass_is_found_at_its_place_beside_a_delay(ratio: float) -> None:
    report = reconcile_driven(SPEC, [apart(0.1, 0.003, 5, (0.02, 100.0, ratio))])
    assert report.verdict == "unknown_physics"
    assert second_hz(report.sentence) == pytest.approx(101.4, rel=0.02), "not where the delay turns the phase"
    assert any("of a sample" in x for x in report.where.limits)


@pytest.mark.slow
def test_a_mount_that_relaxes_is_no_delay() -> None:
    """A spring of 40 kN/m with a damper in series, beside the spring: it turns the phase as a delay does, not alike."""
    one = apart(0.0, 0.005, 8, relaxing=(4e4, 3e-3))
    assert look(driven_of(one, SPEC)).left > 0.04
    assert put_in_step(one) is None
    assert reconcile_driven(SPEC, [one]).verdict == "not_decidable"
