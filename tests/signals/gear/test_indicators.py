"""Indicators against known values, against sums written out, and their invariances."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import kurtosis

from signals.gear import fm0, gear_indicators, mesh_envelope, normalised_moment, quasi_kurtosis
from signals.series import FloatArray
from signals.synchronous import SynchronousAverage, separate
from sim.core.errors import SpecError

TEETH, M = 23, 1024


def mean_turn(samples: FloatArray, unit: str = "m/s^2") -> SynchronousAverage:
    return SynchronousAverage(
        samples=samples, unit=unit, shaft="input", revolutions=50, mean_speed_hz=25.0, scatter_rms=0.1
    )


def gear(fault: float = 0.0, noise: float = 0.02, shift: int = 0, seed: int = 0) -> SynchronousAverage:
    """Mesh with two harmonics and a first sideband pair, noise, and one tooth's burst of height `fault`."""
    angle = 2 * np.pi * np.arange(M) / M
    x = np.cos(TEETH * angle) * (1 + 0.2 * np.cos(angle)) + 0.4 * np.cos(2 * TEETH * angle + 1)
    place = np.arange(M) - 400
    burst = np.where(place >= 0, np.exp(-place / 8.0) * np.sin(0.9 * place), 0.0)
    x = x + fault * burst + noise * np.random.default_rng(seed).standard_normal(M)
    return mean_turn(np.roll(x, shift))


@pytest.mark.slow
def test_gaussian_difference_has_the_gaussian_moments() -> None:
    found = gear_indicators(mean_turn(np.random.default_rng(4).standard_normal(2**18)), teeth=[TEETH])
    assert found.fm4 == pytest.approx(3, rel=0.02)
    assert found.m6a == pytest.approx(15, rel=0.05)
    assert found.m8a == pytest.approx(105, rel=0.12)
    assert found.na4 == pytest.approx(3, rel=0.02)


def test_sine_has_the_sine_s_moments() -> None:
    """Means of sin^4, sin^6, sin^8 (3/8, 5/16, 35/128) over powers of 1/2: 1.5, 2.5, 4.375."""
    sine = np.sin(2 * np.pi * 7 * np.arange(M) / M)
    assert [normalised_moment(sine, p) for p in (4, 6, 8)] == pytest.approx([1.5, 2.5, 4.375], rel=1e-9)
    assert normalised_moment(np.ones(8), 4) is None


def test_pure_mesh_has_fm0_by_hand() -> None:
    """One line of amplitude A: peak to peak 2A over A. Two in phase: |1 + c| extremes over 1 + c."""
    angle = 2 * np.pi * np.arange(M * TEETH) / (M * TEETH)
    one = separate(mean_turn(3.0 * np.cos(TEETH * angle)), teeth=[TEETH])
    assert fm0(one) == pytest.approx(2.0, rel=1e-4)
    two = separate(mean_turn(np.cos(TEETH * angle) + 0.5 * np.cos(2 * TEETH * angle)), teeth=[TEETH])
    # maximum 1.5 at 0; minimum at cos = -1/2: -0.5 - 0.25 = -0.75
    assert fm0(two) == pytest.approx((1.5 + 0.75) / 1.5, rel=1e-4)
    perfect = gear_indicators(mean_turn(np.cos(TEETH * angle)), teeth=[TEETH])
    assert perfect.fm4 is None and perfect.na4 is None, "rounding has no shape"


