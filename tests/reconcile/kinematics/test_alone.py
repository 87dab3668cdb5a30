"""Without a baseline: a race is named whose lines are deep in any band that hears them, if something strikes."""

from __future__ import annotations

import numpy as np
import pytest

from reconcile.kinematics import read_kinematic_spec, reconcile_kinematics
from reconcile.kinematics.candidate import ALONE_DEPTH
from reconcile.kinematics.families import ties
from reconcile.kinematics.judge import candidates
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


def test_a_machine_without_a_baseline_must_strike() -> None:
    """Noise that swells smoothly as the balls pass is as deep as a defect's blows are."""
    rng = np.random.default_rng(11)
    turns = np.arange(N) / RATE_HZ * ORDER * SPEED_HZ
    swell = np.sqrt(1.0 + 0.9 * np.cos(2 * np.pi * turns) + 0.3 * np.cos(4 * np.pi * turns))
    passing = np.asarray(sound(4) + 3.0 * _band(swell * rng.standard_normal(N), 3_000.0, 6_000.0))
    quiet = reconcile_kinematics(SPEC, [recorded(passing)], [], seed=3)
    assert quiet.verdict == "not_decidable" and not quiet.causes
    assert "nothing strikes" in quiet.sentence and "without blows" in quiet.undecidable[0]
    struck = reconcile_kinematics(SPEC, [recorded(pitted(6.0))], [], seed=3)
    assert (struck.verdict, [c.term for c in struck.causes]) == ("explained", ["outer_spall"])


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
    assert found.deep and [e.deepest_hz for e in found.evidence] != [e.band_hz for e in found.evidence]


def _band(samples: np.ndarray, low_hz: float, high_hz: float) -> np.ndarray:
    spectrum = np.fft.rfft(samples)
    hz = np.fft.rfftfreq(samples.size, 1 / RATE_HZ)
    spectrum[(hz < low_hz) | (hz > high_hz)] = 0.0
    return np.fft.irfft(spectrum, samples.size)
