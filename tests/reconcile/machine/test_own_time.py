"""What modulates the teeth at one frequency in Hz at every speed is told; orders, hum and forests of lines are not."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import pytest

from reconcile.machine.own_time import OwnTime, own_time, with_own_time
from reconcile.observe.extract import USABLE
from reconcile.observe.observation import observe
from reconcile.observe.watch import bases_at, watch_list
from reconcile.report.action import to_do
from reconcile.verdict import Cause, HeldOut, Report, SensorFault, Where, Word
from signals.recording import Operating, Recording
from signals.series import FloatArray
from sim.core.spec import MachineSpec
from sim.presets import preset
from tests.reconcile.machine.teeth import CHANNELS, RATE_HZ, TIME

NAMES = [c.name for c in CHANNELS]
SPEEDS_HZ = (22.5, 30.0)
Modulation = Callable[[float], FloatArray]


@pytest.fixture(scope="module")
def machine() -> MachineSpec:
    return preset("paper-lightly-damped")


def steady(_hz: float) -> FloatArray:
    return np.zeros(TIME.size)


def at_hz(frequency_hz: float, depth: float = 0.05) -> Modulation:
    return lambda _hz: depth * np.cos(2 * np.pi * frequency_hz * TIME)


def at_order(order: float) -> Modulation:
    return lambda hz: 0.2 * np.cos(2 * np.pi * order * hz * TIME)


def at_many(hz: float) -> FloatArray:
    """A forest: many frequencies, others at every speed."""
    rng = np.random.default_rng(round(hz))
    return sum((0.05 * np.cos(2 * np.pi * f * TIME) for f in rng.uniform(10, 250, 60)), np.zeros(TIME.size))


def recorded(machine: MachineSpec, hz: float, seed: int, modulation: Modulation, hum: float = 0.0) -> Recording:
    rng = np.random.default_rng(seed)
    mesh = bases_at(machine, hz)["f_m"]
    teeth = sum(np.sin(2 * np.pi * mesh * k * TIME + k) / k for k in range(1, 7))
    samples = np.array([[1.0], [0.4]]) * teeth * (1 + modulation(hz)) + 0.05 * rng.normal(size=(2, TIME.size))
    samples += hum * np.cos(2 * np.pi * 100 * TIME)
    operating = Operating(shaft="input", speed_hz=hz, torque_nm=25.0)
    return Recording(sampling_rate_hz=RATE_HZ, channels=CHANNELS, samples=samples, operating=operating)


def told(
    machine: MachineSpec,
    now: Modulation,
    before: Modulation | None = steady,
    speeds_hz: Sequence[float] = SPEEDS_HZ,
    hum: float = 0.0,
) -> OwnTime | None:
    tests = [recorded(machine, hz, 10 + k, now, hum) for k, hz in enumerate(speeds_hz)]
    baselines = [] if before is None else [recorded(machine, hz, k, before) for k, hz in enumerate(speeds_hz)]
    return own_time(machine, observe(machine, watch_list(machine), tests, baselines, seed=0), NAMES)


@pytest.mark.slow
@pytest.mark.parametrize(("hz", "supply_hz"), [(100.0, 50.0), (60.0, 60.0), (37.0, None)])
def test_a_frequency_of_its_own_is_found(machine: MachineSpec, hz: float, supply_hz: float | None) -> None:
    speeds_hz = (22.5, 31.0)
    seen = told(machine, at_hz(hz), speeds_hz=speeds_hz)
    assert seen is not None
    assert seen.hz == pytest.approx(hz, abs=0.7)
    assert seen.supply_hz == supply_hz
    assert {line.locked_to for line in seen.lines} == {"mains" if supply_hz else ""}
    assert {line.channel for line in seen.lines} <= set(NAMES)
    for k, speed in enumerate(speeds_hz):
        mesh = bases_at(machine, speed)["f_m"]
        below, above = seen.lines[2 * k : 2 * k + 2]
        assert (below.frequency_hz, above.frequency_hz) == pytest.approx((mesh - seen.hz, mesh + seen.hz))
        assert below.speed_hz == speed
        assert below.change_db > 6


@pytest.mark.slow
def test_what_turns_with_a_shaft_is_none(machine: MachineSpec) -> None:
    assert told(machine, steady) is None
    # 90 Hz is the fourth order at one speed and the third at the other
    both = told(machine, lambda hz: at_order(3.0)(hz) + at_order(4.0)(hz))
    assert both is None
    assert told(machine, at_order(2.7)) is None
    assert told(machine, at_many) is None
    assert told(machine, at_hz(60.0)) is None, "the second order of one of two speeds"


@pytest.mark.slow
def test_what_a_bearing_modulates_with_is_none(machine: MachineSpec) -> None:
    """At 20 Hz its third line is where the second is at 30 Hz."""
    outer, slipped = 2.57355, 0.983
    several = lambda hz: sum(at_order(k * slipped * outer)(hz) for k in (1, 2, 3))  # noqa: E731
    assert told(machine, several, speeds_hz=(20.0, 30.0)) is None
    assert told(machine, at_hz(150.0), speeds_hz=(21.7, 31.7)) is not None


@pytest.mark.slow
def test_harmonics_that_not_all_speeds_reach_are_left_out(machine: MachineSpec) -> None:
    fast = RATE_HZ * USABLE / (2.5 * 23)
    seen = told(machine, at_hz(100.0), speeds_hz=(22.5, fast))
    assert seen is not None and seen.hz == pytest.approx(100.0, abs=0.7)


@pytest.mark.slow
def test_hum_that_was_added_and_what_the_baseline_has_are_none(machine: MachineSpec) -> None:
    assert told(machine, steady, hum=0.5) is None
    assert told(machine, at_hz(100.0), at_hz(100.0)) is None


@pytest.mark.slow
def test_one_speed_or_no_baseline_say_nothing(machine: MachineSpec) -> None:
    assert told(machine, at_hz(100.0), speeds_hz=(30.0,)) is None
    assert told(machine, at_hz(100.0), None) is None


SEEN = OwnTime(hz=100.1, rise_db=5.0, elsewhere_db=0.3)


def said(verdict: Word, score: float = 5.0, fault: SensorFault | None = None) -> Report:
    causes = (Cause(term="outer_spall", site="bearing1", score=score, named=verdict == "explained"),)
    held = HeldOut(
        metric="m",
        unit="dB",
        before=2.0,
        after=1.0,
        gain=0.5,
        gain_low=0.4,
        gain_high=0.6,
        retuned=None,
        black_box=None,
        placebo=None,
    )
    return Report(
        verdict=verdict, sentence="so.", level="machine", causes=causes, fault=fault, where=Where(), held_out=held
    )


HUM, LOOSE = SensorFault(kind="mains_hum", channel="a"), SensorFault(kind="loose_sensor", channel="a")


@pytest.mark.parametrize(
    ("report", "answers"),
    [
        (said("nothing_missing"), True),
        (said("not_decidable"), True),
        (said("unknown_physics"), True),
        (said("ambiguous"), True),
        (said("ambiguous", score=30.0), False),
        (said("explained"), False),
        (said("measurement_fault", fault=HUM), True),
        (said("measurement_fault", fault=LOOSE), False),
    ],
)
def test_it_is_the_answer_where_nothing_sure_speaks_for_another(
    machine: MachineSpec, report: Report, answers: bool
) -> None:
    found = with_own_time(report, SEEN, machine)
    assert found.stages[-1]["name"] == "own time"
    if answers:
        assert found.verdict == "unknown_physics"
        assert "100.1 Hz at every speed" in found.sentence
        assert "supply of 50 Hz" in found.sentence
        assert found.where.sites[0].site == "input"
        assert sum(site.weight for site in found.where.sites) == pytest.approx(1.0)
        assert not any(cause.named for cause in found.causes)
        assert found.fault is None
        assert found.held_out is None, "no gain of an effect that is not the answer"
        assert "drive off" in to_do(found)
        assert to_do(found).startswith("look at input first")
    else:
        assert (found.verdict, found.sentence, found.fault) == (report.verdict, report.sentence, report.fault)
        assert "100.1 Hz" in found.where.limits[-1]
    assert with_own_time(report, None, machine) is report
