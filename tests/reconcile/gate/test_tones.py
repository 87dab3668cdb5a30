"""Tones that stay in Hz at every speed are told and taken out; a structure's modes and the machine's lines are not."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import lfilter

from reconcile.gate import Gate, inspect_measurement
from reconcile.gate.tones import Heard, _staying, fixed_tones, tone_findings
from signals.recording import Operating, Recording
from signals.series import FloatArray
from sim.core.response import Channel

RATE_HZ, SECONDS, TEETH = 12000.0, 2.0, 23
TIME = np.arange(int(RATE_HZ * SECONDS)) / RATE_HZ
SPEEDS_HZ = (22.5, 30.0, 39.0)
NAMES = ("a0", "a1")
Adds = Callable[[FloatArray, float, np.random.Generator], FloatArray]


def nothing(_turns: FloatArray, _hz: float, _rng: np.random.Generator) -> FloatArray:
    return np.zeros(TIME.size)


def inverter(turns: FloatArray, _hz: float, _rng: np.random.Generator) -> FloatArray:
    beside = np.sin(2 * np.pi * (4013 * TIME + 4 * turns))
    return np.asarray(np.sin(2 * np.pi * 2007 * TIME) + 0.7 * np.sin(2 * np.pi * 4013 * TIME) + 0.5 * beside)


def ringing(_turns: FloatArray, _hz: float, rng: np.random.Generator) -> FloatArray:
    """A mode of the structure at 1.5 kHz, lightly damped, driven by noise."""
    pole = np.exp((-2 * np.pi * 4 + 2j * np.pi * 1500) / RATE_HZ)
    x = lfilter([1.0], [1.0, -2 * pole.real, abs(pole) ** 2], rng.standard_normal(TIME.size))
    return np.asarray(2 * x / np.std(x))


def knocks(turns: FloatArray, _hz: float, _rng: np.random.Generator) -> FloatArray:
    """Once a turn: all harmonics of the shaft, some at one frequency at two speeds whose ratio is 3 to 4."""
    x = np.zeros(TIME.size)
    x[np.flatnonzero(np.diff(np.floor(turns)) > 0)] = 20.0
    return x


def recorded(hz: float, seed: int, adds: Adds, rows: tuple[float, float] = (1.0, 0.4)) -> Recording:
    rng = np.random.default_rng(seed)
    turns = np.cumsum(hz * (1 + 2e-3 * np.sin(2 * np.pi * 0.7 * TIME + seed))) / RATE_HZ
    lines = sum(np.sin(2 * np.pi * TEETH * k * turns + k) / k for k in range(1, 6))
    samples = np.stack([lines * g + 0.1 * rng.standard_normal(TIME.size) for g in (1.0, 0.6)])
    samples += np.asarray(rows)[:, None] * adds(turns, hz, rng)
    channels = tuple(Channel(name=n, quantity="acceleration", unit="m/s^2", location="bearing1") for n in NAMES)
    operating = Operating(shaft="input", speed_hz=hz)
    return Recording(sampling_rate_hz=RATE_HZ, channels=channels, samples=samples, operating=operating)


def told(adds: Adds, *, base: Adds | None = nothing, rows: tuple[float, float] = (1.0, 0.4)) -> Gate:
    baselines = [] if base is None else [recorded(hz, k, base, rows) for k, hz in enumerate(SPEEDS_HZ)]
    tests = [recorded(hz, 10 + k, adds, rows) for k, hz in enumerate(SPEEDS_HZ)]
    return inspect_measurement(baselines, tests, mesh_orders=(float(TEETH),))


def kinds(gate: Gate) -> set[tuple[str, str]]:
    return {(f.kind, f.channel) for f in gate.findings if f.fault}


@pytest.mark.slow
@pytest.mark.parametrize("base", [nothing, None])
def test_tones_of_a_drive_are_told_and_taken_out(base: Adds | None) -> None:
    gate = told(inverter, base=base)
    assert kinds(gate) == {("fixed_tones", "a0"), ("fixed_tones", "a1")}
    assert gate.fault is not None
    assert gate.fault.kind == "fixed_tones"
    assert "2007" in gate.fault.detail
    assert "4013" in gate.fault.detail
    assert "fixed orders beside them (1)" in gate.fault.detail
    for k, hz in enumerate(SPEEDS_HZ):
        rest = gate.tests[k].series("a0").samples - recorded(hz, 10 + k, nothing).series("a0").samples
        assert np.std(rest) < 0.1 * np.std(inverter(TIME * hz, hz, np.random.default_rng(0)))
    assert inspect_measurement(gate.baselines, gate.tests, mesh_orders=(float(TEETH),)).fault is None


@pytest.mark.slow
def test_what_the_baseline_has_as_well_is_left_alone() -> None:
    gate = told(inverter, base=inverter)
    assert kinds(gate) == set()
    same = gate.tests[0].samples == recorded(SPEEDS_HZ[0], 10, inverter).samples
    assert np.all(same)


@pytest.mark.slow
@pytest.mark.parametrize("adds", [nothing, ringing, knocks])
@pytest.mark.parametrize("base", [nothing, None])
def test_modes_and_harmonics_of_the_shaft_are_no_tones(adds: Adds, base: Adds | None) -> None:
    assert not [f for f in told(adds, base=base).findings if f.kind == "fixed_tones"]


def test_nothing_is_claimed_at_one_speed() -> None:
    tests = [recorded(30.0, k, inverter) for k in range(2)]
    found, clean = tone_findings(tests, ["test 1", "test 2"], [30.0, 30.2], [np.zeros(0)] * 2, [])
    assert found == ()
    assert clean == tests


def test_a_channel_that_only_one_test_has_is_not_asked() -> None:
    first, second = recorded(22.5, 1, inverter), recorded(39.0, 2, inverter)
    second = replace(second, channels=second.channels[1:], samples=second.samples[1:])
    found, _ = tone_findings([first, second], ["test 1", "test 2"], [22.5, 39.0], [np.zeros(0)] * 2, [])
    assert [f.channel for f in found] == ["a1"]


def forest(speed_hz: float) -> Heard:
    """Lines of an inner race with four sidebands to each side, to 4 kHz, 40 dB over the floor."""
    step = 1.0
    excess = np.ones(5_000)
    lines = [k * 5.415 * speed_hz + m * speed_hz for k in range(1, 40) for m in range(-4, 5)]
    for hz in lines:
        if 100.0 < hz < 4000.0:
            excess[round(hz / step)] = 1e4
    return Heard(excess, step, speed_hz, np.zeros(0))


def test_lines_of_a_pit_that_meet_by_chance_are_no_tones() -> None:
    pit = [forest(24.06), forest(39.9)]
    assert len(_staying(pit, 0)) >= 2, "they meet"
    assert fixed_tones(pit) == []
    alone = [Heard(np.ones(5_000), 1.0, h.speed_hz, np.zeros(0)) for h in pit]
    for h in alone:
        h.excess[1234] = 1e4
    assert fixed_tones(alone) == pytest.approx([1234.0])


def impulses(_turns: FloatArray, _hz: float, _rng: np.random.Generator) -> FloatArray:
    """A hundred times a second, with a ring of the input's filter."""
    since = np.mod(TIME - 0.003, 1 / 99.97)
    return np.asarray(8 * np.exp(-1500 * since) * np.sin(2 * np.pi * 3200 * since))


