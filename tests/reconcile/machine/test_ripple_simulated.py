"""The size of a torque by machines that are simulated with it."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from reconcile.atlas.candidates import with_effects
from reconcile.atlas.plan import Point, at_point, with_tooth_pairs
from reconcile.atlas.run import RATE_HZ, SETTLE_S, run_members
from reconcile.calibrate.uncertain import draw_offsets, moved, uncertain_numbers
from reconcile.machine.ripple import (
    FIRST_SHARE,
    MACHINES,
    MOST_SHARE,
    PASSES,
    SETTLED_DB,
    Seen,
    _held,
    _score,
    _severity,
    _torque_nm,
    ripple,
    sidebands,
)
from sim.core.errors import Diverged
from sim.core.response import Response
from sim.core.spec import MachineSpec, TermSpec
from sim.presets import preset
from sim.solve.ensemble import Member
from tests.reconcile.machine.teeth import at_order, modulated, points_of
from tests.reconcile.machine.torques import FOUR, few

SPEEDS_HZ = (24.0, 30.0, 37.0)
STOPPED = Diverged(time_s=0.5, dof="gear.y", advice="")


@pytest.fixture(scope="module")
def machine() -> MachineSpec:
    return with_tooth_pairs(preset("paper-lightly-damped"))


def told(points: list[int]) -> Seen:
    """All but the last have risen."""
    return Seen(
        point=np.array(points),
        ratio_db=np.zeros(len(points)),
        risen_db=np.full(len(points), 20.0),
        told=np.arange(len(points)) < len(points) - 1,
        places=tuple((23.0, 1 + k % 2, 1, k) for k in range(len(points))),
    )


POINTS = [0, 0, 1, 1, 2, 2, 2]


def answered(monkeypatch: pytest.MonkeyPatch, off: Any) -> list[float]:
    """`off` (amplitude) in place of simulations; the amplitudes that were asked for."""
    asked: list[float] = []

    def simulated(_setting: Any, _told: Any, _seen: Any, amplitude: float) -> Any:
        asked.append(amplitude)
        return off(amplitude)

    monkeypatch.setattr("reconcile.machine.ripple._off", simulated)
    return asked


def test_the_size_is_that_at_which_machines_show_the_same(
    machine: MachineSpec, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Twice the torque, twice as large; one sideband of each machine is far off, and a bound more so."""
    scatter = np.array([[-1.0, 0.0, 1.0, 40.0, -0.5, 0.5, 90.0]] * 3) + np.array([[-2.0], [0.0], [2.0]])
    scatter[:, :6] -= np.mean(np.median(scatter[:, :6], axis=1))
    asked = answered(monkeypatch, lambda a: 20 * np.log10(3.0 / a) + scatter)
    found = ripple(few(machine, ()), FOUR, told(POINTS))
    assert found is not None and found.severity.value == pytest.approx(3.0)
    assert asked == pytest.approx([FIRST_SHARE * 25.0, 3.0]), "settled"
    assert found.term == TermSpec(
        term="torque_ripple", site="input", parameters={"amplitude": found.severity.value, "order": 4.0, "phase": 0.0}
    )
    assert found.machine == with_effects(machine, (found.term,))
    wanted = _severity(3.0, scatter[:, :6])
    assert (found.severity.low, found.severity.high) == pytest.approx((wanted.low, wanted.high))
    left = scatter.mean(axis=0)
    assert found.held.after == pytest.approx(_held(told(POINTS), left, 1).after)
    assert found.score == pytest.approx(_score(told(POINTS), left))
    other = machine.model_copy(update={"name": "fitted"})
    again = ripple(few(machine, (), fitted_machine=other), FOUR, told(POINTS))
    assert again is not None and again.machine.name == "fitted", "the machine that agrees with the baseline"


