"""A tooth whose burst no sideband shows is told with its gear; wander, balls and uneven teeth are none."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reconcile.kinematics import read_kinematic_spec, reconcile_kinematics
from reconcile.kinematics.families import ties
from reconcile.kinematics.gears import GearEvidence, gear_evidence
from reconcile.kinematics.observe import observe
from reconcile.kinematics.tooth_turn import RISEN, ToothTurn, teeth_report, tooth_report, tooth_turns, with_sidebands
from reconcile.observe.tooth_place import ToothPlace
from reconcile.observe.whole_turn import WholeTurn
from reconcile.verdict import Cause, Report
from signals.recording import Tacho
from tests.reconcile.kinematics.test_wander import turned
from tests.strategies.brief import RATE_HZ, recorded

TEETH, WHEEL, SPEED_HZ, SECONDS = 23, 81, 30.0, 2.0
SPEC = read_kinematic_spec(
    {
        "kinematics": {
            "shafts": [{"name": "shaft"}, {"name": "out"}],
            "gears": [
                {"name": "pinion", "shaft": "shaft", "teeth": TEETH},
                {"name": "gear", "shaft": "out", "teeth": WHEEL},
            ],
            "meshes": [{"name": "mesh1", "gears": ["pinion", "gear"]}],
            "bearings": [{"name": "b", "shaft": "shaft", "catalogue": "6205"}],
        }
    }
)
TIE = ties(SPEC, "shaft")


def seen(seed: int, label: str, size: float = 0.0, ratio: float = 1.0):  # type: ignore[no-untyped-def]
    """Three mesh lines, noise, and a ring of 3 kHz once in each turn of a shaft of `ratio`, at a third of it."""
    angle = turned(seed, SPEED_HZ, 0.002, SECONDS)
    mesh = sum(a * np.cos(k * TEETH * angle + k) for k, a in ((1, 1.0), (2, 0.5), (3, 0.3)))
    turn = angle * ratio / (2 * np.pi)
    after = (turn - 1.0 / 3.0) % 1.0 / (SPEED_HZ * ratio)
    ring = size * np.exp(-after * 1000.0) * np.sin(2 * np.pi * 3000.0 * after)
    noise = np.random.default_rng(seed).standard_normal((2, angle.size))
    return observe(recorded(list(mesh + ring + 0.3 * noise), SPEED_HZ), TIE, label, stated_hz=None, seed=0)


@pytest.mark.slow
@pytest.mark.parametrize(("gear", "ratio", "size"), [("pinion", 1.0, 0.5), ("gear", TEETH / WHEEL, 1.0)])
def test_a_burst_below_the_floor_of_its_sidebands_is_told(gear: str, ratio: float, size: float) -> None:
    now, before = seen(1, "test", size, ratio), seen(2, "baseline")
    assert not any(g.grown for g in gear_evidence([now], [before], TIE))
    first, other = tooth_turns([now], [before], TIE)
    assert first.place.told and first.gear == gear
    assert not other.place.told
    report = reconcile_kinematics(SPEC, [now.recording], [before.recording], seed=0)
    assert report.verdict == "ambiguous" and f"local tooth fault on {gear}" in report.sentence
    assert {c.term for c in report.causes} == {"tooth_crack", "tooth_spall", "missing_tooth"}
    shown = report.pictures["mean_turn"]
    assert isinstance(shown, dict) and shown["gear"] == gear and report.where.angle_window is not None
    highest = shown["angle_deg"][int(np.argmax(shown["test_db"]))]
    assert report.where.angle_window.low_deg <= highest <= report.where.angle_window.high_deg
    assert max(shown["test_db"]) > max(shown["baseline_db"]) + 3.0
    window = report.where.angle_window
    assert window is not None and window.centre_deg == pytest.approx(120.0 + 6.0, abs=10.0)


def told(now, before) -> bool:  # type: ignore[no-untyped-def]
    return any(t.place.told for t in tooth_turns([now], [before], TIE))


@pytest.mark.slow
def test_nothing_and_balls_are_no_tooth() -> None:
    before = seen(2, "baseline")
    assert not any(told(seen(k, "test"), before) for k in range(3, 9))
    assert not told(seen(9, "test", 1.0, 3.572), before)


@pytest.mark.slow
def test_without_a_baseline_nothing_is_told() -> None:
    assert tooth_turns([seen(1, "test", 0.5)], [], TIE) == ()


@pytest.mark.slow
def test_a_burst_that_the_baseline_has_too_is_none() -> None:
    assert not told(seen(1, "test", 0.5), seen(2, "baseline", 0.5))


def rattling(seed: int, label: str, size: float):  # type: ignore[no-untyped-def]
    """As `seen`, with nine rings within a third of each turn."""
    angle = turned(seed, SPEED_HZ, 0.002, SECONDS)
    mesh = sum(a * np.cos(k * TEETH * angle + k) for k, a in ((1, 1.0), (2, 0.5), (3, 0.3)))
    rng, rattle = np.random.default_rng(seed), np.zeros(angle.size)
    for k, strength in enumerate(np.random.default_rng(7).uniform(0.5, 1.0, 9)):
        after = (angle / (2 * np.pi) - 0.3 - 0.037 * k) % 1.0 / SPEED_HZ
        rattle += size * strength * np.exp(-after * 1000.0) * np.sin(2 * np.pi * 3000.0 * after)
    return observe(
        recorded(list(mesh + rattle + 0.3 * rng.standard_normal((2, angle.size))), SPEED_HZ),
        TIE, label, stated_hz=None, seed=0,
    )  # fmt: skip


@pytest.mark.slow
def test_what_rattles_for_a_third_of_the_turn_is_no_single_tooth() -> None:
    now, before = rattling(1, "test", 2.0), rattling(2, "baseline", 0.0)
    pinion = next(t for t in tooth_turns([now], [before], TIE) if t.gear == "pinion")
    assert not pinion.place.told and pinion.grown > RISEN
    report = reconcile_kinematics(SPEC, [now.recording], [before.recording], seed=0)
    assert "local tooth fault" not in report.sentence
    assert report.verdict == "ambiguous" and report.where.sites[0].site == "shaft"


def sideband_growth(gear: str) -> GearEvidence:
    return GearEvidence(
        mesh="mesh1", shaft="out", gear=gear, channel="a", growth_db=16.0, error_db=1.0, mesh_growth_db=0.0, lines=20,
        window=None, label="test 1", contrast_db=9.0, multiples=5,
    )  # fmt: skip


def turn_of(gear: str, grown: float, standing: float = 0.2) -> ToothTurn:
    place = ToothPlace(shaft="out", standing=standing, strongest=None, start_turns=0.0)
    return ToothTurn(gear=gear, shaft="out", place=place, grown=grown, tests=1)


QUIET = Report(verdict="nothing_missing", sentence="No family of lines is firmer.", level="kinematics")


def test_sidebands_without_a_burst_are_not_decided() -> None:
    report = with_sidebands(QUIET, [turn_of("gear", 1.1)], [sideband_growth("gear")])
    assert report.verdict == "not_decidable" and report.causes == ()
    assert "20 sidebands of out around mesh1 grew by 16 dB" in report.sentence
    named = replace(QUIET, verdict="ambiguous")
    beside = with_sidebands(named, [turn_of("gear", 1.1)], [sideband_growth("gear")])
    assert beside.sentence == named.sentence and "sidebands" in beside.undecidable[-1]
    assert with_sidebands(QUIET, [turn_of("gear", 1.1)], []) == QUIET


def test_an_uneven_turn_is_told_where_sidebands_grew_and_nothing_else_is() -> None:
    grown = [sideband_growth("gear")]
    report = with_sidebands(QUIET, [turn_of("gear", RISEN)], grown)
    assert report.verdict == "ambiguous" and {c.site for c in report.causes} == {"out", "gear"}
    named = with_sidebands(replace(QUIET, verdict="explained"), [turn_of("gear", RISEN)], grown)
    assert named.verdict == "explained" and named.sentence == QUIET.sentence
    assert with_sidebands(QUIET, [turn_of("gear", RISEN - 0.1)], grown).verdict == "not_decidable"
    assert with_sidebands(QUIET, [turn_of("gear", RISEN)], []) == QUIET, "another load or less noise may do that"


def test_sidebands_tell_where_the_turn_cannot() -> None:
    tests = [seen(1, "test 1")]
    report = teeth_report((), [sideband_growth("gear")], tests)
    assert report is not None and "20 sidebands" in report.sentence
    assert teeth_report([turn_of("gear", 1.0)], [sideband_growth("gear")], tests) is None
    assert teeth_report((), [], tests) is None


def test_teeth_come_last_where_no_place_of_their_turn_stands_out() -> None:
    listed = (("tooth_crack", "gear"), ("tooth_crack", "pinion"), ("rub", "out"))
    causes = tuple(Cause(term=term, site=site, score=1.0) for term, site in listed)
    struck = replace(QUIET, verdict="ambiguous", causes=causes)
    told = with_sidebands(struck, [turn_of("gear", 1.0)], []).causes
    assert [c.site for c in told] == ["pinion", "out", "gear"]


def test_gears_that_turn_alike_share_the_fault() -> None:
    place = ToothPlace(
        shaft="out", standing=3.0, start_turns=0.0, strongest=WholeTurn(windows=np.ones(100), teeth=23, turns=9)
    )
    one = ToothTurn(gear="gear", shaft="out", place=place, grown=1.0, tests=1, alike=("wheel",))
    report = tooth_report(one)
    assert {s.site: s.weight for s in report.where.sites} == {"gear": 0.5, "wheel": 0.5}
    assert {c.site for c in report.causes} == {"gear", "wheel"} and "gear or wheel" in report.sentence
    assert "which turn alike" in report.undecidable[0]


@pytest.mark.slow
def test_with_pulses_the_angle_counts_from_the_first_of_them() -> None:
    """The same record, cut by a third of a turn: its place against the pulse stays."""
    found = []
    for skipped in (0, int(RATE_HZ / SPEED_HZ / 3)):
        several = []
        for seed, size in ((1, 1.0), (2, 0.0)):
            one = seen(seed, "r", size).recording
            angle = turned(seed, SPEED_HZ, 0.002, SECONDS)[skipped:] / (2 * np.pi)
            pulses = np.interp(np.arange(np.ceil(angle[0]), np.floor(angle[-1])), angle, np.arange(angle.size))
            tacho = Tacho(shaft="shaft", pulse_times_s=pulses / RATE_HZ)
            cut = replace(one, samples=one.samples[:, skipped:], tacho=tacho)
            several.append(observe(cut, TIE, f"test {seed}", stated_hz=None, seed=0))
        first = tooth_turns(several[:1], several[1:], TIE)[0]
        assert first.shown == "the first pulse of the tacho of test 1"
        window = tooth_report(first).where.angle_window
        assert window is not None
        found.append(window.centre_deg)
    assert found[0] == pytest.approx(120.0 + 6.0, abs=10.0)
    assert found[1] == pytest.approx(found[0], abs=3.0)


@pytest.mark.parametrize(("shaft", "pulses", "same"), [("shaft", 1, ["pinion"]), ("shaft", 2, []), ("", 1, [])])
def test_angles_are_those_of_the_baseline_only_where_every_pulse_finds_the_gear_alike(
    shaft: str, pulses: int, same: list[str]
) -> None:
    """Between two pulses of the pinion the wheel turns by 23 teeth of 81: a record begins at any of 81 angles."""
    both = []
    for seed, label in ((1, "test"), (2, "baseline")):
        one = seen(seed, label).recording
        angle = turned(seed, SPEED_HZ, 0.002, SECONDS) / (2 * np.pi)
        at = np.arange(0.0, np.floor(angle[-1] * pulses)) / pulses
        tacho = Tacho(
            shaft=shaft, pulse_times_s=np.interp(at, angle, np.arange(angle.size)) / RATE_HZ,
            pulses_per_revolution=pulses,
        )  # fmt: skip
        one = replace(one, tacho=tacho if shaft else None)
        both.append(observe(one, TIE, label, stated_hz=None if shaft else SPEED_HZ, seed=0))
    turns = tooth_turns(both[:1], both[1:], TIE)
    pictures = {one.gear: one.picture["mean_turn"] for one in turns}
    assert set(pictures) == {"pinion", "gear"}
    assert [name for name, picture in pictures.items() if picture["same_start"]] == same
