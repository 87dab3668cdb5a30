"""The size of a pit by its impacts: what is simulated at that size and added to the baseline sounds like the test."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.atlas.plan import AtlasPlan, Draw, Point, with_tooth_pairs
from reconcile.atlas.run import RATE_HZ, SETTLE_S, run_members
from reconcile.calibrate.chain import band_centres_hz
from reconcile.calibrate.uncertain import Offsets
from reconcile.machine.meter import Meter
from reconcile.machine.pit_size import PATTERN_DB, against_each_other, pit_sizes
from reconcile.observe.impact_bands import Standing
from reconcile.observe.steady import Steady
from sim.core.response import Response
from sim.core.spec import TermSpec
from sim.presets import preset


def test_multiples_count_against_each_other_where_the_test_stands_out() -> None:
    stands = Standing(level=np.array([[9.0, 1.0]]), error=np.ones((1, 2)), hz=40.0)
    own = np.array([[[20.0, 10.0, np.nan], [20.0, 10.0, 5.0]]])
    other = np.array([[[10.0, 20.0, 0.0], [90.0, 0.0, 0.0]]])
    way = against_each_other(stands, own, [own, own + 7.0, other])
    assert way.seen == pytest.approx([5.0, -5.0]), "two multiples of the first band, less their mean"
    assert way.shown[0] == pytest.approx(way.seen)
    assert way.shown[1] == pytest.approx(way.seen), "how loud the impacts are is another figure's"
    assert way.shown[2] == pytest.approx([-5.0, 5.0])
    assert way.variance == pytest.approx([PATTERN_DB**2] * 2)


def test_what_lies_in_the_floor_counts_as_on_it() -> None:
    stands = Standing(level=np.array([[9.0]]), error=np.ones((1, 1)), hz=40.0)
    way = against_each_other(stands, np.array([[[-5.0, -9.0, -2.0]]]), [np.array([[[-1.0, -20.0, -7.0]]])])
    assert way.seen == pytest.approx([0.0, 0.0, 0.0]) and way.shown == pytest.approx(np.zeros((1, 3)))


def test_a_test_in_which_no_band_stands_out_has_no_pattern() -> None:
    quiet = Standing(level=np.array([[2.0]]), error=np.ones((1, 1)), hz=40.0)
    assert against_each_other(quiet, np.array([[[5.0, 1.0]]]), [np.array([[[5.0, 1.0]]])]).seen.size == 0


SENSORS = tuple(f"bearing{k}.outer.y.acceleration" for k in (1, 2, 3))
POINT = Point(speed_hz=30.0)


def recorded(plan: AtlasPlan, term: TermSpec | None, seed: int) -> Steady:
    """A machine with white noise 30 dB below, through sensors three times as sensitive."""
    (response,) = run_members([plan.member(Draw(pair=0, term=term), POINT)], SENSORS)
    assert isinstance(response, Response)
    clean = 3.0 * np.asarray(response.signals[:, round(SETTLE_S * RATE_HZ) :])
    noise = np.random.default_rng(seed).normal(size=clean.shape) * 0.03 * clean.std(axis=1, keepdims=True)
    return Steady(samples=clean + noise, rate_hz=RATE_HZ, speed_hz=30.0, estimate=None)  # type: ignore[arg-type]


def setting(term: TermSpec | None, *, based: bool = True) -> SimpleNamespace:
    rest = tuple(Offsets(values=np.zeros(0)) for _ in range(2))
    machine = with_tooth_pairs(preset("paper"))
    plan = AtlasPlan(machine=machine, numbers=(), offsets=rest, twins=rest, draws=(), seed=3)
    now, before = recorded(plan, term, 1), recorded(plan, None, 2) if based else None
    gain = SimpleNamespace(chain=SimpleNamespace(gain_db=np.full((3, band_centres_hz().size), 20.0 * np.log10(3.0))))
    one = SimpleNamespace(point=POINT, baseline=before, spectra=(now, before))
    return SimpleNamespace(
        machine=machine, plan=plan, data=(one,), simulated=SENSORS, seen_through=(gain,), seed=1,
    )  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize(("key", "width"), [("outer_spall", 7e-4), ("inner_spall", 1.6e-3)])
def test_the_size_of_a_pit_is_found_by_its_impacts(key: str, width: float) -> None:
    angle = -1.3 if key == "outer_spall" else 0.4
    hidden = TermSpec(term=key, site="bearing3", parameters={"width": width, "depth": 1e-4, "angle": angle})
    names = [f"{key}@bearing3", "unbalance@gear", "tooth_crack@gear"]
    told = pit_sizes(setting(hidden), names, Meter(map))  # type: ignore[arg-type]
    assert list(told) == [f"{key}@bearing3"]
    found = told[f"{key}@bearing3"]
    assert (found.name, found.unit) == ("width", "m") and found.low < width < found.high
    assert found.value == pytest.approx(width, rel=0.4)


@pytest.mark.slow
def test_nothing_is_sized_that_is_not_heard_or_without_a_baseline() -> None:
    hidden = TermSpec(term="inner_spall", site="bearing3", parameters={"width": 1.6e-3})
    names = ["inner_spall@bearing3"]
    for one in (setting(None), setting(hidden, based=False)):
        assert pit_sizes(one, names, Meter(map)) == {}  # type: ignore[arg-type]
    assert pit_sizes(setting(hidden), ["unbalance@gear"], Meter(map)) == {}  # type: ignore[arg-type]
