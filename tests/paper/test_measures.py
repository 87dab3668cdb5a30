"""Measures of signals whose lines and modulation are known in closed form."""

from __future__ import annotations

import numpy as np
import pytest

from paper.measure.envelopes import slow, turning_points
from paper.measure.lines import levels, line, without_periodic
from paper.measure.mean import PairLaw, mean_stiffness
from paper.measure.mesh import extremes
from paper.measure.window import FloatArray, Window

F_R1, TEETH, PER_MESH, F_O1, REVOLUTIONS = 30.0, 23, 90, 77.2065, 24
RATE = F_R1 * TEETH * PER_MESH
COUNT = REVOLUTIONS * TEETH * PER_MESH


def tone(amplitude: float, frequency_hz: float, phase: float = 0.0) -> FloatArray:
    return np.asarray(amplitude * np.cos(2 * np.pi * frequency_hz * np.arange(COUNT) / RATE + phase))


def test_line_reads_amplitude_and_phase_off_the_bins() -> None:
    found = line(3.0 + tone(2.0, F_O1, 0.7), RATE, F_O1)
    assert abs(found) == pytest.approx(2.0, rel=1e-4)
    assert np.angle(found) == pytest.approx(0.7, abs=1e-3)


def test_shaft_multiples_do_not_leak_into_nine_f_o1() -> None:
    rest = without_periodic(tone(1.0, 690.0) + tone(0.3, 660.0), TEETH * PER_MESH)
    assert abs(line(rest, RATE, 9 * F_O1)) < 1e-12


def test_a_line_in_noise_is_present_and_noise_is_not() -> None:
    noise = np.random.default_rng(1).normal(0.0, 0.1, COUNT)
    spectrum = levels(tone(1.0, 690.0) + tone(0.02, F_O1) + noise, RATE)
    assert spectrum.present(0.02, F_O1)
    assert not spectrum.present(1e-4, 1000.0)
    assert not spectrum.present(5e-5, 20_000.0)


def test_slow_curve_finds_its_modulation() -> None:
    periods = REVOLUTIONS * TEETH
    curve = 1.0 + 0.02 * np.cos(2 * np.pi * F_O1 / 690.0 * np.arange(periods))
    found = slow(curve, f_m_hz=690.0, f_r1_hz=F_R1, f_o1_hz=F_O1)
    assert found.at_f_o1 == pytest.approx(0.02, rel=1e-3)
    assert found.largest_hz == pytest.approx(F_O1, abs=1.25)


def test_turning_points_count_only_large_swings() -> None:
    t = np.arange(2000) / 2000
    values = np.sin(2 * np.pi * 5 * t) + 0.01 * np.sin(2 * np.pi * 200 * t)
    assert turning_points(values, 0.1).size == pytest.approx(10, abs=1)
    assert turning_points(np.zeros(100), 0.1).size == 0


def test_extremes_of_a_square_stiffness_lie_at_its_jumps() -> None:
    phase = (np.arange(COUNT) % PER_MESH + 0.5) / PER_MESH
    k = np.where(phase < 0.7, 4e8, 2.5e8) + 1e6 * np.cos(2 * np.pi * phase)
    window = Window(signals={"k": k}, per_mesh=PER_MESH, teeth=TEETH, f_r1_hz=F_R1, f_o1_hz=F_O1)
    count, near = extremes(window)
    assert count >= 2.0
    assert near > 0.5


def _law() -> PairLaw:
    x = np.linspace(0.0, 1.0, 101)
    base = 2e8 * (1.0 + 0.4 * np.sin(np.pi * x))
    return PairLaw(
        errors_m=np.array([-1e-4, 0.0, 1e-4]),
        contact_ratio=np.array([1.75, 1.7, 1.65]),
        stiffness_n_per_m=np.vstack([base * 1.02, base, base * 0.98]),
    )


def test_mean_stiffness_is_contact_ratio_times_the_mean_of_a_pair() -> None:
    law = _law()
    expected = 1.7 * np.trapezoid(law.stiffness_n_per_m[1], dx=0.01)
    assert mean_stiffness(law, np.zeros(90 * 200), 90) == pytest.approx(expected, rel=2e-5)


def test_mean_stiffness_resolves_centre_distances_that_sampling_does_not() -> None:
    law = _law()
    values = [mean_stiffness(law, np.full(90 * 200, a), 90) for a in (0.0, 1e-6)]
    slope = (1.65 * 0.98 - 1.7) * np.trapezoid(law.stiffness_n_per_m[1], dx=0.01) / 1e-4
    assert (values[1] - values[0]) / 1e-6 == pytest.approx(slope, rel=0.05)