def test_what_bends_is_come_near_until_little_is_left(machine: MachineSpec, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where twice the torque shows 1.4 times as much each pass halves the way, 7.6 dB."""
    asked = answered(monkeypatch, lambda a: np.full((2, 7), 10 * np.log10(3.0 / a)))
    found = ripple(few(machine, ()), FOUR, told(POINTS))
    first = FIRST_SHARE * 25.0
    assert asked == pytest.approx([first, first**0.5 * 3.0**0.5, first**0.25 * 3.0**0.75])
    assert 10 * np.log10(3.0 / asked[-1]) < SETTLED_DB < 10 * np.log10(3.0 / asked[-2])
    assert found is not None and found.severity.value == pytest.approx(first**0.125 * 3.0**0.875)
    assert found.score == pytest.approx(_score(told(POINTS), np.zeros(7))), "what is left is scatter"


def test_where_machines_show_too_few_of_what_rose_nothing_is_told(
    machine: MachineSpec, monkeypatch: pytest.MonkeyPatch
) -> None:
    off = np.zeros((2, 7))
    off[0, :3] = np.nan
    answered(monkeypatch, lambda _a: off)
    assert ripple(few(machine, ()), FOUR, told(POINTS)) is None


def test_a_search_ends(machine: MachineSpec, monkeypatch: pytest.MonkeyPatch) -> None:
    asked = answered(monkeypatch, lambda _a: np.full((2, 7), -2.0))
    found = ripple(few(machine, ()), FOUR, told(POINTS))
    assert len(asked) == PASSES and found is not None
    assert found.severity.value == pytest.approx(FIRST_SHARE * 25.0 * 10 ** (-2.0 * PASSES / 20.0)), "each step once"


@pytest.mark.parametrize(("torque_nm", "runs"), [(0.99 * MOST_SHARE * 25.0, True), (1.01 * MOST_SHARE * 25.0, False)])
def test_a_torque_that_turns_round_is_no_ripple(
    torque_nm: float, runs: bool, machine: MachineSpec, monkeypatch: pytest.MonkeyPatch
) -> None:
    answered(monkeypatch, lambda a: np.full((2, 7), 20 * np.log10(torque_nm / a)))
    assert (ripple(few(machine, ()), FOUR, told(POINTS)) is not None) is runs


def test_where_no_such_machine_runs_nothing_is_told(machine: MachineSpec, monkeypatch: pytest.MonkeyPatch) -> None:
    answered(monkeypatch, lambda _a: None)
    assert ripple(few(machine, ()), FOUR, told(POINTS)) is None


def test_what_machines_cannot_show_is_left_out(machine: MachineSpec, monkeypatch: pytest.MonkeyPatch) -> None:
    """As a bound it hinders nothing."""
    off = np.zeros((2, 7))
    off[1, 6] = np.nan
    answered(monkeypatch, lambda _a: off)
    found = ripple(few(machine, ()), FOUR, told(POINTS))
    assert found is not None and found.severity.value == pytest.approx(FIRST_SHARE * 25.0)
    assert np.isfinite(found.score) and found.held.gain == 1.0


def test_what_rose_beyond_the_band_of_the_machines_is_left_out(
    machine: MachineSpec, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A rounded speed may put one there; the search goes on with the others."""

    def simulated(_setting: Any, those: Seen, _seen: Any, amplitude: float) -> Any:
        beyond = np.array([place[3] == 1 for place in those.places])
        return np.where(beyond, np.nan, np.full((2, those.point.size), 20.0 * np.log10(3.0 / amplitude)))

    monkeypatch.setattr("reconcile.machine.ripple._off", simulated)
    found = ripple(few(machine, ()), FOUR, told(POINTS))
    assert found is not None and found.severity.value == pytest.approx(3.0)


def test_the_search_begins_with_a_share_of_the_shafts_torque(machine: MachineSpec) -> None:
    assert _torque_nm(machine, "input") == pytest.approx(25.0)
    assert _torque_nm(machine, "output") == pytest.approx(25.0 * 81 / 23)
    assert _torque_nm(machine.model_copy(update={"loads": []}), "input") == 1.0


def of(term: TermSpec | None) -> float:
    return 0.0 if term is None else float(term.parameters["amplitude"])


def shown(member: Member, channels: Any, depth: float) -> Response:
    """Teeth that a torque modulates with a depth a newton metre; sensors as they are sorted, after the transient."""
    assert member.machine.operating is not None
    hz, torque = member.machine.operating.speed_hz, next(t for t in member.machine.terms if t.term == "torque_ripple")
    wave = at_order(float(torque.parameters["order"]), depth * of(torque))
    signals = modulated(member.machine, hz, member.seed, wave).samples
    before = 50.0 * np.random.default_rng(0).normal(size=(2, round(SETTLE_S * RATE_HZ)))
    assert list(channels) == sorted(channels)
    rows: Any = np.concatenate([before, signals], axis=1)[::-1]
    return Response(
        machine=member.machine, sampling_rate_hz=RATE_HZ, channels=(), signals=rows, bases_hz={}, derived={},
        quality=None, warnings=(), contact_share={}, seed=0, version="",  # type: ignore[arg-type]
    )  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("lost", [(), (0, 3), tuple(range(MACHINES))])
def test_machines_that_agree_with_the_baseline_are_simulated_and_those_that_stop_left_out(
    lost: tuple[int, ...], machine: MachineSpec, monkeypatch: pytest.MonkeyPatch
) -> None:
    """All of them show 0.1 a newton metre, so that 0.3 is three of them, and each point is at its own speed."""
    asked: list[tuple[float, list[int], set[float], int]] = []

    def run(members: Any, channels: Any) -> list[Any]:
        speeds = {m.machine.operating.speed_hz for m in members}
        phases = {float(t.parameters["phase"]) for m in members for t in m.machine.terms}
        asked.append((of(members[0].machine.terms[-1]), [m.seed for m in members], speeds, len(phases)))
        return [STOPPED if m.seed in lost else shown(m, channels, 0.1) for m in members]

    monkeypatch.setattr("reconcile.machine.ripple.run_members", run)
    data = points_of(machine, at_order(4.0, 0.3), speeds_hz=SPEEDS_HZ)
    found = ripple(few(machine, data), FOUR, sidebands(machine, data, 4.0))
    if len(lost) == MACHINES:
        assert found is None
        return
    assert found is not None and found.severity.value == pytest.approx(3.0, rel=0.02)
    assert found.held.gain > 0.9
    assert [one[2] for one in asked] == [{hz} for hz in SPEEDS_HZ] * 2, "twice the torque, twice as large"
    assert all(one[1] == list(range(MACHINES)) and one[3] == MACHINES for one in asked), "phases are not known"
    assert {round(one[0], 3) for one in asked[:3]} == {FIRST_SHARE * 25.0}


def test_only_sound_machines_of_the_kind_are_given_a_torque(
    machine: MachineSpec, monkeypatch: pytest.MonkeyPatch
) -> None:
    """No twin of one, nor one twice, where there are few; each moved as the plan says."""
    asked: list[list[Member]] = []

    def run(members: Any, channels: Any) -> list[Any]:
        asked.append(list(members))
        return [STOPPED for _ in members]

    monkeypatch.setattr("reconcile.machine.ripple.run_members", run)
    setting = few(machine, [SimpleNamespace(point=Point(speed_hz=hz)) for hz in SPEEDS_HZ], pairs=3)
    assert ripple(setting, FOUR, told(POINTS)) is None
    for members, hz in zip(asked, SPEEDS_HZ, strict=True):
        assert [m.seed for m in members] == [0, 1, 2]
        for pair, one in enumerate(members):
            sound = moved(machine, setting.plan.numbers, setting.plan.offsets[pair])
            assert one.machine.model_copy(update={"terms": []}) == at_point(sound, Point(speed_hz=hz))


def recorded(machine: MachineSpec, truth: MachineSpec, channels: Any, amplitude: float) -> Any:
    """Operating points of a simulated machine, sound and with a torque of order 4, with a little noise."""
    rng = np.random.default_rng(0)
    torque = TermSpec(
        term="torque_ripple", site="input", parameters={"amplitude": amplitude, "order": 4.0, "phase": 0.4}
    )
    data = []
    for hz in SPEEDS_HZ:
        sound = at_point(truth, Point(speed_hz=hz))
        runs = run_members([Member(machine=with_effects(sound, terms), seed=5) for terms in ((torque,), ())], channels)
        spectra = []
        for one in runs:
            assert isinstance(one, Response)
            samples = one.signals[:, round(SETTLE_S * RATE_HZ) :]
            samples = samples + 0.01 * samples.std(axis=1, keepdims=True) * rng.normal(size=samples.shape)
            spectra.append(SimpleNamespace(samples=samples, rate_hz=RATE_HZ, speed_hz=hz))
        data.append(SimpleNamespace(point=Point(speed_hz=hz), spectra=tuple(spectra)))
    return tuple(data)


@pytest.mark.slow
@pytest.mark.parametrize(("amplitude", "other"), [(1.3, False), (4.0, True)])
def test_a_torque_of_a_simulated_machine_is_told_within_its_interval(
    amplitude: float, other: bool, machine: MachineSpec
) -> None:
    """5 % of the input's torque and 16 %, on the nominal machine and on one of its kind that is none of the plan's."""
    numbers = uncertain_numbers(machine)
    truth = moved(machine, numbers, draw_offsets(numbers, np.random.default_rng(11))) if other else machine
    setting = few(machine, ())
    setting.data = recorded(machine, truth, setting.simulated, amplitude)
    seen = sidebands(machine, setting.data, 4.0)
    assert seen.enough
    found = ripple(setting, FOUR, seen)
    assert found is not None
    low, high = found.severity.low, found.severity.high
    assert low is not None and high is not None and low < amplitude < high
    assert high / low < 4.0
    assert found.held.gain > 0.5 and found.held.gain_low > 0.3
    assert found.held.black_box is not None and found.held.gain > found.held.black_box
    assert found.score > 10.0
    assert found.machine.terms[-1].parameters["order"] == 4.0
