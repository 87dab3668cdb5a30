"""How far lines of a shaft must have grown in most sensors, and how near the strongest they must come, to count."""

from __future__ import annotations

import numpy as np
import pytest

from reconcile.kinematics.lines import OrderLines
from reconcile.kinematics.series import _series
from reconcile.kinematics.shafts import _change

STEP, BINS, STRONGEST_DB = 0.05, 400, 60.0
MULTIPLES = np.array([3.0, 4.0, 5.0, 6.0, 7.0])


def spectrum(levels: dict[float, float]) -> OrderLines:
    """Lines at orders, dB over a floor of 0 dB."""
    level = np.zeros(BINS)
    for order, db in levels.items():
        level[round(order / STEP)] = db
    return OrderLines(level_db=level, floor_db=np.zeros(BINS), order_step=STEP)


@pytest.mark.parametrize(
    ("growths", "grown"),
    [
        ((14.0, 6.5, 0.0), True),
        ((14.0, 5.5, 0.0), False),
        ((14.0, 5.5, 5.0), False),
        ((9.5, 8.0, 7.0), False),
        ((10.5, 8.0, 7.0), True),
    ],
)
def test_a_line_that_grew_in_one_sensor_alone_is_that_sensor_s(growths: tuple[float, ...], grown: bool) -> None:
    spectra = [(f"a{k}", spectrum({1.0: 40.0}), spectrum({1.0: 40.0 - db})) for k, db in enumerate(growths)]
    found = _change(spectra, "shaft", 1.0, 1.0, "test 1")
    assert found is not None and (found.channel, found.growth_db) == ("a0", growths[0])
    assert found.median_db == growths[1] and found.grown is grown


@pytest.mark.parametrize(("below_db", "told"), [(29.0, True), (31.0, False), (40.0, False)])
def test_multiples_far_below_the_strongest_line_are_no_series(below_db: float, told: bool) -> None:
    """All of them are clear, and grew out of the floor: beside a line so strong as that a load moves them."""
    once = {1.0: STRONGEST_DB}
    risen = dict.fromkeys(MULTIPLES.tolist(), STRONGEST_DB - below_db)
    spectra = [("a0", spectrum(once | risen), spectrum(once))]
    found = _series(spectra, "shaft", 1.0, MULTIPLES, "test 1")
    assert (found is not None) is told
    alone = _series([("a0", spectrum(risen), spectrum({}))], "shaft", 1.0, MULTIPLES, "test 1")
    assert alone is not None and alone.multiples == tuple(MULTIPLES), "it is the strong line that hides them"