@pytest.mark.slow
@pytest.mark.parametrize("base", [nothing, None])
def test_impulses_of_the_supply_are_told_and_taken_out_whole(base: Adds | None) -> None:
    gate = told(impulses, base=base)
    assert kinds(gate) >= {("fixed_tones", "a0"), ("fixed_tones", "a1")}
    first = next(f for f in gate.findings if f.kind == "fixed_tones")
    assert "99.97 Hz, so impulses at the supply's rate" in first.detail and first.where == "99.97 Hz and multiples"
    for k, hz in enumerate(SPEEDS_HZ):
        sound = recorded(hz, 10 + k, nothing)
        left = gate.tests[k].samples[0] - sound.samples[0]
        assert np.var(left) < 0.02 * np.var(impulses(TIME, hz, np.random.default_rng(0))), "most of it is gone"


def at_supply(speed_hz: float, seed: int, *, struck: bool, turns: int) -> Recording:
    """A shaft whose multiples are strong, at a steady speed; `struck`: with impulses of the supply."""
    rng = np.random.default_rng(seed)
    x = sum(0.6 * np.sin(2 * np.pi * k * speed_hz * TIME + k + seed) for k in range(1, turns + 1))
    x = x + 0.2 * rng.standard_normal(TIME.size)
    x = x + 0.5 * impulses(TIME, speed_hz, rng) if struck else x
    channel = Channel(name="a0", quantity="acceleration", unit="m/s^2", location="bearing1")
    operating = Operating(shaft="input", speed_hz=speed_hz)
    return Recording(sampling_rate_hz=RATE_HZ, channels=(channel,), samples=x[None], operating=operating)


