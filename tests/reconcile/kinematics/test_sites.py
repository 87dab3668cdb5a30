"""Of equal bearings the one whose sensor hears the blows loudest is likelier, as far as levels can be compared."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reconcile.kinematics import read_kinematic_spec, reconcile_kinematics
from signals.recording import Recording
from tests.strategies.brief import N, recorded, sound, train

pytestmark = pytest.mark.slow
SPEC = read_kinematic_spec(
    {
        "kinematics": {
            "shafts": [{"name": "shaft"}],
            "bearings": [{"name": n, "shaft": "shaft", "catalogue": "6205"} for n in ("bearing1", "bearing2")],
        }
    }
)


def two(heights: tuple[float, float], seed: int, gains: tuple[float, float] = (1.0, 1.0)) -> Recording:
    """A sensor at each bearing; blows on an outer race of so different size, noise of its own."""
    rng = np.random.default_rng(seed)
    blows = train(rng, 3.5848 * 0.992, 1.0) if any(heights) else np.zeros(N)
    rows = [sound(seed + 10 * k) + h * blows for k, h in enumerate(heights)]
    return recorded(np.array([g * row for g, row in zip(gains, rows, strict=True)]))


def uncalibrated(one: Recording) -> Recording:
    return replace(one, channels=tuple(replace(c, unit="uncalibrated") for c in one.channels))


def weights(test: Recording, *baselines: Recording) -> dict[str, float]:
    report = reconcile_kinematics(SPEC, [test], list(baselines), seed=1)
    assert {c.term for c in report.causes} == {"outer_spall"}, report.sentence
    return {w.site: w.weight for w in report.where.sites}


@pytest.mark.parametrize("near", [0, 1])
def test_the_louder_sensor_stands_at_the_damaged_one(near: int) -> None:
    heights = (8.0, 2.0) if near == 0 else (2.0, 8.0)
    test, base = two(heights, 2), two((0.0, 0.0), 5)
    site = f"bearing{near + 1}"
    assert weights(test, base)[site] > 0.8 and weights(test)[site] > 0.8
    assert weights(uncalibrated(test), uncalibrated(base))[site] > 0.8, "by growth"


def test_gains_that_nobody_knows_do_not_tell_without_a_baseline() -> None:
    test = uncalibrated(two((8.0, 8.0), 2, gains=(10.0, 1.0)))
    assert 0.2 < weights(test)["bearing1"] < 0.8
    base = uncalibrated(two((0.0, 0.0), 5, gains=(10.0, 1.0)))
    assert 0.2 < weights(test, base)["bearing1"] < 0.8
