"""A machine that became much louder is not called sound because no part of its drawing has the lines."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.gate.findings import Finding, Gate
from reconcile.kinematics import faint, read_kinematic_spec, reconcile_kinematics
from reconcile.kinematics.finish import finished
from reconcile.kinematics.vague import LOUDER_DB
from reconcile.report.action import EXCHANGED, to_do
from reconcile.verdict import Report
from tests.strategies.brief import recorded, sound, train

DRAWING = {
    "shafts": [{"name": "shaft", "speed_hz": 24.3}],
    "bearings": [
        {"name": "bearing1", "shaft": "shaft", "balls": 8, "ball_diameter_m": 7.938e-3, "pitch_diameter_m": 33.5e-3}
    ],
}


def answered(extra: np.ndarray):  # type: ignore[no-untyped-def]
    spec = read_kinematic_spec({"kinematics": DRAWING})
    return reconcile_kinematics(spec, [recorded(sound(2) + extra)], [recorded(sound(1))], seed=0)


@pytest.mark.slow
@pytest.mark.parametrize(("times", "word"), [(0.0, "nothing_missing"), (20.0, "not_decidable")])
def test_what_grew_far_is_told_and_left_open(times: float, word: str) -> None:
    """Noise of one band, as of a flow or a joint that the drawing has not."""
    rng = np.random.default_rng(5)
    spectrum = np.fft.rfft(rng.standard_normal(sound(1).size))
    hz = np.fft.rfftfreq(sound(1).size, 1 / 20_000.0)
    band = np.fft.irfft(np.where((hz > 2_000) & (hz < 3_000), spectrum, 0.0), sound(1).size)
    report = answered(times * band)
    assert report.verdict == word, report.sentence
    assert ("louder" in report.sentence) is (word == "not_decidable")
    if times:
        grown = 20 * np.log10(np.std(sound(2) + times * band) / np.std(sound(1)))
        assert grown > LOUDER_DB
        assert f"{grown:.0f} dB louder" in report.sentence


@pytest.mark.slow
def test_a_defect_is_still_named() -> None:
    report = answered(train(np.random.default_rng(3), 3.052, 60.0))
    assert report.verdict == "explained" and report.causes[0].site == "bearing1"


@pytest.mark.parametrize("times", [1.0, 40.0])
def test_shallow_lines_of_a_much_louder_machine_are_no_young_defect(
    times: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where impacts overlap the modulation is shallow, however large the defect."""
    monkeypatch.setattr(faint, "lines_of", lambda *_: ())
    best = SimpleNamespace(depth=0.19, slip=0.0)
    family = SimpleNamespace(key="bearing1.outer", kind="outer", site="bearing1")
    risen = SimpleNamespace(family=family, best=best, z=9.0, growth_db=12.0)
    speed = SimpleNamespace(speed_hz=24.3)
    test, base = (SimpleNamespace(recording=recorded(x), speed=speed) for x in (times * sound(2), sound(1)))
    report = faint.shallow_report([risen], [], [test], [base])  # type: ignore[list-item]
    assert report.verdict == "ambiguous" and "(depth 0.19): " in report.sentence
    assert ("a0 is 32 dB louder, too much for a young defect" in report.sentence) is (times > 1.0)
    assert ("a young race defect or a damaged ball" in report.sentence) is (times == 1.0)
    assert report.next_experiment is not None
    assert ("Inspect the bearing" in report.next_experiment.sentence) is (times > 1.0)


@pytest.mark.slow
@pytest.mark.parametrize("exchanged", [True, False])
def test_a_doubtful_sensor_does_not_hide_that_the_baseline_shows_more(exchanged: bool) -> None:
    """One of three sensors at half its gain is the answer where nothing else is; a damaged baseline is said first."""
    hits = train(np.random.default_rng(3), 3.052, 2.0 if exchanged else 0.0)
    base, test = (
        recorded([sound(10 * k + number) + extra for k in range(3)])
        for number, extra in ((1, hits), (2, np.zeros(hits.size)))
    )
    quiet = replace(test, samples=test.samples * np.array([[0.5], [1.0], [1.0]]))
    report = reconcile_kinematics(read_kinematic_spec({"kinematics": DRAWING}), [quiet], [base], seed=0)
    assert ("exchanged, or a part replaced" in report.sentence) is exchanged, report.sentence
    assert (report.verdict == "measurement_fault") is not exchanged


@pytest.mark.parametrize("exchanged", [True, False])
def test_a_sound_machine_beside_a_damaged_baseline_accuses_no_sensor(exchanged: bool) -> None:
    """The damaged bearing is loud at the near sensor alone, which looks as if that one had come loose since."""
    loose = Finding(kind="loose_sensor", channel="a0", recording="all tests", detail="-15 dB", severity=0.8, fault=True)
    gate = Gate(findings=(loose,), baselines=(), tests=(), fault=None, usable=True)
    said = f"But the baseline has deep lines; {EXCHANGED}." if exchanged else "But nothing is said of it."
    report = finished(Report(verdict="not_decidable", sentence=said, level="kinematics"), gate, (), ())
    told = f"{report.measurement_faults} {report.where.limits} {report.undecidable}"
    assert ("loose" in told) is not exchanged and report.stages[0]["findings"]


@pytest.mark.slow
@pytest.mark.parametrize(("share", "told"), [(1 / 40, True), (1.0, False)])
def test_a_scale_is_told_beside_exchanged_recordings(share: float, told: bool) -> None:
    """Samples of a wav file are shares of its full scale."""
    spec = read_kinematic_spec({"kinematics": DRAWING})
    report = reconcile_kinematics(spec, [recorded(share * sound(2))], [recorded(sound(1))], seed=0)
    assert ("a unit, sensitivity or scale" in report.sentence) is told, report.sentence
    assert ("scale (a wav file" in to_do(report)) is told
