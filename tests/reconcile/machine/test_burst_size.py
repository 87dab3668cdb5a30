"""The size of a faulty tooth by its burst: what is simulated at that size stands as far out of the mean turn."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.atlas.plan import AtlasPlan, Draw, Point, with_tooth_pairs
from reconcile.atlas.run import RATE_HZ, SETTLE_S, run_members
from reconcile.calibrate.chain import band_centres_hz
from reconcile.calibrate.uncertain import Offsets
from reconcile.machine.burst_size import Heard, burst_sizes, sized
from reconcile.machine.meter import Meter
from reconcile.machine.severity import LEAST_SPREAD, joined
from reconcile.observe.steady import Steady
from reconcile.verdict import Severity
from sim.core.response import Response
from sim.core.spec import TermSpec
from sim.presets import preset

SIZES = np.log(np.geomspace(0.03, 0.5, 8))
ENDS = (float(SIZES[0]), float(SIZES[-1]))


def heard(size: float, *, power: float = 1.7, noise: float = 0.1, scatter: float = 0.0) -> Heard:
    off = scatter * np.random.default_rng(1).standard_normal(SIZES.size)
    return Heard(sizes=SIZES, bursts=power * SIZES + off, told=power * float(np.log(size)), error=noise)


@pytest.mark.parametrize("size", [0.06, 0.2, 0.45])
@pytest.mark.parametrize("power", [1.0, 2.0])
def test_a_size_is_read_where_its_burst_is(size: float, power: float) -> None:
    told = sized([heard(size, power=power)], ENDS)
    assert told is not None and told[0] == pytest.approx(np.log(size), abs=0.02)
    assert told[1] == pytest.approx(np.hypot(LEAST_SPREAD, 0.1 / power), rel=0.02)


def test_points_count_by_how_sure_they_are_and_what_they_differ_by_is_told() -> None:
    alike = sized([heard(0.2), heard(0.2)], ENDS)
    apart = sized([heard(0.1, noise=0.5), heard(0.3, noise=0.1)], ENDS)
    assert alike is not None and apart is not None
    assert 0.27 < np.exp(apart[0]) < 0.3 and apart[1] > alike[1]
    assert alike[1] < sized([heard(0.2)], ENDS)[1], "two looks are surer than one"  # type: ignore[index]


def test_a_burst_that_hardly_grows_with_the_size_says_none_and_a_louder_one_the_largest() -> None:
    assert sized([heard(0.2, power=0.1)], ENDS) is None
    assert sized([], ENDS) is None
    told = sized([heard(3.0)], ENDS)
    assert told is not None and told[0] == pytest.approx(ENDS[1])


def test_draws_that_scatter_make_it_unsure() -> None:
    even, wild = sized([heard(0.2)], ENDS), sized([heard(0.2, scatter=0.8)], ENDS)
    assert even is not None and wild is not None and wild[1] > even[1] + 0.1


SENSORS = tuple(f"bearing{k}.outer.y.acceleration" for k in (1, 2, 4))
POINT = Point(speed_hz=30.0)


def recorded(plan: AtlasPlan, term: TermSpec | None, pair: int, seed: int) -> Steady:
    """One second of a machine with white noise 30 dB below, through sensors three times as sensitive."""
    (response,) = run_members([plan.member(Draw(pair=pair, term=term), POINT)], SENSORS)
    assert isinstance(response, Response)
    clean = 3.0 * np.asarray(response.signals[:, round(SETTLE_S * RATE_HZ) :])
    noise = np.random.default_rng(seed).normal(size=clean.shape) * 0.03 * clean.std(axis=1, keepdims=True)
    return Steady(samples=clean + noise, rate_hz=RATE_HZ, speed_hz=30.0, estimate=None)  # type: ignore[arg-type]


def setting(term: TermSpec | None, *, told: bool = True, based: bool = True) -> SimpleNamespace:
    rest = tuple(Offsets(values=np.zeros(0)) for _ in range(2))
    machine = with_tooth_pairs(preset("paper"))
    plan = AtlasPlan(machine=machine, numbers=(), offsets=rest, twins=rest, draws=(), seed=3)
    now, before = recorded(plan, term, 0, 1), recorded(plan, None, 0, 2) if based else None
    gain = SimpleNamespace(chain=SimpleNamespace(gain_db=np.full((3, band_centres_hz().size), 20.0 * np.log10(3.0))))
    places = {"pinion": SimpleNamespace(told=told), "gear": SimpleNamespace(told=False)}
    return SimpleNamespace(
        machine=machine, plan=plan, data=(SimpleNamespace(point=POINT, spectra=(now, before)),), simulated=SENSORS,
        seen_through=(gain,), seed=1, direct=SimpleNamespace(places=places),
    )  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("key, size, name", [("tooth_crack", 0.4, "depth"), ("missing_tooth", 0.3, "width")])
def test_the_size_of_a_fault_is_found_by_its_burst(key: str, size: float, name: str) -> None:
    hidden = TermSpec(term=key, site="pinion", parameters={name: size})
    told = burst_sizes(setting(hidden), [f"{key}@pinion", f"{key}@gear", "rub@pinion"], Meter(map))  # type: ignore[arg-type]
    assert list(told) == [f"{key}@pinion"], "a gear whose tooth is not told has no size"
    found = told[f"{key}@pinion"]
    assert found.name == name and found.low < size < found.high
    assert found.value == pytest.approx(size, rel=0.3)


@pytest.mark.slow
def test_nothing_is_sized_whose_place_is_not_told_or_without_a_baseline() -> None:
    hidden = TermSpec(term="tooth_crack", site="pinion", parameters={"depth": 0.4})
    names = ["tooth_crack@pinion"]
    for one in (setting(hidden, told=False), setting(hidden, based=False)):
        assert burst_sizes(one, names, Meter(map)) == {}  # type: ignore[arg-type]
    assert burst_sizes(setting(hidden), [], Meter(map)) == {}  # type: ignore[arg-type]


def size(value: float, low: float, high: float) -> Severity:
    return Severity(name="depth", value=value, unit="1", low=low, high=high)


def test_a_size_that_levels_hardly_tell_is_that_of_the_burst() -> None:
    burst = size(0.21, 0.13, 0.35)
    assert joined(size(0.06, 0.01, 0.4), burst) is burst
    levels = size(0.1, 0.06, 0.16)
    assert joined(levels, None) is levels


def test_the_surer_of_two_sizes_counts_more_but_for_the_spread_that_both_have() -> None:
    """Spreads of 0.33 and 0.5, of which 0.3 is that of all sizes: 0.14 and 0.4, so eight and one of nine parts."""
    sure, rough = size(0.2, 0.2 / np.exp(0.33 * 1.645), 0.2 * np.exp(0.33 * 1.645)), size(0.1, 0.044, 0.2276)
    found = joined(rough, sure)
    assert np.log(found.value / 0.1) / np.log(2.0) == pytest.approx(0.16 / (0.16 + 0.0189), rel=0.01)
    assert found.low < 0.2 < found.high


def test_two_sizes_that_are_told_meet_between_and_what_they_differ_by_is_in_the_interval() -> None:
    both = joined(size(0.1, 0.06, 0.166), size(0.2, 0.12, 0.332))
    assert both.value == pytest.approx(np.sqrt(0.1 * 0.2), rel=0.02)
    assert both.low == pytest.approx(0.067, rel=0.05) and both.high == pytest.approx(0.3, rel=0.05)
    alike = joined(size(0.1, 0.06, 0.166), size(0.1, 0.06, 0.166))
    assert alike.value == pytest.approx(0.1) and (alike.low, alike.high) == pytest.approx((0.061, 0.164), rel=0.02)
