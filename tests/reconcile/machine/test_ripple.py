"""A torque that comes many times a turn: which sidebands count, and what they tell of its size."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from reconcile.atlas.plan import with_tooth_pairs
from reconcile.atlas.run import RATE_HZ
from reconcile.machine.ripple import (
    FEWEST,
    FORM_DB,
    NEW_DB,
    OVER_FLOOR,
    QUANTILE,
    Seen,
    _gain,
    _held,
    _score,
    _severity,
    sidebands,
)
from reconcile.observe.extract import USABLE
from signals.series import FloatArray
from sim.core.spec import MachineSpec
from sim.presets import preset
from tests.reconcile.machine import teeth
from tests.reconcile.machine.teeth import TIME, at_order, points_of, steady

SPEEDS_HZ = (24.0, 30.0, 37.0)
ALL = 6 * 2 * 2
"""Harmonics, sides and sensors of a point."""


@pytest.fixture(scope="module")
def machine() -> MachineSpec:
    return with_tooth_pairs(preset("paper-lightly-damped"))


def told(points: list[int], risen_db: list[float], risen: list[bool] | None = None) -> Seen:
    """At harmonics in turn."""
    return Seen(
        point=np.array(points, dtype=int),
        ratio_db=np.zeros(len(points)),
        risen_db=np.array(risen_db),
        told=np.array([True] * len(points) if risen is None else risen, dtype=bool),
        places=tuple((23.0, 1 + k % 2, 1, k) for k in range(len(points))),
    )


def standing(found: Seen) -> Seen:
    """What counts of it."""
    return found.at(np.flatnonzero(found.told))


@pytest.mark.slow
def test_sidebands_are_told_by_their_ratio_to_the_teeths_line(machine: MachineSpec) -> None:
    """Amplitudes of a line that is modulated by a depth d: 1, and d/2 at either side."""
    found = sidebands(machine, points_of(machine, at_order(4.0, 0.3)), 4.0)
    assert np.bincount(found.point).tolist() == [ALL] * 3 and found.told.all() and found.enough
    assert found.ratio_db == pytest.approx(20.0 * np.log10(0.15), abs=1.0)
    assert found.risen_db.min() > 12.0
    assert found.places[:ALL] == found.places[ALL : 2 * ALL]
    assert set(found.places[:ALL]) == {(23.0, n, side, c) for n in range(1, 7) for side in (-1, 1) for c in (0, 1)}
    grown = sidebands(machine, points_of(machine, at_order(4.0, 0.3), at_order(4.0, 0.03)), 4.0)
    strong = [k for k, place in enumerate(grown.places) if place[1] <= 2 and place[3] == 0]
    assert grown.risen_db[strong] == pytest.approx(20.0, abs=1.2)


@pytest.mark.slow
def test_each_side_and_sensor_is_its_own(machine: MachineSpec) -> None:
    """One line beside the second harmonic, heard by the second sensor alone; the others are bounds."""
    data = points_of(machine, steady, speeds_hz=SPEEDS_HZ[:2])
    for one, hz in zip(data, SPEEDS_HZ, strict=False):
        now: Any = one.spectra[0]
        now.samples = now.samples.copy()
        now.samples[1] += 0.05 * np.sin(2 * np.pi * (2 * 23 - 4) * hz * TIME)
    both = sidebands(machine, data, 4.0)
    assert both.point.size == 2 * ALL and not both.enough
    found = standing(both)
    assert found.places == ((23.0, 2, -1, 1),) * 2 and found.point.tolist() == [0, 1]
    assert found.ratio_db == pytest.approx(20.0 * np.log10(0.05 / 0.2), abs=0.3)


@pytest.mark.slow
def test_only_what_is_new_counts(machine: MachineSpec) -> None:
    """`NEW_DB` are a factor of two in the depth."""
    once = 0.2 / 10.0 ** (NEW_DB / 20.0)
    for before, seen in ((0.8 * once, ALL), (1.2 * once, 0)):
        found = sidebands(machine, points_of(machine, at_order(4.0, 0.2), at_order(4.0, before)), 4.0)
        assert abs(found.told.sum() / 3 - seen) <= 2 and found.point.size == 3 * ALL
    assert sidebands(machine, points_of(machine, at_order(4.0, 0.2), None), 4.0).point.size == 0, "nothing to compare"


@pytest.mark.slow
def test_only_what_stands_out_counts(machine: MachineSpec) -> None:
    """Broad noise that is new raises every sideband, and none of them over the floor."""
    data = points_of(machine, steady)
    for k, one in enumerate(data):
        now: Any = one.spectra[0]
        now.samples = now.samples + 0.5 * np.random.default_rng(k).normal(size=now.samples.shape)
    found = sidebands(machine, data, 4.0)
    assert found.told.sum() <= 0.02 * 3 * ALL, f"a power {OVER_FLOOR:g} times the floor is rare in noise"
    assert np.median(found.risen_db) > NEW_DB
    assert not sidebands(machine, points_of(machine, steady), 4.0).told.any()


@pytest.mark.slow
def test_where_the_teeths_line_is_not_heard_only_what_has_risen_is_kept(machine: MachineSpec) -> None:
    """Noise hides all but the first harmonic of the second sensor, and beside the third a line stands alone."""
    data = points_of(machine, steady, speeds_hz=SPEEDS_HZ[:1])
    both: Any = data[0].spectra
    for k, one in enumerate(both):
        one.samples = one.samples.copy()
        one.samples[1] *= 0.004
        one.samples[1] += 0.05 * np.random.default_rng(k).normal(size=TIME.size)
    both[0].samples[1] += 0.05 * np.sin(2 * np.pi * (3 * 23 + 4) * SPEEDS_HZ[0] * TIME)
    found = sidebands(machine, data, 4.0)
    quiet = [place for place in found.places if place[3] == 1]
    assert (23.0, 3, 1, 1) in quiet and len(quiet) <= 4
    assert standing(found).places == ((23.0, 3, 1, 1),)


@pytest.mark.slow
def test_bands_are_compared_as_far_as_both_and_simulations_go(machine: MachineSpec) -> None:
    """Each eighth sample: the third harmonic is beyond the band."""
    data = points_of(machine, at_order(4.0, 0.2), speeds_hz=SPEEDS_HZ)
    shorter: Any = data[1].spectra[1]
    shorter.samples, shorter.rate_hz = shorter.samples[:, ::8], teeth.RATE_HZ / 8
    found = sidebands(machine, data, 4.0)
    own = [place[1] for place, point in zip(found.places, found.point, strict=True) if point == 1]
    assert np.bincount(found.point).tolist() == [ALL, 4, ALL] and set(own) == {1}
    fast = points_of(machine, at_order(4.0, 0.2), speeds_hz=(0.5 * USABLE * RATE_HZ / (4 * 23),))
    for one in fast[0].spectra:
        doubled: Any = one
        doubled.rate_hz, doubled.speed_hz = 2 * teeth.RATE_HZ, 2 * doubled.speed_hz
    assert {place[1] for place in sidebands(machine, fast, 4.0).places} == {1, 2, 3}


@pytest.mark.slow
def test_sidebands_end_with_the_band_and_begin_above_nothing(machine: MachineSpec) -> None:
    """At some speed the fifth harmonic is in the band, its upper sideband is not."""
    fast = USABLE * teeth.RATE_HZ / (5 * 23 + 2.0)
    found = sidebands(machine, points_of(machine, at_order(4.0, 0.4), speeds_hz=(fast,)), 4.0)
    assert {place[1:3] for place in found.places} == {(n, s) for n in range(1, 6) for s in (-1, 1)} - {(5, 1)}
    edge = points_of(machine, at_order(4.0, 0.4), speeds_hz=(0.9999 * USABLE * teeth.RATE_HZ / (5 * 23 + 4.0),))
    assert (23.0, 5, 1, 0) in sidebands(machine, edge, 4.0).places
    faster: Any = edge[0].spectra[1]
    faster.speed_hz *= 1.0002
    assert (23.0, 5, 1, 0) not in sidebands(machine, edge, 4.0).places, "not in the baseline's band"
    twice = sidebands(machine, points_of(machine, at_order(23.0, 0.4)), 23.0)
    assert not any(place[1:3] == (1, -1) for place in twice.places), "that is at rest"


@pytest.mark.parametrize(
    ("points", "risen", "enough"),
    [
        ([0, 0, 1, 1], [True] * 4, True),
        ([0, 0, 0, 1], [True] * 4, True),
        ([0, 0, 1], [True] * 3, False),
        ([0, 0, 1, 1], [True, True, True, False], False),
        ([0] * FEWEST, [True] * FEWEST, False),
        ([0, 0, 0, 0, 1], [True] * 4 + [False], False),
        ([0, 1] * 4, [True, False] * 4, False),
        ([], [], False),
    ],
)
def test_a_size_needs_some_that_have_risen_at_two_points_about_two_harmonics(
    points: list[int], risen: list[bool], enough: bool
) -> None:
    assert told(points, [20.0] * len(points), risen).enough is enough
    if enough:
        one = replace(told(points, [20.0] * len(points), risen), places=((23.0, 1, 1, 0),) * len(points))
        assert not one.enough, "at one harmonic alone another line may stand"
        assert replace(one, places=((23.0, 1, 1, 0), (31.0, 1, 1, 0)) * 2).enough, "of two meshes"


def test_an_interval_holds_machines_sidebands_and_other_forms() -> None:
    def width_db(left: FloatArray) -> float:
        found = _severity(2.0, left)
        assert (found.name, found.unit, found.value) == ("amplitude", "N*m", 2.0)
        assert found.low is not None and found.high is not None
        assert found.low * found.high == pytest.approx(4.0)
        return 20.0 * float(np.log10(found.high / 2.0)) / QUANTILE

    assert width_db(np.zeros((4, 8))) == pytest.approx(FORM_DB)
    machines = np.repeat([[3.0], [-3.0]], 8, axis=1)
    assert width_db(machines) == pytest.approx(np.sqrt(9.0 + FORM_DB**2))
    lines = np.tile([[3.0, -3.0]], (2, 4))
    assert width_db(lines) == pytest.approx(np.sqrt(9.0 / 4.0 + FORM_DB**2)), "every second tells something of its own"
    outlier = np.array([[0.0, 0.0, 8.0]] * 2)
    assert width_db(outlier) == pytest.approx(np.sqrt(outlier[0].var() / 1.5 + FORM_DB**2)), "medians of machines"


def rms(values: FloatArray) -> float:
    return float(np.sqrt(np.mean(np.square(values))))


def test_each_operating_point_is_forecast_by_the_others() -> None:
    seen = told([0, 0, 1, 1, 2, 2], [10.0, 14.0, 20.0, 24.0, 30.0, 34.0])
    left = np.array([1.0, 3.0, -2.0, -4.0, 5.0, 7.0])
    held = _held(seen, left, seed=1)
    after = np.array([1.0 - 1.5, 3.0 - 1.5, -2.0 - 4.0, -4.0 - 4.0, 5.0 + 0.5, 7.0 + 0.5])
    box = np.array([10.0 - 27.0, 14.0 - 27.0, 20.0 - 22.0, 24.0 - 22.0, 30.0 - 17.0, 34.0 - 17.0])
    assert held.before == pytest.approx(rms(seen.risen_db)) and held.after == pytest.approx(rms(after))
    assert held.gain == pytest.approx(1.0 - rms(after) / rms(seen.risen_db))
    assert held.black_box == pytest.approx(1.0 - rms(box) / rms(seen.risen_db))
    assert held.gain_low < held.gain < held.gain_high < 1.0
    assert (held.unit, held.numbers, held.retuned, held.placebo) == ("dB", 1, None, None)
    assert _held(seen, left, seed=1) == held


def test_what_fits_at_every_point_gains_all_and_what_rises_as_much_the_black_box_too() -> None:
    held = _held(told([0, 0, 1, 1], [10.0] * 4), np.zeros(4), seed=0)
    assert (held.gain, held.gain_low, held.gain_high, held.black_box) == (1.0, 1.0, 1.0, 1.0)
    apart = _held(told([0, 0, 1, 1], [10.0] * 4), np.array([5.0, 5.0, -5.0, -5.0]), seed=0)
    assert apart.gain == pytest.approx(0.0), "one size at one speed, another at the other"


def test_what_has_not_risen_is_a_bound_that_a_forecast_may_not_exceed() -> None:
    """The third of a point: 4 dB less there than forecast counts, 4 dB more do not; the others do not learn of it."""
    risen = [True, True, False] * 2
    seen = told([0, 0, 0, 1, 1, 1], [10.0, 14.0, 3.0, 20.0, 24.0, 21.0], risen)
    less = _held(seen, np.array([0.0, 0.0, -4.0, 0.0, 0.0, -4.0]), seed=1)
    more = _held(seen, np.array([0.0, 0.0, 4.0, 0.0, 0.0, 4.0]), seed=1)
    before = rms(np.array([10.0, 14.0, 0.0, 20.0, 24.0, 0.0]))
    assert less.before == more.before == pytest.approx(before)
    assert less.after == pytest.approx(rms(np.array([0.0, 0.0, -4.0] * 2))) and more.after == 0.0
    box = np.array([10.0 - 22.0, 14.0 - 22.0, 3.0 - 22.0, 20.0 - 12.0, 24.0 - 12.0, 0.0])
    assert less.black_box == more.black_box == pytest.approx(1.0 - rms(box) / before)


def test_where_all_that_rose_is_at_one_point_it_is_forecast_by_itself() -> None:
    seen = told([0, 0, 1], [10.0, 12.0, 1.0], [True, True, False])
    held = _held(seen, np.array([2.0, 4.0, 9.0]), seed=1)
    assert held.after == pytest.approx(rms(np.array([-1.0, 1.0, 0.0])))


def test_an_interval_of_the_gain_is_of_whole_operating_points() -> None:
    """One of three is forecast badly: three in ten drawings are without it, and one in four has it twice."""
    seen = told([0] * 6 + [1] * 6 + [2] * 6, [10.0] * 18)
    left = np.array([0.0] * 12 + [10.0] * 6)
    held = _held(seen, left, seed=0)
    after = np.array([0.0 - 5.0] * 12 + [10.0] * 6)
    assert held.gain == pytest.approx(1.0 - rms(after) / 10.0)
    assert (held.gain_low, held.gain_high) == pytest.approx((1.0 - np.sqrt(75.0) / 10.0, 0.5), abs=0.14)
    assert held.gain_high == pytest.approx(0.5), "the third left out"


def test_a_gain_is_the_share_of_the_distance_that_is_taken_off() -> None:
    assert _gain(np.array([3.0, 4.0]), np.array([3.0, 4.0])) == 0.0
    assert _gain(np.array([6.0, 8.0]), np.array([-3.0, 4.0])) == pytest.approx(0.5)
    assert _gain(np.array([1.0, 1.0]), np.array([3.0, -3.0])) == pytest.approx(-2.0)
    assert np.isfinite(_gain(np.zeros(2), np.ones(2)))


def test_evidence_counts_every_fourth_sideband_with_no_less_than_a_usual_scatter() -> None:
    seen = told([0] * 8, [12.0] * 8)
    assert _score(seen, np.zeros(8)) == pytest.approx(0.25 * 8 * 12.0**2 / (2 * 3.0**2))
    left = np.array([6.0, -6.0] * 4)
    assert _score(seen, left) == pytest.approx(0.25 * 8 * (12.0**2 - 6.0**2) / (2 * 6.0**2))
    bound = told([0] * 8, [12.0] * 8, [True, False] * 4)
    for off, counted in ((-6.0, 6.0), (6.0, 0.0)):
        rest = np.array([0.0, off] * 4)
        assert _score(bound, rest) == pytest.approx(0.25 * 4 * (12.0**2 - counted**2) / (2 * 3.0**2))
