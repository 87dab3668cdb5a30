"""Without a baseline: lines deep in any band that hears them name a race; in a quiet machine it must strike too."""

from __future__ import annotations

import numpy as np
import pytest

from reconcile.kinematics import read_kinematic_spec, reconcile_kinematics
from reconcile.kinematics.candidate import ALONE_DEPTH, STRIKES
from reconcile.kinematics.families import ties
from reconcile.kinematics.judge import CALM, candidates
from reconcile.kinematics.observe import observe
from tests.strategies.impulses import RATE_HZ, SPEED_HZ, N, recorded, sound, train

pytestmark = pytest.mark.slow
SPEC = read_kinematic_spec(
    {
        "kinematics": {
            "shafts": [{"name": "shaft"}],
            "bearings": [{"name": "bearing1", "shaft": "shaft", "catalogue": "6205"}],
        }
    }
)
ORDER = 3.5848 * 0.992


def pitted(height: float, seed: int = 2) -> np.ndarray:
    """Blows of one size on noise of 0.3 and the lines of a shaft."""
    return np.asarray(sound(seed) + train(np.random.default_rng(seed), ORDER, height))


def test_a_quiet_machine_must_strike() -> None:
    loud = pitted(1.0)
    quiet = 0.5 * CALM * SPEED_HZ / float(np.std(loud))
    report = reconcile_kinematics(SPEC, [recorded(loud)], [], seed=3)
    assert (report.verdict, [c.term for c in report.causes]) == ("explained", ["outer_spall"])
    hushed = reconcile_kinematics(SPEC, [recorded(quiet * loud)], [], seed=3)
    assert hushed.verdict == "not_decidable" and not hushed.causes
    assert "nothing strikes" in hushed.sentence and "without blows" in hushed.undecidable[0]
    struck = pitted(6.0)
    report = reconcile_kinematics(SPEC, [recorded(0.5 * CALM * SPEED_HZ / np.std(struck) * struck)], [], seed=3)
    assert (report.verdict, [c.term for c in report.causes]) == ("explained", ["outer_spall"])


def test_the_deepest_band_counts_not_the_firmest() -> None:
    """A broad band of noise that swells a little is the firmest; the ring of the blows is deeper."""
    rng = np.random.default_rng(5)
    strong = pitted(1.0) + 0.05 * rng.standard_normal(N)
    # a broad band of noise whose strength follows the balls a little: firm, but shallow
    t = np.arange(N) / RATE_HZ
    swell = 1.0 + 0.18 * sum(np.cos(2 * np.pi * k * ORDER * SPEED_HZ * t) for k in (1, 2, 3, 4, 5))
    both = strong + 12.0 * _band(swell * rng.standard_normal(N), 6_000.0, 9_500.0)
    seen = observe(recorded(both), ties(SPEC, "shaft"), "test 1", stated_hz=SPEED_HZ, seed=0)
    found = {c.family.kind: c for c in candidates([seen], [], ties(SPEC, "shaft"), 0)}["outer"]
    assert found.depth < ALONE_DEPTH < found.deepest
    assert found.risen and max(e.kurtosis for e in found.evidence) < STRIKES


def _band(samples: np.ndarray, low_hz: float, high_hz: float) -> np.ndarray:
    spectrum = np.fft.rfft(samples)
    hz = np.fft.rfftfreq(samples.size, 1 / RATE_HZ)
    spectrum[(hz < low_hz) | (hz > high_hz)] = 0.0
    return np.fft.irfft(spectrum, samples.size)
