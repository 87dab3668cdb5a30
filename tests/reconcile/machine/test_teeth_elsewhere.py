"""A machine file or a label that cannot be of the recordings is told by where lines of teeth stand."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from reconcile.gate.findings import Gate
from reconcile.machine.engine import reconcile_machine
from reconcile.machine.teeth_elsewhere import Elsewhere, teeth_elsewhere, teeth_of
from reconcile.machine.unfitting import misfit_report, told_of, told_of_all
from signals.recording import Operating, Recording, Tacho
from sim.core.spec import MachineSpec
from sim.presets import preset
from tests.reconcile.machine.teeth import CHANNELS, RATE_HZ, SECONDS, TIME, seen, turning


@pytest.fixture(scope="module")
def machine() -> MachineSpec:
    """A pinion of 23 teeth."""
    return preset("paper-lightly-damped")


def with_teeth(machine: MachineSpec, count: int) -> MachineSpec:
    gears = [g.model_copy(update={"teeth": count}) if g.shaft == "input" else g for g in machine.gears]
    return machine.model_copy(update={"gears": gears})


def elsewhere(order: float, own: float = 23.0, stated_hz: float = 30.0, sure: bool = False) -> Elsewhere:
    return Elsewhere(stated_hz=stated_hz, order=order, own=own, mesh="f_m", sure=sure)


@pytest.mark.slow
@pytest.mark.parametrize(("true_hz", "teeth"), [(30.0, 23), (31.2, 23), (28.0, 23)], ids=["right", "4 %", "7 %"])
def test_the_right_machine_is_never_doubted(machine: MachineSpec, true_hz: float, teeth: int) -> None:
    """Nor where its label is a little off and the speed is found: 7 % is 21.5 teeth, which no gear has."""
    both = [turning(machine, seed, true_hz=true_hz) for seed in (1, 2)]
    data = seen(with_teeth(machine, teeth), both[0], baseline=both[1])
    assert teeth_elsewhere(with_teeth(machine, teeth), data, CHANNELS) == (data, ())


@pytest.mark.slow
def test_labels_that_are_far_off_at_two_speeds_are_told_with_the_speed(machine: MachineSpec) -> None:
    tests, baselines = (
        [turning(machine, seed + k, true_hz=hz, stated_hz=1.3 * hz) for k, hz in enumerate((24.0, 30.0))]
        for seed in (1, 3)
    )
    report = reconcile_machine(machine, tests, baselines)
    assert report.verdict == "measurement_fault" and report.fault is not None
    assert report.fault.kind == "speed_mismatch"
    assert "the shaft turned at 24 Hz, not at 31.2 Hz" in report.sentence and "likewise at 39 Hz" in report.sentence
    assert "another machine" not in report.sentence and report.causes == () and report.machine is None
    assert "speed" in report.next_experiment.sentence  # type: ignore[union-attr]


@pytest.mark.slow
def test_at_one_speed_another_machine_may_be_all_that_is_heard(machine: MachineSpec) -> None:
    both = [turning(machine, seed, stated_hz=39.0) for seed in (1, 2)]
    report = reconcile_machine(machine, [both[0]], [both[1]])
    assert report.verdict == "not_decidable" and report.fault is None
    assert "either the shaft turned at 30 Hz, not at 39 Hz, or another machine makes these lines" in report.sentence
    assert " 689.8, 1380" in report.sentence


@pytest.mark.slow
@pytest.mark.parametrize("noise", [0.0005, 0.2])
def test_a_label_three_times_too_high_is_told_though_the_files_teeth_stand_on_a_line(
    machine: MachineSpec, noise: float
) -> None:
    """Every third line is where the file's teeth would be; without noise each counts as much as it can."""

    def heard(seed: int) -> Recording:
        one = turning(machine, seed, stated_hz=90.0)
        return replace(one, samples=_teeth() + noise * np.random.default_rng(seed).normal(size=one.samples.shape))

    _, found = teeth_elsewhere(machine, seen(machine, heard(1), baseline=heard(2)), CHANNELS)
    assert len(found) == 1 and found[0].factor * 90.0 == pytest.approx(30.0, rel=0.01)


def _teeth() -> np.ndarray:
    lines = sum((np.sin(2 * np.pi * 690.0 * k * TIME + k) / k for k in range(1, 7)), np.zeros(TIME.size))
    return np.array([[1.0], [0.4]]) * lines


@pytest.mark.slow
def test_lines_that_stay_where_they_are_at_every_speed_are_another_machines(machine: MachineSpec) -> None:
    """Their order differs from speed to speed, and the label of one of them would have to be right."""
    fixed = [turning(machine, k, true_hz=41.0, stated_hz=hz) for k, hz in enumerate((24.0, 30.0), 1)]
    data = seen(machine, *fixed)
    assert teeth_elsewhere(machine, data, CHANNELS) == (data, ())


