"""A speed stated far from where the shaft's lines stand names nothing: the report says where they stand."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.gate import Gate
from reconcile.kinematics import read_kinematic_spec, reconcile_kinematics
from reconcile.kinematics.elsewhere import SHARED, left_out, told_elsewhere
from reconcile.kinematics.unread import Judged
from reconcile.report.action import ALL_WRONG, to_do
from reconcile.speed.elsewhere import Elsewhere
from reconcile.verdict import Cause, Report
from tests.strategies.half import RATE_HZ, SPEED_HZ, N, recorded, shaft_lines, sound, train

BEARINGS = [
    {"name": "drive_end", "shaft": "shaft", "catalogue": "6205"},
    {"name": "fan_end", "shaft": "shaft", "catalogue": "6203"},
]
SPEC = read_kinematic_spec({"kinematics": {"shafts": [{"name": "shaft"}], "bearings": BEARINGS}})
OUTER = 3.5848


def made(hit: bool, factor: float, seed: int = 2):  # type: ignore[no-untyped-def]
    """A machine with clear lines of its shaft; the speed is stated wrong by `factor`."""
    pit = train(np.random.default_rng(seed), 0.992 * OUTER, 1.0) if hit else 0.0
    return recorded(sound(seed) + pit, factor * SPEED_HZ)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("factor", "baseline"), [(25 / 32, False), (25 / 22, True), (0.66, True), (1.4, False), (0.66, False)]
)
def test_a_pit_is_told_at_the_speed_of_the_lines_only(factor: float, baseline: bool) -> None:
    report = reconcile_kinematics(SPEC, [made(True, factor)], [made(False, factor, 1)] if baseline else [], seed=3)
    assert report.verdict == "measurement_fault" and report.fault is not None
    assert report.fault.kind == "speed_mismatch" and not any(c.named for c in report.causes)
    assert f"a shaft at {SPEED_HZ:.4g} Hz (1, 2 and 3 times it)" in report.sentence
    assert f"the description states {factor * SPEED_HZ:.4g} Hz" in report.sentence
    assert f"At {SPEED_HZ:.4g} Hz: A local defect on the outer race of drive_end" in report.sentence
    assert (report.causes[0].term, report.causes[0].site) == ("outer_spall", "drive_end")
    assert f"only if it turns at {SPEED_HZ:.4g} Hz" in report.causes[0].reasons
    assert report.next_experiment is not None and "tacho" in report.next_experiment.sentence
    assert "correct the speed" in to_do(report)


@pytest.mark.slow
def test_a_sound_machine_is_told_too_and_a_right_label_is_left_alone() -> None:
    wrong = reconcile_kinematics(SPEC, [made(False, 25 / 22)], [], seed=3)
    assert wrong.verdict == "measurement_fault" and wrong.causes == ()
    assert f"At {SPEED_HZ:.4g} Hz: No family of lines" in wrong.sentence
    for hit, verdict in ((False, "nothing_missing"), (True, "explained")):
        right = reconcile_kinematics(SPEC, [made(hit, 1.02)], [], seed=3)
        assert right.verdict == verdict and "states" not in right.sentence


@pytest.mark.slow
def test_lines_of_a_neighbour_take_a_name_but_are_no_fault_where_the_label_has_a_line() -> None:
    """A weak line of its own and three of another machine at 1.31 times its speed."""
    rng = np.random.default_rng(6)
    t = np.arange(N) / RATE_HZ
    row = 0.3 * rng.standard_normal(N) + 0.05 * np.sin(2 * np.pi * SPEED_HZ * t) + shaft_lines(rng, 1.31 * SPEED_HZ)
    report = reconcile_kinematics(SPEC, [recorded(row + train(rng, OUTER, 2.0))], [], seed=3)
    assert report.verdict == "ambiguous" and not any(c.named for c in report.causes)
    assert ("outer_spall", "drive_end") in {(c.term, c.site) for c in report.causes}
    assert f"{1.31 * SPEED_HZ:.4g} Hz" in report.sentence and "not decided" in report.sentence
    quiet = reconcile_kinematics(SPEC, [recorded(row)], [], seed=3)
    assert quiet.verdict == "nothing_missing" and "whether shaft turns at 24.3 Hz as stated" in quiet.undecidable[0]


@pytest.mark.slow
def test_recordings_that_turned_elsewhere_are_left_out_beside_others() -> None:
    tests, baselines = [made(True, 1.0), made(True, 25 / 32, 4)], [made(False, 1.0, 1), made(False, 1.3, 5)]
    report = reconcile_kinematics(SPEC, tests, baselines, seed=3)
    assert (report.verdict, report.causes[0].term) == ("explained", "outer_spall")
    told = [text for text in report.where.limits if "was left out" in text]
    assert [text.split()[0:2] for text in told] == [["test", "2"], ["baseline", "2"]]
    assert f"the lines of a shaft at {SPEED_HZ:.4g} Hz" in told[0]


def seen(label: str) -> SimpleNamespace:
    return SimpleNamespace(label=label, speed=SimpleNamespace(shaft="shaft", speed_hz=25.0, stated_hz=25.0))


def judged(z: float, verdict: str = "explained") -> Judged:
    family = SimpleNamespace(kind="outer", site="a")
    one = SimpleNamespace(family=family, z=z, present=True, risen=True, deep=True)
    cause = Cause(term="outer_spall", site="a", score=z, named=True)
    report = Report(verdict=verdict, sentence=f"{z:g}.", level="kinematics", causes=(cause,) if z else ())  # type: ignore[arg-type]
    return Judged(report=report, every=(one,) if z else ())  # type: ignore[arg-type]


def far(own: bool = False) -> Elsewhere:
    return Elsewhere(speed_hz=32.0, harmonics=(1, 2, 3), by_teeth=False, own=own)


@pytest.mark.parametrize(
    ("here", "there", "own", "verdict", "last"),
    [
        (10.0, 12.0, False, "measurement_fault", "12."),
        (12.0, 10.0, False, "measurement_fault", "10."),
        (20.0, 10.0, False, "ambiguous", "20."),  # the bearing speaks for the label
        (10.0, 20.0, True, "ambiguous", "20."),
        (0.0, 0.0, False, "measurement_fault", "0."),
        (0.0, 0.0, True, "nothing_missing", "0."),
        (0.0, 9.0, True, "ambiguous", "9."),
    ],
)
def test_the_verdict_hangs_on_what_speaks_for_the_label(
    here: float, there: float, own: bool, verdict: str, last: str
) -> None:
    pair = [judged(z, "explained" if z else "nothing_missing") for z in (here, there)]
    report = told_elsewhere(pair[0], [seen("test 1")], {"test 1": far(own)}, lambda _: pair[1])  # type: ignore[list-item]
    assert report is not None and report.verdict == verdict and report.sentence.endswith(last)
    assert not any(c.named for c in report.causes) and "25 Hz as stated" in report.undecidable[0]


def test_most_of_the_tests_must_say_so_and_what_cannot_be_judged_there_is_told_all_the_same() -> None:
    tests = [seen("test 1"), seen("test 2")]
    assert told_elsewhere(judged(9.0), tests, {"test 1": far()}, lambda _: judged(9.0)) is None  # type: ignore[arg-type]
    both = {"test 1": far(), "test 2": far()}
    report = told_elsewhere(judged(9.0), tests, both, lambda _: None)  # type: ignore[arg-type]
    assert report is not None and report.verdict == "measurement_fault" and report.causes == ()
    assert "test 1: the lines" in report.sentence and "test 2: the lines" in report.sentence


def test_nothing_is_left_out_where_no_test_would_be_left() -> None:
    gate = Gate(findings=(), baselines=("b",), tests=("t",), fault=None, usable=True)  # type: ignore[arg-type]
    alone = left_out(gate, [seen("test 1")], [seen("baseline 1")], {"test 1": far(), "baseline 1": far()})  # type: ignore[list-item]
    assert (alone[0], len(alone[1]), len(alone[2]), alone[3]) == (gate, 1, 1, ())
    kept = left_out(gate, [seen("test 1")], [seen("baseline 1")], {"baseline 1": far()})  # type: ignore[list-item]
    assert (kept[0].baselines, kept[2]) == ((), []) and kept[3][0].startswith("baseline 1 was left out")
    alike = left_out(gate, [seen("test 1")], [seen("baseline 1")], {"test 1": far(own=True), "baseline 1": far()})  # type: ignore[list-item]
    assert alike[0] == gate and alike[3] == (), "wrong by one factor, if the test is"
    unsure = left_out(gate, [seen("test 1")], [seen("baseline 1")], {"baseline 1": far(own=True)})  # type: ignore[list-item]
    assert unsure[0] == gate and unsure[3] == ()


def test_a_label_that_is_wrong_in_the_baseline_too_is_told_of_both() -> None:
    tests, past = [seen("test 1")], [seen("baseline 1")]
    both = {"test 1": far(), "baseline 1": far()}
    report = told_elsewhere(judged(9.0), tests, both, lambda _: judged(12.0), past)  # type: ignore[arg-type]
    assert report is not None and report.verdict == "measurement_fault" and report.next_experiment == SHARED
    assert "So it is with baseline 1: the lines of a shaft at 32 Hz" in report.sentence
    assert to_do(report).startswith("correct the speed") and to_do(report).endswith(ALL_WRONG)
    alone = told_elsewhere(judged(9.0), tests, {"test 1": far()}, lambda _: judged(12.0), past)  # type: ignore[arg-type]
    assert (
        alone is not None
        and ALL_WRONG not in to_do(alone)
        and alone.next_experiment != SHARED
        and "So it is" not in alone.sentence
    )


@pytest.mark.slow
def test_the_lines_of_a_baseline_lead_to_those_of_a_test_that_a_defect_hides() -> None:
    """Beside the shaft's lines stand as many that belong to nothing: by itself the test tells no speed."""
    stated, t = 1.4 * SPEED_HZ, np.arange(N) / RATE_HZ
    rng = np.random.default_rng(8)
    more = sum(0.2 * np.sin(2 * np.pi * f * t + f) for f in (17.9, 41.3, 57.7, 76.3, 79.1, 88.3, 104.9, 111.7, 131.3))
    hidden = recorded(sound(2) + train(rng, 0.992 * OUTER, 1.0) + more, stated)
    alone = reconcile_kinematics(SPEC, [hidden], [], seed=3)
    assert alone.fault is None
    for baseline in (made(False, 1.4, 1), made(False, 1.0, 1)):
        report = reconcile_kinematics(SPEC, [hidden], [baseline], seed=3)
        assert report.fault is not None and report.fault.kind == "speed_mismatch", report.sentence
        assert f"At {SPEED_HZ:.4g} Hz: A local defect on the outer race of drive_end" in report.sentence
        assert "there is no baseline" not in " ".join(report.undecidable)


