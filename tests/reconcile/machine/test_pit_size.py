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
from reconcile.machine.pit_size import PATTERN_DB, apart_in_pattern, pit_sizes, sized
from reconcile.machine.severity import LEAST_SPREAD
from reconcile.observe.impact_bands import Standing
from reconcile.observe.steady import Steady
from sim.core.response import Response
from sim.core.spec import TermSpec
from sim.presets import preset

LOGS = np.log(np.geomspace(3e-4, 4e-3, 20))


@pytest.mark.parametrize("size", [6e-4, 1e-3, 2.5e-3])
def test_a_size_is_read_where_the_distance_is_least(size: float) -> None:
    rough = np.random.default_rng(2).normal(size=LOGS.size)
    told = sized(LOGS, 12.0 + 30.0 * (LOGS - np.log(size)) ** 2 + rough)
    assert told is not None and np.exp(told[0]) == pytest.approx(size, rel=0.15)
    assert LEAST_SPREAD < told[1] < 0.5


def test_what_hardly_tells_a_size_tells_none() -> None:
    assert sized(LOGS, np.full(LOGS.size, 9.0)) is None
    assert sized(LOGS, np.full(LOGS.size, np.nan)) is None
    few = np.where(np.arange(LOGS.size) < 7, 30.0 * (LOGS - LOGS[3]) ** 2, np.nan)
    assert sized(LOGS, few) is None


def test_draws_that_do_not_run_are_left_out() -> None:
    off = 12.0 + 30.0 * (LOGS - np.log(1e-3)) ** 2
    whole, some = sized(LOGS, off), sized(LOGS, np.where(np.arange(LOGS.size) % 3 == 0, np.nan, off))
    assert whole is not None and some is not None and some[0] == pytest.approx(whole[0], abs=0.05)


def test_multiples_count_against_each_other_where_the_test_stands_out() -> None:
    stands = Standing(level=np.array([[9.0, 1.0]]), error=np.ones((1, 2)), hz=40.0)
    own = np.array([[[20.0, 10.0, np.nan], [20.0, 10.0, 5.0]]])
    assert apart_in_pattern(stands, own, own) == 0.0
    louder = apart_in_pattern(stands, own, own + 7.0)
    assert louder == pytest.approx(0.0), "how loud the impacts are is another figure's"
    other = np.array([[[10.0, 20.0, 0.0], [90.0, 0.0, 0.0]]])
    assert apart_in_pattern(stands, own, other) == pytest.approx(2 * 0.99 * (10.0 / PATTERN_DB) ** 2, rel=0.01)
    below = apart_in_pattern(stands, np.array([[[-5.0, -9.0, -2.0]] * 2]), np.array([[[-1.0, -20.0, -7.0]] * 2]))
    assert below == pytest.approx(0.0)


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