def with_lines(
    machine: MachineSpec, seed: int, own: int, orders: Sequence[float], rate_hz: float = RATE_HZ
) -> Recording:
    """So many harmonics of the file's teeth beside lines at other orders, at the true speed, in little noise."""
    time_s = np.arange(round(rate_hz * SECONDS)) / rate_hz
    every = [23.0 * k for k in range(1, own + 1)] + list(orders)
    lines = sum((np.sin(2 * np.pi * 30.0 * o * time_s + o) for o in every), np.zeros(time_s.size))
    noise = 0.1 * np.random.default_rng(seed).normal(size=(2, time_s.size))
    sound = turning(machine, seed, level=0.0)
    return replace(sound, samples=np.array([[1.0], [0.5]]) * lines + noise, sampling_rate_hz=rate_hz)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("own", "orders", "rate_hz"),
    [
        (1, [9.0 * k for k in range(1, 7)], RATE_HZ),
        (1, [37.0 * k for k in range(1, 7)], RATE_HZ),
        (0, [41.13], RATE_HZ),
        (0, [9.0, 18.0], RATE_HZ),
        (0, [9.0 * k for k in range(1, 7)], 1500.0),
    ],
    ids=["a fan beside a helical mesh", "a pump beside it", "one line", "two lines", "a mesh beyond what is heard"],
)
def test_other_parts_beside_a_quiet_mesh_are_no_other_teeth(
    machine: MachineSpec, own: int, orders: list[float], rate_hz: float
) -> None:
    test, baseline = (with_lines(machine, seed, own, orders, rate_hz) for seed in (1, 2))
    data = seen(machine, test, baseline=baseline)
    assert teeth_elsewhere(machine, data, CHANNELS) == (data, ())


@pytest.mark.slow
@pytest.mark.parametrize(("shaft", "kept"), [(8, True), (0, False)])
def test_a_label_that_the_shafts_own_lines_correct_is_followed(machine: MachineSpec, shaft: int, kept: bool) -> None:
    """8.7 % off, which 21 teeth of 23 would be too."""
    true_hz = 30.0 * 21 / 23

    def heard(seed: int) -> Recording:
        sound = turning(machine, seed, true_hz=true_hz)
        own = sum((np.sin(2 * np.pi * k * true_hz * TIME + k) for k in range(1, shaft + 1)), np.zeros(TIME.size))
        return replace(sound, samples=sound.samples + own)

    found = teeth_elsewhere(machine, seen(machine, heard(1), baseline=heard(2)), CHANNELS)[1]
    assert (found == ()) is kept


@pytest.mark.slow
@pytest.mark.parametrize("count", [25, 31])
def test_other_teeth_than_the_files_are_told_with_their_number(machine: MachineSpec, count: int) -> None:
    """Two teeth are 8 % of the speed: the search for the speed would have followed them."""
    wrong = with_teeth(machine, count)
    data = seen(wrong, turning(machine, 1), baseline=turning(machine, 2))
    kept, found = teeth_elsewhere(wrong, data, CHANNELS)
    assert kept == () and len(found) == 1
    assert teeth_of(found[0], wrong) == ("pinion", count, 23)
    said = told_of(found[0], wrong)
    assert f"pinion has 23 teeth, not {count}" in said and "or the shaft turned at" in said and "1380" in said


@pytest.mark.slow
def test_with_pulses_the_speed_is_no_question(machine: MachineSpec) -> None:
    wrong = with_teeth(machine, 25)
    tacho = Tacho(shaft="input", pulse_times_s=np.arange(0.0, SECONDS, 1 / 30.0), pulses_per_revolution=1)
    both = [replace(turning(machine, seed), tacho=tacho) for seed in (1, 2)]
    _, found = teeth_elsewhere(wrong, seen(wrong, both[0], baseline=both[1]), CHANNELS)
    said = told_of(found[0], wrong)
    assert "pinion has 23 teeth, not 25, or another machine" in said and "the shaft turned" not in said


@pytest.mark.slow
def test_a_point_of_its_own_is_left_out_and_told(machine: MachineSpec) -> None:
    wrong = turning(machine, 3, true_hz=30.0, stated_hz=45.0)
    data = seen(machine, turning(machine, 1), wrong)
    kept, found = teeth_elsewhere(machine, data, CHANNELS)
    assert [p.point.speed_hz for p in kept] == [30.0]
    assert [one.stated_hz for one in found] == [45.0] and abs(found[0].factor * 45.0 - 30.0) < 0.1


