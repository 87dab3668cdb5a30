"""Recordings of which one did not turn as its description says are not compared, whatever that says."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.atlas.plan import Point
from reconcile.gate.findings import Gate
from reconcile.machine.engine import reconcile_machine
from reconcile.machine.turned import as_baselines_turned, told_apart, turned_alike, with_limits, with_unconfirmed
from reconcile.verdict import HeldOut, Report, Where
from signals.recording import Operating, Recording
from sim.core.spec import MachineSpec
from sim.presets import preset
from tests.reconcile.machine.teeth import CHANNELS, RATE_HZ, TIME, seen, turning


@pytest.fixture(scope="module")
def machine() -> MachineSpec:
    return preset("paper-lightly-damped")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("true_hz", "teeth", "kept", "word"),
    [
        (30.2, 1.0, True, ""),
        (28.5, 1.0, False, "turned at 28.5 Hz, the baseline at 30 Hz"),
        (25.0, 1.0, False, "in the test they are at about 25 Hz"),
        (30.0, 0.0, False, "no line of the test confirms"),
    ],
)
def test_a_test_that_turned_otherwise_than_its_baseline_is_left_out(
    machine: MachineSpec, true_hz: float, teeth: float, kept: bool, word: str
) -> None:
    data = seen(machine, turning(machine, 1, true_hz=true_hz, level=teeth), baseline=turning(machine, 2))
    alike, told = turned_alike(machine, data, CHANNELS)
    assert bool(alike) == kept
    assert told == () if not word else word in told[0], told


@pytest.mark.parametrize(
    ("method", "speed_hz", "said"),
    [("harmonics", 28.6, "lines show 28.6 Hz"), ("tacho", 28.6, "pulses show 28.6 Hz"), ("harmonics", 30.3, "")],
)
def test_a_label_that_is_off_in_both_is_a_remark(method: str, speed_hz: float, said: str) -> None:
    both = (SimpleNamespace(method=method, speed_hz=speed_hz),)
    point = SimpleNamespace(point=Point(speed_hz=30.0), turned=both, turned_before=both)
    alike, told = turned_alike(preset("paper-lightly-damped"), [point], CHANNELS)  # type: ignore[list-item]
    assert alike == (point,) and len(told) == bool(said)
    assert all(said in one and "stated are 30 Hz" in one and "baseline alike: that was taken" in one for one in told)


@pytest.mark.slow
def test_where_no_line_confirms_either_it_is_a_limit_and_no_more(machine: MachineSpec) -> None:
    data = seen(machine, turning(machine, 1, level=0.0), baseline=turning(machine, 2, level=0.0))
    alike, told = turned_alike(machine, data, CHANNELS)
    assert alike == data
    assert told == ("no line confirms the stated 30 Hz of every recording there",)


@pytest.mark.parametrize(("methods", "said"), [(("stated",), True), (("harmonics",), False), (("tacho",), False)])
def test_without_teeth_a_speed_that_no_line_of_the_test_confirms_is_a_limit(
    methods: tuple[str, ...], said: bool
) -> None:
    """A speed three times too high in both recordings of a rotor left no trace but in the folded steps."""
    turned = tuple(SimpleNamespace(method=m, speed_hz=90.0) for m in methods)
    baseline = (SimpleNamespace(method="stated", speed_hz=90.0),)
    silent = SimpleNamespace(recording=lambda channels: turning(preset("paper-lightly-damped"), 1, level=0.0))
    point = SimpleNamespace(point=Point(speed_hz=90.0), turned=turned, turned_before=baseline, spectra=(silent, None))
    alike, told = turned_alike(preset("rotor"), [point], CHANNELS)  # type: ignore[list-item]
    assert alike == (point,)
    assert bool(told) is said and all("no line of the test confirms the stated 90 Hz" in one for one in told)


@pytest.mark.parametrize(("level", "said"), [(1.0, "30 Hz, 0.333 times that"), (0.0, "")])
def test_the_clearest_line_is_told_beside_a_speed_that_no_line_confirms(level: float, said: str) -> None:
    """An unbalanced rotor whose label is three times its speed, in both recordings."""
    rotor = preset("rotor")
    both = [
        Recording(
            sampling_rate_hz=RATE_HZ,
            channels=(CHANNELS[0],),
            samples=level * (np.sin(2 * np.pi * 30.0 * TIME) + 0.05 * np.sin(2 * np.pi * 11.0 * TIME))[None]
            + 0.02 * np.random.default_rng(seed).normal(size=(1, TIME.size)),
            operating=Operating(shaft="input", speed_hz=90.0),
        )
        for seed in (1, 2)
    ]
    data = seen(rotor, both[0], baseline=both[1])
    alike, told = turned_alike(rotor, data, CHANNELS[:1])
    assert alike == data and len(told) == 1 and told[0].endswith(said)
    assert ("its clearest line" in told[0]) is bool(said)


def unsure(method: str = "stated", speed_hz: float = 39.13) -> SimpleNamespace:
    found = SimpleNamespace(method=method, speed_hz=speed_hz)
    return SimpleNamespace(point=Point(speed_hz=speed_hz), turned=(found,), turned_before=())


@pytest.mark.parametrize("verdict", ["unknown_physics", "explained", "nothing_missing"])
def test_without_teeth_what_differs_may_be_a_wrong_label(verdict: str) -> None:
    before = Report(verdict=verdict, sentence="So.", level="machine", where=Where())  # type: ignore[arg-type]
    report = with_unconfirmed(before, preset("rotor"), [unsure()])  # type: ignore[list-item]
    if verdict == "nothing_missing":
        assert report is before
        return
    assert "No line confirms the stated speed of 39.13 Hz (the machine file's speed is" in report.sentence
    assert report.verdict == ("not_decidable" if verdict == "unknown_physics" else verdict)
    if verdict == "unknown_physics":
        assert report.undecidable[0].endswith("the stated speed is wrong")
        assert report.next_experiment is not None and "tacho" in report.next_experiment.sentence


@pytest.mark.parametrize(("gain_low", "doubted"), [(0.45, False), (0.1, True)])
def test_a_named_effect_that_forecasts_well_confirms_the_speed_its_lines_hang_on(
    gain_low: float, doubted: bool
) -> None:
    held = HeldOut(
        metric="m", unit="dB", before=2.0, after=1.0, gain=0.5, gain_low=gain_low, gain_high=0.6, retuned=None,
        black_box=None, placebo=None,
    )  # fmt: skip
    before = Report(verdict="explained", sentence="So.", level="machine", where=Where(), held_out=held)
    report = with_unconfirmed(before, preset("rotor"), [unsure()])  # type: ignore[list-item]
    assert ("No line confirms" in report.sentence) == doubted


def test_what_keeps_its_own_time_hangs_on_no_speed() -> None:
    stages = ({"name": "self-excited"},)
    before = Report(verdict="unknown_physics", sentence="So.", level="machine", where=Where(), stages=stages)
    assert with_unconfirmed(before, preset("rotor"), [unsure()]) is before  # type: ignore[list-item]
    beside = replace(before, verdict="explained")
    assert "No line confirms" in with_unconfirmed(beside, preset("rotor"), [unsure()]).sentence  # type: ignore[list-item]


def test_one_confirmed_speed_speaks_for_the_labels() -> None:
    before = Report(verdict="unknown_physics", sentence="So.", level="machine", where=Where())
    some = [unsure(), unsure("harmonics", 30.0)]
    assert with_unconfirmed(before, preset("rotor"), some) is before  # type: ignore[arg-type]


def test_a_confirmed_speed_and_teeth_leave_the_report_alone() -> None:
    before = Report(verdict="unknown_physics", sentence="So.", level="machine", where=Where())
    assert with_unconfirmed(before, preset("rotor"), [unsure("tacho")]) is before  # type: ignore[list-item]
    assert with_unconfirmed(before, preset("paper-lightly-damped"), [unsure()]) is before  # type: ignore[list-item]


@pytest.mark.slow
def test_nothing_is_simulated_where_no_test_turned_as_its_baseline_did(machine: MachineSpec) -> None:
    report = reconcile_machine(machine, [turning(machine, 1, true_hz=28.5)], [turning(machine, 2)])
    assert report.verdict == "measurement_fault" and report.machine is None and report.causes == ()
    assert report.fault is not None and report.fault.kind == "speed_mismatch"
    assert "28.5 Hz" in report.sentence and "baseline" in report.next_experiment.sentence  # type: ignore[union-attr]
    assert report.provenance["draws"] == 0 or "draws" not in report.provenance


def test_what_was_left_out_stands_among_the_limits(machine: MachineSpec) -> None:
    gate = Gate(findings=(), baselines=(), tests=(), fault=None, usable=True)
    report = told_apart(["one", "two"], [], gate, {})
    assert "one; two" in report.sentence
    before = replace(report, where=Where(limits=("known",)))
    assert with_limits(before, ["one"]).where.limits == ("known", "one")
    assert with_limits(before, []) is before
    assert isinstance(before, Report)


def labelled(recording: Recording, hz: float) -> Recording:
    """The recording with this speed on its label."""
    assert recording.operating is not None
    return replace(recording, operating=replace(recording.operating, speed_hz=hz))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("true_hz", "label_hz", "compared_hz"),
    [
        (30.1, 31.5, 30.0),  # turned as the baseline did
        (30.0, 28.6, 30.0),
        (31.5, 31.5, 31.5),  # at a speed of its own
        (30.0, 36.0, 36.0),  # too far off
        (30.1, 30.1, 30.1),  # nothing is wrong
    ],
)
def test_a_label_that_leaves_a_test_no_baseline_gives_way_to_the_lines(
    machine: MachineSpec, true_hz: float, label_hz: float, compared_hz: float
) -> None:
    baselines = tuple(turning(machine, k, true_hz=hz, stated_hz=hz) for k, hz in ((2, 22.5), (3, 30.0)))
    test = labelled(turning(machine, 1, true_hz=true_hz), label_hz)
    gate = Gate(findings=(), baselines=baselines, tests=(test,), fault=None, usable=True)
    found = as_baselines_turned(machine, gate, 0)
    assert found.tests[0].operating is not None and found.tests[0].operating.speed_hz == compared_hz
    told = [f.detail for f in found.findings]
    assert bool(told) == (compared_hz != label_hz) and not any(f.fault for f in found.findings)
    if told:
        assert told[0].startswith(f"{label_hz:g} Hz are stated, its lines show 30")
        assert found.tests[0].operating.torque_nm == test.operating.torque_nm  # type: ignore[union-attr]
    else:
        assert found is gate


@pytest.mark.slow
def test_loads_at_one_speed_have_speeds_of_their_own_and_what_is_too_short_shows_none(machine: MachineSpec) -> None:
    """The light baseline turned at 31.5 Hz whatever it states: a light test at 30 Hz has none, a loaded one has."""

    def under(recording: Recording, torque_nm: float) -> Recording:
        assert recording.operating is not None
        return replace(recording, operating=replace(recording.operating, torque_nm=torque_nm))

    baselines = (under(turning(machine, 2, true_hz=31.5), 10.0), turning(machine, 3))
    light, loaded = (labelled(turning(machine, k), 31.3) for k in (4, 5))
    short = replace(loaded, samples=loaded.samples[:, : round(0.05 * RATE_HZ)])
    tests = (under(light, 10.0), loaded, short)
    gate = Gate(findings=(), baselines=baselines, tests=tests, fault=None, usable=True)
    found = as_baselines_turned(machine, gate, 0)
    assert [t.operating.speed_hz for t in found.tests if t.operating is not None] == [31.3, 30.0, 31.3]
    assert [f.recording for f in found.findings] == ["test 2"]
