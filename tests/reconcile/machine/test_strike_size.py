"""The size of a pit by both of its edges: geometry, what is asked, and pits that the product simulates."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.atlas.plan import AtlasPlan, Draw, Point, with_tooth_pairs
from reconcile.atlas.run import RATE_HZ, SETTLE_S, run_members
from reconcile.calibrate.chain import band_centres_hz
from reconcile.calibrate.uncertain import Offsets
from reconcile.kinematics.families import Family, Race
from reconcile.machine import strike_size as module
from reconcile.machine.strike_size import LARGEST, LEAST, STRIKES, between_balls_m, strike_sizes
from reconcile.observe.second_strike import Struck
from reconcile.observe.steady import Steady
from sim.core.response import Response
from sim.core.spec import TermSpec
from sim.core.spec.bearings import BallGeometry
from sim.presets import preset

SENSORS = tuple(f"bearing{k}.outer.y.acceleration" for k in (1, 2, 3))
POINTS = tuple(Point(speed_hz=hz) for hz in (22.5, 30.0, 39.0))


def recorded(plan: AtlasPlan, term: TermSpec | None, seed: int, point: Point) -> Steady:
    """A machine with white noise 30 dB below, through sensors three times as sensitive."""
    (response,) = run_members([plan.member(Draw(pair=0, term=term), point)], SENSORS)
    assert isinstance(response, Response)
    clean = 3.0 * np.asarray(response.signals[:, round(SETTLE_S * RATE_HZ) :])
    noise = np.random.default_rng(seed).normal(size=clean.shape) * 0.03 * clean.std(axis=1, keepdims=True)
    return Steady(samples=clean + noise, rate_hz=RATE_HZ, speed_hz=point.speed_hz, estimate=None)  # type: ignore[arg-type]


def setting(term: TermSpec | None, points: tuple[Point, ...] = POINTS, *, based: bool = True) -> SimpleNamespace:
    rest = tuple(Offsets(values=np.zeros(0)) for _ in range(2))
    machine = with_tooth_pairs(preset("paper"))
    plan = AtlasPlan(machine=machine, numbers=(), offsets=rest, twins=rest, draws=(), seed=3)
    gain = SimpleNamespace(chain=SimpleNamespace(gain_db=np.full((3, band_centres_hz().size), 20.0 * np.log10(3.0))))
    data = []
    for point in points:
        now, before = recorded(plan, term, 1, point), recorded(plan, None, 2, point) if based else None
        data.append(SimpleNamespace(point=point, baseline=before, spectra=(now, before)))
    return SimpleNamespace(
        machine=machine, plan=plan, data=tuple(data), simulated=SENSORS, seen_through=(gain,) * len(data), seed=1,
    )  # fmt: skip


def family(kind: str) -> Family:
    return Family(kind=kind, site="bearing1", order=3.0, spacing=0.0, sidebands=0, slip=0.0)  # type: ignore[arg-type]


def test_balls_are_as_far_apart_as_their_race_is_long() -> None:
    race = Race(balls=7, ratio=0.25, pitch_m=0.04, cage=0.4)
    assert between_balls_m(race, family("outer")) == pytest.approx(np.pi * 0.05 / 7)
    assert between_balls_m(race, family("inner")) == pytest.approx(np.pi * 0.03 / 7)
    bare = replace(race, pitch_m=None)
    assert between_balls_m(bare, family("outer")) == pytest.approx(np.pi * 0.05 / 7), "as pits of such bearings have it"


@pytest.fixture(scope="module")
def pitted() -> SimpleNamespace:
    """An inner race with a pit, at three speeds."""
    return setting(TermSpec(term="inner_spall", site="bearing1", parameters={"width": 2.4e-3, "angle": 0.4}))


def test_the_angle_between_the_strikes_is_a_length_on_the_race(
    pitted: SimpleNamespace, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[Struck] = []

    def tenth(points: list[Struck]) -> float:
        asked.extend(points)
        return 0.1

    monkeypatch.setattr(module, "second_strike", tenth)
    told = strike_sizes(pitted, ["inner_spall@bearing1", "unbalance@gear"])  # type: ignore[arg-type]
    one = told.pop("inner_spall@bearing1")
    assert not told and (one.name, one.unit) == ("width", "m")
    ratio = pitted.machine.bearings[0].geometry.diameter_ratio
    between = np.pi * 0.04 * (1.0 - ratio) / pitted.machine.bearings[0].geometry.balls
    assert one.value == pytest.approx(0.1 * between / STRIKES)
    assert (one.low, one.high) == pytest.approx((0.1 * between / LARGEST, 0.1 * between / LEAST))
    assert [p.speed_hz for p in asked] == [22.5, 30.0, 39.0]
    for p in asked:
        assert p.test_hz == pytest.approx(p.baseline_hz) and 4.2 < p.test_hz / p.speed_hz < 4.6
        assert p.teeth_hz == pytest.approx((23 * p.speed_hz,))


def test_pits_that_are_there_already_balls_and_records_without_a_baseline_are_not_asked(
    pitted: SimpleNamespace, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "second_strike", lambda _points: 0.1)
    assert strike_sizes(pitted, ["ball_spall@bearing1", "tooth_spall@gear"]) == {}  # type: ignore[arg-type]
    has = pitted.plan.machine.model_copy(
        update={"terms": [TermSpec(term="inner_spall", site="bearing1", parameters={"width": 1e-3})]}
    )
    old = SimpleNamespace(**{**vars(pitted), "plan": replace(pitted.plan, machine=has)})
    assert strike_sizes(old, ["inner_spall@bearing1"]) == {}  # type: ignore[arg-type]
    none = SimpleNamespace(**{**vars(pitted), "data": setting(None, POINTS[:1], based=False).data})
    assert strike_sizes(none, ["inner_spall@bearing1"]) == {}  # type: ignore[arg-type]


def test_a_size_stays_within_what_a_pit_may_have(pitted: SimpleNamespace, monkeypatch: pytest.MonkeyPatch) -> None:
    geometry = BallGeometry(balls=7, ball_diameter_m=0.476, pitch_diameter_m=1.8)
    wide = [b.model_copy(update={"geometry": geometry}) for b in pitted.machine.bearings]
    large = pitted.machine.model_copy(update={"bearings": wide})
    monkeypatch.setattr(module, "second_strike", lambda _points: 0.2)
    told = strike_sizes(SimpleNamespace(**{**vars(pitted), "machine": large}), ["inner_spall@bearing1"])  # type: ignore[arg-type]
    one = told["inner_spall@bearing1"]
    assert one.low == one.value == one.high == module.parameter_of("inner_spall@bearing1").high


@pytest.mark.slow
def test_both_edges_of_a_simulated_pit_are_heard(pitted: SimpleNamespace) -> None:
    one = strike_sizes(pitted, ["inner_spall@bearing1"])["inner_spall@bearing1"]  # type: ignore[arg-type]
    assert one.low < 2.4e-3 < one.high
    assert 0.45 < one.value / 2.4e-3 < 1.0, "the product's ball sinks over both edges"


@pytest.mark.slow
def test_a_short_pit_is_left_to_its_levels() -> None:
    short = setting(TermSpec(term="inner_spall", site="bearing1", parameters={"width": 6e-4, "angle": 0.4}))
    assert strike_sizes(short, ["inner_spall@bearing1"]) == {}  # type: ignore[arg-type]