@pytest.mark.slow
@pytest.mark.parametrize("only", ["test", "baseline"])
def test_what_only_one_of_both_shows_is_no_other_machine(machine: MachineSpec, only: str) -> None:
    """That test and baseline did not turn alike is told elsewhere."""
    off, right = turning(machine, 1, stated_hz=39.0, true_hz=39.0), turning(machine, 2, stated_hz=39.0)
    test, baseline = (right, off) if only == "test" else (off, right)
    data = seen(machine, test, baseline=baseline)
    assert teeth_elsewhere(machine, data, CHANNELS) == (data, ())


@pytest.mark.slow
@pytest.mark.parametrize("orders", [(1, 2, 3, 4, 5, 6), (3.57, 7.14, 10.71, 14.28)], ids=["shaft", "race"])
def test_lines_of_shaft_and_races_are_no_teeth(machine: MachineSpec, orders: tuple[float, ...]) -> None:
    """A machine whose teeth are not heard at all."""

    def heard(seed: int) -> Recording:
        lines = sum(np.sin(2 * np.pi * 30.0 * k * TIME + k) for k in orders)
        noise = 0.2 * np.random.default_rng(seed).normal(size=(2, round(RATE_HZ * SECONDS)))
        return replace(turning(machine, seed, level=0.0), samples=lines + noise)

    data = seen(machine, heard(1), baseline=heard(2))
    assert teeth_elsewhere(machine, data, CHANNELS) == (data, ())


@pytest.mark.parametrize(("harmonics", "told"), [((1, 2, 3, 4), True), ((1,), False)])
def test_without_teeth_three_harmonics_of_the_shaft_tell_its_speed(harmonics: tuple[int, ...], told: bool) -> None:
    rotor = preset("rotor")

    def heard(seed: int) -> Recording:
        lines = sum(np.sin(2 * np.pi * 30.0 * k * TIME + k) / k for k in harmonics)
        return Recording(
            sampling_rate_hz=RATE_HZ,
            channels=(CHANNELS[0],),
            samples=(lines + 0.05 * np.random.default_rng(seed).normal(size=TIME.size))[None],
            operating=Operating(shaft="input", speed_hz=39.0),
        )

    kept, found = teeth_elsewhere(rotor, seen(rotor, heard(1), baseline=heard(2)), CHANNELS[:1])
    assert len(found) == int(told) and len(kept) == int(not told)
    for one in found:
        said = told_of(one, rotor)
        assert "lines as of a shaft stand at 30, 60, 90 Hz" in said
        assert "either the shaft turned at 30 Hz, not at 39 Hz, or another machine" in said


def test_points_that_say_the_same_are_told_once(machine: MachineSpec) -> None:
    alike = [elsewhere(17.7, stated_hz=hz) for hz in (22.5, 30.0, 39.0)]
    said = told_of_all(alike, machine)
    assert said.count("lines as of teeth") == 1 and said.endswith("likewise at 30 and 39 Hz")
    assert told_of_all([*alike, elsewhere(30.7, stated_hz=50.0)], machine).count("lines as of teeth") == 2


@pytest.mark.parametrize(
    ("found", "verdict", "asked"),
    [
        ([elsewhere(17.69)], "not_decidable", "Check the speed"),
        ([elsewhere(17.69), elsewhere(17.7, stated_hz=39.0)], "measurement_fault", "Check the speed"),
        ([elsewhere(25.02)], "not_decidable", "numbers of teeth in the machine file and the stated speeds"),
        ([elsewhere(25.02, sure=True)], "not_decidable", "pulses a revolution"),
    ],
)
def test_the_verdict_says_what_is_known(machine: MachineSpec, found: list[Elsewhere], verdict: str, asked: str) -> None:
    gate = Gate(findings=(), baselines=(), tests=(), fault=None, usable=True)
    report = misfit_report(found, machine, [], gate, {})
    assert report.verdict == verdict and (report.fault is not None) == (verdict == "measurement_fault")
    assert report.next_experiment is not None and asked in report.next_experiment.sentence
    assert report.undecidable


@pytest.mark.slow
def test_no_machine_has_other_teeth_at_one_speed_than_at_another(machine: MachineSpec) -> None:
    """Where the lines are clear at one speed, those at another need less; not where the file's own stand there."""
    wrong = with_teeth(machine, 29)
    clear = {"true_hz": 30.0, "stated_hz": 30.0}
    for other, found in ((machine, 2), (wrong, 1)):
        points = [
            seen(wrong, turning(m, k, **how), baseline=turning(m, k + 1, **how))[0]
            for k, (m, how) in enumerate(
                ((machine, clear), (other, {"true_hz": 24.0, "stated_hz": 24.0, "level": 0.08})), start=1
            )
        ]
        assert teeth_elsewhere(wrong, points[1:], CHANNELS)[1] == (), "faint, it is not told by itself"
        kept, told = teeth_elsewhere(wrong, points, CHANNELS)
        assert len(told) == found and len(kept) == 2 - found
        assert {one.stated_hz for one in told} == ({24.0, 30.0} if found == 2 else {30.0})