def at_the_mains(speed_hz: float, label_hz: float, seed: int, more: float = 0.0, hum_hz: float = 0.0):  # type: ignore[no-untyped-def]
    """A shaft whose second harmonic may be at the supply's frequency; `more`: of its first; with hum."""
    rng, t = np.random.default_rng(seed), np.arange(N) / RATE_HZ
    hum = sum(0.3 / k * np.sin(2 * np.pi * k * hum_hz * t) for k in (1, 2, 3)) if hum_hz else 0.0
    grown = more * np.sin(2 * np.pi * speed_hz * t)
    return recorded(shaft_lines(rng, speed_hz) + 0.3 * rng.standard_normal(N) + grown + hum, label_hz)


@pytest.mark.slow
@pytest.mark.parametrize(("speed_hz", "label_hz"), [(24.97, 40.0), (24.97, 31.0), (29.97, 40.0), (29.97, 22.0)])
def test_a_shaft_whose_second_harmonic_is_at_the_mains_is_told_too(speed_hz: float, label_hz: float) -> None:
    before = at_the_mains(speed_hz, label_hz, 1)
    for more, says in ((0.0, "No family of lines"), (4.0, f"At {speed_hz:.4g} Hz: 1 times the speed of shaft grew by")):
        report = reconcile_kinematics(SPEC, [at_the_mains(speed_hz, label_hz, 2, more)], [before], seed=0)
        assert report.verdict == "measurement_fault" and report.fault is not None, report.sentence
        assert report.fault.kind == "speed_mismatch" and says in report.sentence
        assert f"a shaft at {speed_hz:.4g} Hz (1, 2 and 3 times it)" in report.sentence
        assert ("unbalance" in report.sentence) == (more > 0.0)


@pytest.mark.slow
@pytest.mark.parametrize(("speed_hz", "mains_hz"), [(SPEED_HZ, 50.0), (27.3, 60.0)])
def test_hum_beside_a_right_label_is_no_fault_of_the_speed(speed_hz: float, mains_hz: float) -> None:
    tests = [at_the_mains(speed_hz, speed_hz, 2, hum_hz=mains_hz)]
    for baselines in (
        [at_the_mains(speed_hz, speed_hz, 1)],
        [at_the_mains(speed_hz, speed_hz, 1, hum_hz=mains_hz)],
        [],
    ):
        report = reconcile_kinematics(SPEC, tests, baselines, seed=0)
        assert report.fault is None or report.fault.kind == "mains_hum"
        assert "states" not in report.sentence and "not decided" not in report.sentence
