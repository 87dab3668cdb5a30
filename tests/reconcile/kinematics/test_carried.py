"""Whose channels the tests' are, where only hearing tells which of two equal bearings it is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reconcile.gate.levels import Pair
from reconcile.gate.lines import StrongLines
from reconcile.kinematics import carried as room
from reconcile.kinematics.carried import shared, told_open
from reconcile.verdict import PlaceWeight
from signals.series import FloatArray
from sim.core.response import Channel

BANDS, WIDE = 40, 17
CHANNELS = tuple(
    Channel(name=f"a{k}", quantity="acceleration", unit="m/s^2", location=f"b{k}", axis="y") for k in range(2)
)
NO_LINES = StrongLines(hz=np.zeros(0), change_db=np.zeros(0), floor_db=np.zeros(0))
PLACES = (PlaceWeight(site="b0", weight=0.9), PlaceWeight(site="b1", weight=0.1))


def pair(apart: float, raised: float, seed: int = 0, steps: tuple[float, float] = (0.0, 0.0)) -> Pair:
    """Two channels whose bands differ by `apart` dB; a pit at the first raised all its bands, half of the other's."""
    rng = np.random.default_rng(seed)
    shape = apart * rng.standard_normal((2, BANDS))
    wide = apart * rng.standard_normal((2, WIDE))
    rise = np.stack([np.ones(BANDS), np.arange(BANDS) % 2]) * raised

    def near(x: FloatArray) -> FloatArray:
        return np.asarray(x + 0.3 * rng.standard_normal(x.shape))

    return Pair(
        label="test 1",
        channels=CHANNELS,
        band=np.arange(BANDS),
        centre_hz=np.geomspace(50, 5000, BANDS),
        test=np.stack([near(shape + rise)] * 2, axis=1),
        baseline=np.stack([near(shape)] * 2, axis=1),
        impacts=np.zeros((2, BANDS)),
        quiet_test=near(wide + rise[:, :WIDE]),
        quiet_baseline=near(wide),
        crest_change=np.zeros((2, WIDE)),
        lines=(NO_LINES, NO_LINES),
        steps_test=steps,
        steps_baseline=steps,
    )


def exchanged(p: Pair) -> Pair:
    return replace(p, test=p.test[::-1], quiet_test=p.quiet_test[::-1], steps_test=p.steps_test[::-1])


def told(*several: Pair) -> str:
    return room._told(several, "a0", "a1")


@pytest.mark.parametrize("seed", range(4))
def test_what_a_pit_leaves_alone_tells_whose_channels_they_are(seed: int) -> None:
    for raised in (0.0, 10.0, 30.0):
        right = pair(3.0, raised, seed)
        assert told(right) == "own"
        assert told(exchanged(right)) == "exchanged"


@pytest.mark.parametrize("seed", range(4))
def test_sensors_that_are_alike_tell_nothing_but_by_their_steps(seed: int) -> None:
    alike = pair(0.0, 30.0, seed)
    assert told(alike) == told(exchanged(alike)) == "open"
    assert told(pair(0.0, 30.0, seed, steps=(0.002046, 0.002015))) == "own"


def test_steps_speak_against_a_weak_exchange() -> None:
    right = pair(3.0, 30.0)
    cables = replace(exchanged(right), steps_test=(1.0, 1.3), steps_baseline=(1.0, 1.3))
    assert told(cables) == "own"


def test_without_a_baseline_nothing_tells() -> None:
    assert told() == "open"


def test_both_places_share_and_are_named() -> None:
    assert [w.weight for w in shared(PLACES)] == [0.5, 0.5]
    assert told_open(PLACES).startswith("whether it is b1 and not b0, should their sensors be exchanged")