@pytest.mark.slow
@pytest.mark.parametrize("speeds", [(25.0, 31.0), (31.0, 25.0), (25.0, 30.0)])
@pytest.mark.parametrize("struck", [True, False])
def test_impulses_of_the_supply_at_a_shaft_of_half_its_rate(speeds: tuple[float, float], struck: bool) -> None:
    base = [at_supply(hz, k, struck=False, turns=12) for k, hz in enumerate(speeds)]
    tests = [at_supply(hz, k + 5, struck=struck, turns=12) for k, hz in enumerate(speeds)]
    own = [np.arange(1, 21) * hz for hz in speeds]
    found, _ = tone_findings(tests, ["test 1", "test 2"], speeds, own, base)
    assert [f.where[:5] for f in found] == (["99.97"] if struck else [])


@pytest.mark.slow
@pytest.mark.parametrize("speeds", [(25.0, 30.0), (25.0, 50.0), (30.0, 60.0), (20.0, 25.0), (25.0, 37.5), (24.7, 29.6)])
def test_strong_multiples_of_shafts_at_a_supply_s_rates_are_no_tones(speeds: tuple[float, float]) -> None:
    tests = [at_supply(hz, k, struck=False, turns=60) for k, hz in enumerate(speeds)]
    own = [np.arange(1, 21) * hz for hz in speeds]
    assert tone_findings(tests, ["test 1", "test 2"], speeds, own, [])[0] == ()


STRIKES = 3.5867
"""An outer race's order."""


def struck(hz: float, seed: int, *, adds: Adds = nothing, order: float = STRIKES, load: float = 0.0) -> Recording:
    """Even impacts on a mode at 2 kHz in noise; `load`: share by which their heights follow the turn."""
    rng = np.random.default_rng(seed)
    rung = 0.3 * rng.standard_normal(TIME.size)
    for at in np.arange(0.0, SECONDS, 1.0 / (order * hz)):  # between two samples: else they have lines of their own
        near = slice(int(at * RATE_HZ) + 1, int((at + 0.02) * RATE_HZ))
        high = 20.0 * (1.0 + load * np.cos(2 * np.pi * hz * at))
        rung[near] += high * np.exp(-750.0 * (TIME[near] - at)) * np.sin(2 * np.pi * 2000 * (TIME[near] - at))
    samples = (rung + 40.0 * adds(hz * TIME, hz, rng))[None, :]
    channels = (Channel(name="a0", quantity="acceleration", unit="m/s^2", location="bearing1"),)
    return Recording(
        sampling_rate_hz=RATE_HZ, channels=channels, samples=samples, operating=Operating(shaft="input", speed_hz=hz)
    )


@pytest.mark.parametrize("speeds", [(20.0, 40.0), (40.0, 20.0), (25.0, 30.0), (20.0, 30.0)])
def test_impacts_at_speeds_in_a_simple_ratio_are_no_tones(speeds: tuple[float, float]) -> None:
    tests = [struck(hz, k) for k, hz in enumerate(speeds)]
    assert tone_findings(tests, ["test 1", "test 2"], speeds, [np.zeros(0)] * 2, [])[0] == ()


