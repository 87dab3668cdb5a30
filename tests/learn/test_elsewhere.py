"""Impacts that the stated bearing cannot make are told, those it can make are not."""

from __future__ import annotations

import numpy as np
import pytest

from learn.classify import classify
from learn.describe import Site
from learn.elsewhere import elsewhere, known_to
from learn.gears.stage import Stage
from learn.looked import Looked
from learn.model import default_model
from learn.orders import of_ratio
from signals.recording import Operating, Recording
from sim.core.response import Channel

RATE, SPEED = 20_000.0, 25.0
OTHER = of_ratio(12, 0.14)
"""BPFO 5.16, BPFI 6.84, twice the spin 7.0."""


def parts(samples, turns=40.0):  # type: ignore[no-untyped-def]
    assert samples.size == int(turns / SPEED * RATE)
    return Looked(channels=(samples,), rate_hz=RATE, speed_hz=SPEED, orders=None, doubt=0.0).long


def test_impacts_of_no_part_of_the_bearing_are_found_at_their_order(impacts) -> None:  # type: ignore[no-untyped-def]
    found = elsewhere(parts(impacts(4.2)), [OTHER])
    assert found is not None and found.order == pytest.approx(4.2, rel=0.02) and found.z > 10 and found.depth > 0.6


def test_its_own_are_not_nor_noise_nor_faint_ones(impacts, bearing) -> None:  # type: ignore[no-untyped-def]
    assert elsewhere(parts(impacts(3.585)), [bearing]) is None
    assert elsewhere(parts(impacts(3.585)), [OTHER, bearing]) is None
    assert elsewhere(parts(impacts(None)), [OTHER]) is None
    assert elsewhere(parts(impacts(4.2, noise=40.0)), [OTHER]) is None


def test_turns_of_another_shaft_are_not(impacts) -> None:  # type: ignore[no-untyped-def]
    banks = parts(impacts(2.478))
    assert elsewhere(banks, [OTHER]) is not None
    assert elsewhere(banks, [OTHER], [2.478]) is None


@pytest.mark.parametrize("slow", [0.35, 0.1, 0.05])
def test_a_slow_shaft_in_mesh_hides_no_bearing(impacts, slow) -> None:  # type: ignore[no-untyped-def]
    assert elsewhere(parts(impacts(4.2)), [OTHER], [slow]) is not None


def test_a_tooth_of_a_slow_shaft_is_that_shaft(impacts) -> None:  # type: ignore[no-untyped-def]
    banks = parts(impacts(0.45))
    with_many = [part for part in banks if elsewhere([part], [OTHER]) is not None]
    assert all(elsewhere([part], [OTHER], [0.45]) is None for part in with_many)


def test_what_is_known_is_taken_per_turn_of_the_bearings_own_shaft(bearing) -> None:  # type: ignore[no-untyped-def]
    slow = Site(name="slow", orders=bearing, ratio=0.5)
    fast = Site(name="fast", orders=OTHER, ratio=1.0)
    stage = Stage(name="mesh", ratio=1.0, teeth=(20, 40), gears=("pinion", "wheel"))
    own, shafts = known_to(slow, [slow, fast], [stage])
    assert [o.outer for o in own] == pytest.approx([bearing.outer, 2 * OTHER.outer])
    assert shafts == pytest.approx([2.0, 1.0])


@pytest.mark.slow
def test_the_answer_says_that_the_bearing_may_be_another(impacts) -> None:  # type: ignore[no-untyped-def]
    channel = Channel(name="a", quantity="acceleration", unit="m/s^2", location="", axis="")
    recording = Recording(
        sampling_rate_hz=RATE,
        channels=(channel,),
        samples=np.stack([impacts(4.2)]),
        operating=Operating(shaft="shaft", speed_hz=SPEED),
    )
    found = classify(recording, default_model(), [Site(name="drive", orders=OTHER, ratio=1.0)], trust_speed=True)
    (line,) = [line for line in found["lines"] if line["family"] == "foreign"]
    assert line["frequency_hz"] == pytest.approx(4.2 * SPEED, rel=0.02)
    assert any("drive: clear impacts at order 4." in remark for remark in found["remarks"])
