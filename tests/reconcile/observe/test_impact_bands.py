"""Impacts in bands: they stand out where their resonance is, at the rate at which they come, and nowhere else."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import fft

from reconcile.observe.impact_bands import Rate, bands_of, density, envelope_power, standing, standings

RATE_HZ, SECONDS = 20480.0, 1.0
COUNT = round(RATE_HZ * SECONDS)
PASSES = Rate(hz=78.0, spacing_hz=30.0, sidebands=0)


def struck(rate_hz: float, carrier_hz: float, size: float, seed: int) -> np.ndarray:
    """Noise of deviation 1 with decaying blows, (n,)."""
    rng = np.random.default_rng(seed)
    time = np.arange(COUNT) / RATE_HZ
    since = time % (1.0 / rate_hz)
    return rng.normal(size=COUNT) + size * np.exp(-since / 1.5e-3) * np.sin(2 * np.pi * carrier_hz * since)


def heard(*signals: np.ndarray, rate: Rate = PASSES):  # type: ignore[no-untyped-def]
    hz = np.fft.rfftfreq(COUNT, 1 / RATE_HZ)
    floor = np.interp(hz, *density(struck(1.0, 1.0, 0.0, 99), RATE_HZ))
    return standing([envelope_power(fft.rfft(s) / np.sqrt(floor), COUNT, RATE_HZ) for s in signals], SECONDS, rate)


def test_the_density_of_white_noise() -> None:
    _, floor = density(np.random.default_rng(1).normal(0.0, 3.0, 4 * COUNT), RATE_HZ)
    assert np.median(floor) == pytest.approx(2 * 9.0 / RATE_HZ, rel=0.05)


def test_blows_stand_out_in_the_band_of_their_resonance() -> None:
    found = heard(struck(78.0, 4500.0, 2.0, 1), struck(78.0, 1200.0, 2.0, 2), struck(78.0, 1200.0, 0.0, 3))
    edges = bands_of(RATE_HZ)
    high, low = edges.index((3800.0, 5500.0)), edges.index((1000.0, 1500.0))
    assert np.argmax(found.level[0]) == high and np.argmax(found.level[1]) == low
    assert found.level[0, high] > 6.0 and found.level[1, low] > 6.0
    assert np.all(np.abs(found.level[2]) < 4 * found.error[2] + 1.0)


def test_several_signals_at_once_are_as_one_by_one() -> None:
    wide = Rate(hz=78.0, spacing_hz=30.0, sidebands=2)
    rows = np.array([fft.rfft(struck(78.0, hz, 2.0, k)) for k, hz in enumerate((900.0, 3000.0, 4500.0))])
    together = standings(
        [envelope_power(rows, COUNT, RATE_HZ), envelope_power(rows[::-1], COUNT, RATE_HZ)], SECONDS, wide
    )
    for k, found in enumerate(together):
        alone = standing([envelope_power(rows[at], COUNT, RATE_HZ) for at in (k, 2 - k)], SECONDS, wide)
        assert found.hz == alone.hz
        assert np.allclose(found.level, alone.level) and np.allclose(found.error, alone.error)
    assert standing([[np.ones(8)]], SECONDS, wide).level.tolist() == [[0.0]], "too narrow a band says nothing"


@pytest.mark.parametrize("slip", [-0.02, 0.0, 0.02])
def test_slip_is_searched(slip: float) -> None:
    found = heard(struck(78.0 * (1 + slip), 3000.0, 2.0, 4))
    assert found.level.max() > 6.0
    assert heard(struck(78.0 * 1.17, 3000.0, 2.0, 4)).level.max() < 4.0, "another rate is none of the part's"


def test_sidebands_count_where_the_load_turns_by() -> None:
    time = np.arange(COUNT) / RATE_HZ
    loaded = struck(78.0, 3000.0, 3.0, 5) * (1.0 + np.cos(2 * np.pi * 30.0 * time))
    wide = Rate(hz=78.0, spacing_hz=30.0, sidebands=2)
    assert wide.lines_hz(np.array([78.0, 79.0])).shape == (2, 30)
    assert heard(loaded, rate=wide).level.max() > 3.0
    assert heard(loaded, rate=Rate(hz=60.0, spacing_hz=21.0, sidebands=2)).level.max() < 3.0


def test_bands_end_with_what_the_rate_holds() -> None:
    assert bands_of(RATE_HZ)[-1][1] == 9600.0
    assert bands_of(8000.0)[-1][1] == 2800.0