CLOCK_HZ = (911.0, 1733.0, 2777.0, 3391.0, 4507.0)


def clock(_turns: FloatArray, _hz: float, _rng: np.random.Generator) -> FloatArray:
    return np.asarray(sum(0.1 * np.sin(2 * np.pi * hz * TIME) for hz in CLOCK_HZ))


@pytest.mark.parametrize("speeds", [(20.0, 40.0), (25.0, 30.0), (30.0, 25.0)])
def test_tones_beside_such_impacts_are_told_and_the_impacts_are_not(speeds: tuple[float, float]) -> None:
    tests = [struck(hz, k, adds=clock) for k, hz in enumerate(speeds)]
    (found,) = tone_findings(tests, ["test 1", "test 2"], speeds, [np.zeros(0)] * 2, [])[0]
    assert len(set(CLOCK_HZ) & set(found.tones_hz)) >= 4 and len(set(found.tones_hz) - set(CLOCK_HZ)) <= 1


@pytest.mark.parametrize("speeds", [(20.0, 40.0), (30.0, 40.0), (30.0, 60.0), (45.0, 30.0)])
def test_impulses_of_a_supply_stay_told_at_such_speeds(speeds: tuple[float, float]) -> None:
    """At 50 Hz in both: 2.5 times a turn in one and every second of them in the other."""
    tests = [struck(hz, k, order=50.0 / hz) for k, hz in enumerate(speeds)]
    (found,) = tone_findings(tests, ["test 1", "test 2"], speeds, [np.zeros(0)] * 2, [])[0]
    assert found.fault and "Hz stay there at every speed" in found.detail


INNER = 5.4133
KNOWN = (STRIKES * 1.002, INNER * 1.002, 0.3983)
"""As drawings have them: the parts slip; the last is a cage."""


@pytest.mark.parametrize("speeds", [(20.0, 40.0), (40.0, 20.0), (30.0, 20.0)])
def test_lines_turns_beside_known_impacts_are_no_tones(speeds: tuple[float, float]) -> None:
    """The second beside an inner race's at 20 Hz is the first at 40."""
    tests = [struck(hz, k, order=INNER, load=0.9) for k, hz in enumerate(speeds)]
    assert tone_findings(tests, ["test 1", "test 2"], speeds, [np.zeros(0)] * 2, [], KNOWN)[0] == ()


@pytest.mark.parametrize(("speeds", "order"), [((20.0, 40.0), INNER), ((40.0, 20.0), STRIKES), ((25.0, 30.0), INNER)])
def test_most_lone_tones_beside_known_impacts_are_told(speeds: tuple[float, float], order: float) -> None:
    lone = np.arange(911.0, 5000.0, 317.0)

    def switched(_turns: FloatArray, _hz: float, _rng: np.random.Generator) -> FloatArray:
        return np.asarray(sum(0.1 * np.sin(2 * np.pi * hz * TIME) for hz in lone))

    tests = [struck(hz, k, order=order, load=0.9, adds=switched) for k, hz in enumerate(speeds)]
    (found,) = tone_findings(tests, ["test 1", "test 2"], speeds, [np.zeros(0)] * 2, [], KNOWN)[0]
    assert len(set(lone) & set(found.tones_hz)) >= 8 and not set(found.tones_hz) - set(lone)


def test_a_lone_tone_is_told_beside_lines_that_stay() -> None:
    """As the 26th of an outer race's at 20 Hz and the 13th at 40 would stay, but for 0.3 % of it."""

    def one(_turns: FloatArray, _hz: float, _rng: np.random.Generator) -> FloatArray:
        return np.asarray(0.3 * np.sin(2 * np.pi * 1871.5 * TIME))

    tests = [struck(hz, k, adds=one) for k, hz in enumerate((20.0, 40.0))]
    (found,) = tone_findings(tests, ["test 1", "test 2"], (20.0, 40.0), [np.zeros(0)] * 2, [], KNOWN)[0]
    assert found.tones_hz == (1871.5,) and found.fault
