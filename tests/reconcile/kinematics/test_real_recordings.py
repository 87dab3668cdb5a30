"""Real recordings: the rig the method was tuned on, and the verdicts on others (labels are in this file only)."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import scipy.io

from reconcile.kinematics import read_kinematic_spec, reconcile_kinematics
from reconcile.kinematics.answer import BOUND
from signals.recording import Operating, Recording
from sim.core.response import Channel

DATA = Path(__file__).parents[3].parent / "shared" / "recordings"
pytestmark = [
    pytest.mark.slow,
    pytest.mark.long,
    pytest.mark.skipif(not DATA.exists(), reason="the real recordings are not beside this project"),
]


def bearings(**designations: str):  # type: ignore[no-untyped-def]
    parts = [{"name": name, "shaft": "shaft", "catalogue": c} for name, c in designations.items()]
    return read_kinematic_spec({"kinematics": {"shafts": [{"name": "shaft"}], "bearings": parts}})


NAMED, TURNS, WHOLE = 45.0, 60.0, 1000.0
"""Of a recording: enough to name a defect, to hold a part of it out too, and where lines are faint;
`docs/proof-real.md` has the answers to whole ones."""


def recording(rows, rate_hz: float, speed_hz: float, turns: float = TURNS) -> Recording:  # type: ignore[no-untyped-def]
    samples = np.atleast_2d(np.asarray(rows, dtype=np.float64))[:, : round(turns / speed_hz * rate_hz)]
    return Recording(
        sampling_rate_hz=rate_hz,
        channels=tuple(
            Channel(name=f"c{i}", quantity="acceleration", unit="m/s^2", location="", axis="")
            for i in range(samples.shape[0])
        ),
        samples=samples,
        operating=Operating(shaft="shaft", speed_hz=speed_hz),
    )


def hit(name: str) -> Recording:
    content = scipy.io.loadmat(DATA / "hit_sm_mfs" / f"hit_mfs_{name}.mat")
    key = next(k for k in content if not k.startswith("__"))
    return recording(content[key].ravel(), 51200.0, 10.0 if name.endswith("_600") else 20.0)


def cwru(name: str, turns: float = NAMED) -> Recording:
    content = np.load(DATA / "cwru" / f"cwru_1797rpm_{name}.npz")
    return recording([content["DE"].ravel(), content["FE"].ravel()], 48000.0, 1797 / 60, turns)


def openei(load: int) -> Recording:
    rows = np.loadtxt(DATA / "openei_gear" / f"h30hz{load}.csv.gz", delimiter=",", skiprows=1)
    return recording(rows.T, 12800.0, 30.0, NAMED)


def uestc(letter: str) -> Recording:
    rows = scipy.io.loadmat(DATA / "uestc" / f"{letter}_1000_1.mat")["Data"].ravel()
    return recording(rows, 20000.0, 1000 / 60, WHOLE)


HIT = bearings(bearing1="6205")
CWRU = bearings(drive_end="6205", fan_end="6203")
UESTC = bearings(bearing1="UC204")


@pytest.mark.parametrize(
    ("name", "baseline", "term", "degrees"),
    [
        ("OR2_1200", "Normal_1200", "outer_spall", 2.0),
        ("OR8_1200", "Normal_1200", "outer_spall", 8.0),
        ("IR2_1200", "Normal_1200", "inner_spall", 2.0),
        ("IR8_1200", "Normal_1200", "inner_spall", 8.0),
        ("OR5_600", "Normal_600", "outer_spall", 5.0),
    ],
)
def test_the_tuning_rig_with_size(name: str, baseline: str, term: str, degrees: float) -> None:
    report = reconcile_kinematics(HIT, [hit(name)], [hit(baseline)], seed=0)
    first = report.causes[0]
    assert (report.verdict, first.term, first.named) == ("explained", term, True)
    side = 1.2034 if term == "outer_spall" else 0.7966
    size, below_m = first.severity, first.values.get(BOUND)
    arc_m = np.radians(degrees) * 0.0390398 / 2 * side
    if degrees > 2.0:  # at one speed the far edge is not told from a rebound
        assert size is not None and below_m is None
        assert size.low == 0.0 and 0.6 * size.value <= arc_m <= size.high < 2.1 * arc_m
        assert "unless what strikes second is a rebound" in report.sentence
    else:  # entry and exit run into one another: a bound is no size
        assert size is None and below_m is not None
        assert arc_m < below_m < 2.5e-3
        assert f"less than {np.degrees(below_m / (0.0390398 / 2 * side)):.1f} degrees" in report.sentence
    assert report.held_out is not None
    assert report.held_out.gain > max(report.held_out.black_box or 0, report.held_out.placebo or 0)


@pytest.mark.parametrize(
    ("name", "term"), [("outerrace_007in_6oclock", "outer_spall"), ("innerrace_007in", "inner_spall")]
)
def test_race_defects_of_another_rig(name: str, term: str) -> None:
    report = reconcile_kinematics(CWRU, [cwru(name)], [cwru("normal_first_half")], seed=0)
    assert (report.verdict, report.causes[0].term, report.causes[0].site) == ("explained", term, "drive_end")


def test_ball_defects_end_in_a_set_with_the_ball() -> None:
    rolling, sound = (cwru(name, WHOLE) for name in ("ball_007in", "normal_first_half"))
    pairs = [(CWRU, rolling, sound), (UESTC, uestc("B"), uestc("N"))]
    for spec, test, baseline in pairs:
        report = reconcile_kinematics(spec, [test], [baseline], seed=0)
        assert report.verdict == "ambiguous"
        assert "ball_spall" in {c.term for c in report.causes}


@pytest.mark.parametrize(("letter", "term"), [("O", "outer_spall"), ("I", "inner_spall")])
def test_wrong_speed_labels_and_slip(letter: str, term: str) -> None:
    report = reconcile_kinematics(UESTC, [uestc(letter)], [uestc("N")], seed=0)
    assert (report.verdict, [c.term for c in report.causes]) == ("explained", [term])


def test_sound_machines_have_nothing_missing() -> None:
    for spec, whole in ((HIT, hit("Normal_1200")), (CWRU, cwru("normal_first_half")), (UESTC, uestc("N"))):
        half = whole.duration_s / 2
        report = reconcile_kinematics(spec, [whole.select(start_s=half)], [whole.select(end_s=half)], seed=0)
        assert report.verdict == "nothing_missing", report.sentence
    ims = [
        recording(np.loadtxt(DATA / "ims_healthy" / f"2003.10.22.12.{minute}.13.txt").T, 20480.0, 2000 / 60)
        for minute in ("09", "39")
    ]
    spec = bearings(bearing1="ZA-2115", bearing2="ZA-2115", bearing3="ZA-2115", bearing4="ZA-2115")
    assert reconcile_kinematics(spec, ims[1:], ims[:1], seed=0).verdict == "nothing_missing"


def test_a_sound_gearbox_that_knocks_is_no_alarm_without_a_baseline() -> None:
    gears = [{"name": "pinion", "shaft": "shaft", "teeth": 32}, {"name": "gear", "shaft": "second", "teeth": 80}]
    meshes = [{"name": "mesh1", "gears": ["pinion", "gear"]}]
    shafts = [{"name": "shaft"}, {"name": "second"}]
    spec = read_kinematic_spec({"kinematics": {"shafts": shafts, "gears": gears, "meshes": meshes}})
    report = reconcile_kinematics(spec, [openei(20)], [], seed=0)
    assert report.verdict == "not_decidable" and not report.causes
    assert "without a baseline" in report.sentence
    assert "once a turn of shaft" in report.undecidable[0]


@pytest.mark.parametrize(("rig", "factor"), [("hit", 2.0), ("cwru", 0.5)])
def test_an_inner_race_is_not_named_at_half_or_twice_the_speed(rig: str, factor: float) -> None:
    """At twice the speed the even lines of the true rate score as high as all lines at the right one."""
    known, test, base, true_hz = {
        "hit": (HIT, hit("IR8_1200"), hit("Normal_1200"), 20.0),
        "cwru": (CWRU, cwru("innerrace_007in"), cwru("normal_first_half"), 1797 / 60),
    }[rig]
    stated = Operating(shaft="shaft", speed_hz=factor * true_hz)
    report = reconcile_kinematics(known, [replace(test, operating=stated)], [replace(base, operating=stated)], seed=0)
    assert report.verdict == "ambiguous" and not any(c.named for c in report.causes)
    assert "The speed is not decided" in report.sentence
    assert any(c.term == "inner_spall" for c in report.causes)
