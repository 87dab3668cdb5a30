"""Measured bearing defects in the cyclic coherence. CWRU, drive end 6205-2RS, 1797 rpm, 0.007 in."""

from pathlib import Path

import numpy as np
import pytest

from signals.cyclic import EnhancedEnvelope, cyclic_coherence, enhanced_envelope
from signals.series import Series

FOLDER = Path(__file__).parents[3].resolve().parent / "shared" / "recordings" / "cwru"
SHAFT_HZ, BALLS, RATIO = 29.933, 9, 7.94 / 39.04
BPFO_HZ, BPFI_HZ = (BALLS * SHAFT_HZ / 2 * (1 + sign * RATIO) for sign in (-1, 1))


def envelope(name: str) -> EnhancedEnvelope:
    path = FOLDER / f"cwru_1797rpm_{name}.npz"
    if not path.exists():
        pytest.skip(f"the CWRU recording {name} is not beside this project")
    with np.load(path, allow_pickle=False) as file:
        series = Series(samples=file["DE"], sampling_rate_hz=float(file["fs_hz"]), unit="g", name="DE")
    return enhanced_envelope(cyclic_coherence(series, max_alpha_hz=500.0))


def level(found: EnhancedEnvelope, alpha_hz: float) -> float:
    """Over the threshold; the defect frequency is known to half a percent."""
    near = np.abs(found.alpha_hz - alpha_hz) < found.resolution_hz + 0.005 * alpha_hz
    return float(np.max(found.values[near])) / found.threshold


@pytest.mark.slow
def test_defects_stand_far_over_chance_and_the_healthy_bearing_does_not() -> None:
    outer, inner, healthy = map(envelope, ("outerrace_007in_6oclock", "innerrace_007in", "normal_first_half"))
    assert all(level(outer, k * BPFO_HZ) > 20 for k in (1, 2, 3))
    assert level(inner, BPFI_HZ) > 20 and level(inner, 2 * BPFI_HZ) > 20
    assert level(healthy, BPFO_HZ) < 1.2 and level(healthy, BPFI_HZ) < 1.2
    assert outer.peaks()[0][0] == pytest.approx(BPFO_HZ, rel=0.005)
    assert inner.peaks()[0][0] == pytest.approx(BPFI_HZ, rel=0.005)