def test_formulas_written_out() -> None:
    """The published sums, from a difference signal made by a projection instead of by transforms."""
    average = gear(fault=0.5)
    x = average.samples
    angle = 2 * np.pi * np.arange(M) / M
    mesh = list(range(TEETH, M // 2, TEETH))
    orders = {0, 1, 2, *mesh}
    with_sidebands = orders | {k + s for k in mesh for s in (-1, 1)}

    def without(kept: set[int]) -> FloatArray:
        columns = [f(k * angle) for k in sorted(kept) for f in ((np.cos,) if k == 0 else (np.cos, np.sin))]
        basis = np.array(columns).T
        return x - basis @ np.linalg.lstsq(basis, x, rcond=None)[0]

    d, r = without(with_sidebands), without(orders)
    found = gear_indicators(average, teeth=[TEETH])
    s2 = np.sum((d - d.mean()) ** 2)
    assert found.fm4 == pytest.approx(M * np.sum((d - d.mean()) ** 4) / s2**2, rel=1e-6)
    assert found.m6a == pytest.approx(M**2 * np.sum((d - d.mean()) ** 6) / s2**3, rel=1e-6)
    assert found.m8a == pytest.approx(M**3 * np.sum((d - d.mean()) ** 8) / s2**4, rel=1e-6)
    assert found.na4 == pytest.approx(kurtosis(r, fisher=False), rel=1e-6)
    amplitudes = [2 / M * abs(np.sum(x * np.exp(-1j * k * angle))) for k in mesh]
    assert found.fm0 == pytest.approx(np.ptp(x) / sum(amplitudes), rel=1e-9)


def test_na4_averages_the_variance_over_runs() -> None:
    runs = [np.random.default_rng(i).standard_normal(500) * s for i, s in enumerate((1.0, 1.2, 3.0))]
    *before, now = runs
    mean_square = np.mean([np.sum((r - r.mean()) ** 2) for r in runs])
    expected = 500 * np.sum((now - now.mean()) ** 4) / mean_square**2
    assert quasi_kurtosis(now, before) == pytest.approx(expected, rel=1e-12)
    assert quasi_kurtosis(now) == pytest.approx(kurtosis(now, fisher=False), rel=1e-12)


def test_indicators_rise_with_a_tooth_s_fault() -> None:
    healthy = [gear(seed=i) for i in range(4)]
    found = [gear_indicators(gear(fault=f, seed=9), teeth=[TEETH], earlier=healthy) for f in (0.0, 0.1, 0.3, 0.6)]
    for name in ("fm4", "m6a", "m8a", "na4"):
        values = [getattr(f, name) for f in found]
        assert values == sorted(values) and values[-1] > 1.2 * values[0], (name, values)
    assert found[0].fm4 == pytest.approx(3, abs=0.5)
    # FM4 saturates once the burst is all there is; NA4 goes on: that is what it was made for
    big = gear_indicators(gear(fault=1.2, seed=9), teeth=[TEETH], earlier=healthy)
    assert big.fm4 is not None and found[3].fm4 is not None and big.na4 is not None and found[3].na4 is not None
    assert big.na4 / found[3].na4 > 1.5 * big.fm4 / found[3].fm4


def test_nb4_rises_when_the_modulation_of_the_mesh_grows() -> None:
    angle = 2 * np.pi * np.arange(M) / M
    drop = np.exp(-(((angle - 2.0) / 0.15) ** 2))  # one tooth and its neighbours carry less

    def run(depth: float, seed: int) -> SynchronousAverage:
        mesh = np.cos(TEETH * angle) * (1 - depth * drop) + 0.02 * np.random.default_rng(seed).standard_normal(M)
        return mean_turn(mesh)

    healthy = [run(0.02, i) for i in range(4)]
    values = [gear_indicators(run(d, 9), teeth=[TEETH], earlier=healthy).nb4 for d in (0.02, 0.1, 0.3, 0.6)]
    assert values == sorted(values) and values[-1] > 10 * values[0], values


def test_envelope_of_an_amplitude_modulated_mesh() -> None:
    angle = 2 * np.pi * np.arange(M) / M
    modulation = 1 + 0.3 * np.cos(3 * angle)
    parts = separate(mean_turn(2 * modulation * np.cos(TEETH * angle)), teeth=[TEETH])
    assert np.max(np.abs(mesh_envelope(parts) - 2 * modulation)) < 1e-9


@pytest.mark.slow
@given(
    scale=st.floats(1e-6, 1e6),
    shift=st.integers(0, M - 1),
    flip=st.booleans(),
    fault=st.floats(0, 2),
    seed=st.integers(0, 50),
)
def test_scale_sign_and_origin_change_no_indicator(
    scale: float, shift: int, flip: bool, fault: float, seed: int
) -> None:
    plain = gear(fault=fault, seed=seed)
    moved = mean_turn(np.roll(plain.samples, shift) * (-scale if flip else scale))
    one, other = (gear_indicators(a, teeth=[TEETH]) for a in (plain, moved))
    for name in ("fm0", "fm4", "m6a", "m8a", "na4", "nb4"):
        assert getattr(other, name) == pytest.approx(getattr(one, name), rel=1e-7), name
    assert other.difference.rms == pytest.approx(one.difference.rms * scale, rel=1e-7)


def test_runs_in_another_unit_are_refused() -> None:
    with pytest.raises(SpecError, match="unit"):
        gear_indicators(gear(), teeth=[TEETH], earlier=[mean_turn(gear().samples, unit="g")])
