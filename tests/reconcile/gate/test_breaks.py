"""Lost blocks of a recorder show where the signal foretells what follows; blows, even ones, are none."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import butter, sosfilt

from reconcile.gate import inspect_measurement
from reconcile.gate.breaks import break_findings, breaks
from reconcile.gate.spoiled import remarks
from signals.recording import Recording
from signals.series import FloatArray
from tests.strategies.brief import recorded

N = 48_000
GAPS = (5_000, 9_100, 15_530, 17_250, 22_000, 26_310, 33_470, 41_200)


def heard(seed: int, blows: FloatArray | None = None) -> FloatArray:
    """Two sensors at one resonance each, which foretell their next samples well; `blows` (n,) at both, at the first
    more."""
    rng = np.random.default_rng(seed)
    rows = []
    for k, band in enumerate(((0.03, 0.12), (0.05, 0.16))):
        force = rng.standard_normal(N) + (0.0 if blows is None else blows * (1.0, 0.2)[k])
        rows.append(sosfilt(butter(2, band, "bandpass", output="sos"), force) + 1e-3 * rng.standard_normal(N))
    return np.stack(rows)


def cut(rows: FloatArray, size: int = 300) -> Recording:
    kept = np.ones(N, dtype=bool)
    for gap in GAPS:
        kept[gap : gap + size] = False
    return recorded(rows[:, kept])


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_cuts_in_all_channels_are_found_at_their_places(seed: int) -> None:
    found = breaks(cut(heard(seed)))
    expected = np.array(GAPS) - 300 * np.arange(len(GAPS))
    assert len(found) >= 4, found
    assert all(np.min(np.abs(expected - place)) <= 16 for place in found)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_a_whole_record_and_cuts_in_one_channel_are_none(seed: int) -> None:
    rows = heard(seed)
    assert breaks(recorded(rows)) == ()
    one = cut(rows).samples
    assert breaks(recorded(np.stack([rows[0, : one.shape[1]], one[1]]))) == ()
    assert breaks(recorded(one[:1])) == ()


@pytest.mark.parametrize("size", [20.0, 60.0, 200.0])
def test_even_blows_are_none(size: float) -> None:
    blows = np.zeros(N)
    blows[np.arange(700, N, 2300)] = size
    assert breaks(recorded(heard(1, blows))) == ()


def test_noise_that_foretells_nothing_hides_them() -> None:
    assert breaks(cut(np.random.default_rng(1).standard_normal((2, N)))) == ()


@pytest.mark.slow
def test_they_are_a_remark_as_single_knocks_may_be_too() -> None:
    (found,) = break_findings(cut(heard(1)), "test 1")
    assert not found.fault
    gate = inspect_measurement([recorded(heard(2))], [cut(heard(1))])
    assert any("all channels break off at" in text for text in remarks(gate))
    assert not [f for f in inspect_measurement([recorded(heard(2))], [recorded(heard(1))]).findings if f.fault]
