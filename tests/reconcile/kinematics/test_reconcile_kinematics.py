"""Made defects are named with place and size, sound machines are left alone, vague cases stay vague."""

from __future__ import annotations

import json
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.kinematics import read_kinematic_spec, reconcile_kinematics
from reconcile.kinematics.answer import BOUND
from reconcile.kinematics.families import Family
from reconcile.kinematics.judge import nearest_drawing, own_lines
from reconcile.verdict import NOT_JUDGED
from signals.recording import Recording
from sim.core.errors import SpecError
from tests.strategies.brief import RATE_HZ, SPEED_HZ, N, recorded, shaft_lines, sound, train

SHAFT = {"name": "shaft"}
BEARING = {"name": "bearing1", "shaft": "shaft", "catalogue": "6205"}
SPEC = read_kinematic_spec({"kinematics": {"shafts": [SHAFT], "bearings": [BEARING]}})
ORDERS = {"outer_spall": 3.5848, "inner_spall": 5.4152, "ball_spall": 4.7135}


def defect(term: str, seed: int, *, slip: float = -0.008, **how: float):  # type: ignore[no-untyped-def]
    rng = np.random.default_rng(seed)
    usual = {"outer_spall": {}, "inner_spall": {"load": 0.8}, "ball_spall": {"cage": 0.8}}[term]
    return sound(seed) + train(rng, ORDERS[term] * (1 + slip), 1.0, **{**usual, **how})


BASELINE = recorded(sound(1))


def played(record: Recording, times: float = 1.3) -> Recording:
    """A record played so many times as fast."""
    operating = replace(record.operating, speed_hz=times * SPEED_HZ)
    return replace(record, sampling_rate_hz=times * record.sampling_rate_hz, operating=operating)


@pytest.mark.slow
@pytest.mark.parametrize("term", sorted(ORDERS))
@pytest.mark.parametrize("with_baseline", [True, False])
def test_a_defect_is_named_at_its_place(term: str, with_baseline: bool) -> None:
    report = reconcile_kinematics(SPEC, [recorded(defect(term, 2))], [BASELINE] if with_baseline else [], seed=3)
    assert report.verdict == "explained"
    assert [(c.term, c.site, c.named) for c in report.causes] == [(term, "bearing1", True)]
    assert report.causes[0].values["slip"] == pytest.approx(-0.008, abs=0.002)
    line = report.where.lines[0]
    assert line.frequency_hz == pytest.approx(ORDERS[term] * 0.992 * SPEED_HZ, rel=0.003)
    assert report.held_out is not None
    held = report.held_out
    assert held.gain_low > 0
    assert held.gain > max(held.retuned or 0, held.black_box or 0, held.placebo or 0)
    json.dumps(report.document())


@pytest.mark.slow
@pytest.mark.parametrize(("other", "verdict"), [(3.505, "explained"), (3.53, "ambiguous")])
def test_of_two_races_within_slip_the_nearer_drawing_comes_first(other: float, verdict: str) -> None:
    orders = {"ftf": other / 9, "bpfo": other, "bpfi": 9 - other, "bsf": 2.35}
    bearings = [{"name": "fan", "shaft": "shaft", "orders": orders}, {**BEARING, "name": "drive"}]
    spec = read_kinematic_spec({"kinematics": {"shafts": [SHAFT], "bearings": bearings}})
    report = reconcile_kinematics(spec, [recorded(defect("outer_spall", 3, slip=0.0))], [BASELINE], seed=3)
    assert report.verdict == verdict
    assert [(c.term, c.site) for c in report.causes][:2] == [("outer_spall", "drive"), ("outer_spall", "fan")]
    assert abs(float(report.causes[0].values["slip"])) < 0.003, "from its own drawing"
    assert not any("rose too" in text for text in report.undecidable), "one line is no second defect"


def reading(site: str, order: float, z: float, slip: float, spacing: float = 1.0) -> SimpleNamespace:
    """One line read as this bearing's."""
    family = Family(kind="outer", site=site, order=order, spacing=spacing, sidebands=0, slip=0.025)
    best = SimpleNamespace(order=order * (1 + slip), slip=slip)
    return SimpleNamespace(family=family, best=best, z=z, present=True, risen=True, deep=True)


def test_chance_does_not_choose_between_readings_of_one_line() -> None:
    fan, drive = reading("fan", 3.505, 19.0, 0.0228), reading("drive", 3.585, 18.7, 0.0)
    assert nearest_drawing(fan, [fan, drive]) is drive  # type: ignore[arg-type]
    elsewhere, faint = reading("drive", 3.585, 18.7, -0.015), reading("drive", 3.585, 9.0, 0.0)
    geared = reading("drive", 3.585, 18.7, 0.0, spacing=0.5)
    for other in (elsewhere, faint, geared):
        assert nearest_drawing(fan, [fan, other]) is fan  # type: ignore[arg-type]


def candidate(kind: str, z: float) -> SimpleNamespace:
    """A firm family."""
    family = Family(kind=kind, site="b", order={"outer": 2.98, "inner": 4.97}[kind], spacing=0.0, sidebands=0, slip=0.0)  # type: ignore[arg-type]
    best = SimpleNamespace(order=family.order, slip=0.0)
    return SimpleNamespace(family=family, best=best, z=z, present=True, risen=True, deep=True)


@pytest.mark.parametrize(("left_of_inner", "left_of_outer", "chosen"), [(13.0, 1.0, "inner"), (13.0, 9.0, "outer")])
def test_of_two_firm_families_the_one_that_explains_the_other_comes_first(
    left_of_inner: float, left_of_outer: float, chosen: str
) -> None:
    """Near five times the turn the sidebands of an inner race are a comb near three times."""
    outer, inner = candidate("outer", 13.4), candidate("inner", 13.0)

    def beside(taken: tuple[SimpleNamespace, ...]) -> tuple[SimpleNamespace, ...]:
        gone = taken[0].family.kind
        return (candidate("inner", left_of_inner),) if gone == "outer" else (candidate("outer", left_of_outer),)

    first, left = own_lines(outer, [outer, inner], beside)  # type: ignore[arg-type]
    assert first.family.kind == chosen
    assert [c.family.kind for c in left] == ["outer" if chosen == "inner" else "inner"]


@pytest.mark.slow
def test_balls_of_two_like_bearings_are_not_told_apart() -> None:
    """Their cages differ by a hundredth, which no sideband shows."""
    bearings = [{"name": n, "shaft": "shaft", "catalogue": c} for n, c in (("fan", "6207"), ("drive", "6206"))]
    spec = read_kinematic_spec({"kinematics": {"shafts": [SHAFT], "bearings": bearings}})
    struck = sound(2) + train(np.random.default_rng(2), 4.6153, 1.0, cage=0.8)
    report = reconcile_kinematics(spec, [recorded(struck)], [BASELINE], seed=3)
    assert {c.term for c in report.causes} == {"ball_spall"}
    assert {c.site for c in report.causes} == {"fan", "drive"} and not any(c.named for c in report.causes)


@pytest.mark.slow
def test_a_sound_machine_has_nothing_missing() -> None:
    for seed in (5, 6):
        assert reconcile_kinematics(SPEC, [recorded(sound(seed))], [BASELINE], seed=1).verdict == "nothing_missing"
    assert reconcile_kinematics(SPEC, [recorded(sound(7))], [], seed=1).verdict == "nothing_missing"


@pytest.mark.slow
def test_false_alarms_on_noise_stay_rare() -> None:
    wrong = 0
    for seed in range(12):
        noise = np.random.default_rng(100 + seed).standard_normal(N // 2)
        other = np.random.default_rng(200 + seed).standard_normal(N // 2)
        wrong += (
            reconcile_kinematics(SPEC, [recorded(noise)], [recorded(other)], seed=seed).verdict != "nothing_missing"
        )
    assert wrong == 0


@pytest.mark.slow
def test_louder_and_dirtier_is_no_defect() -> None:
    rng = np.random.default_rng(4)
    test = 2.5 * (1.8 * shaft_lines(rng) + 0.3 * rng.standard_normal(N))
    assert reconcile_kinematics(SPEC, [recorded(test)], [BASELINE], seed=0).verdict == "nothing_missing"


@pytest.mark.slow
@pytest.mark.parametrize("degrees", [5.0, 9.0])
def test_entry_and_exit_give_the_extent(degrees: float) -> None:
    """At two speeds: the same turned angle, so the same record played faster."""
    cage_hz = 0.3983 * SPEED_HZ
    pair = 0.75 * degrees / 360 / cage_hz
    one = recorded(defect("outer_spall", 3, pair_s=pair))
    report = reconcile_kinematics(SPEC, [one, played(one)], [BASELINE, played(BASELINE)], seed=0)
    size = report.causes[0].severity
    assert size is not None and size.name == "width" and size.unit == "m"
    race_m = 0.0390398 / 2 * (1 + 7.94004 / 39.0398)
    assert size.value == pytest.approx(np.radians(degrees) * race_m, rel=0.1)
    assert size.low <= np.radians(degrees) * race_m <= size.high


@pytest.mark.slow
def test_at_one_speed_a_second_strike_may_be_what_fell_back_on_its_balls() -> None:
    pair = 0.75 * 9.0 / 360 / (0.3983 * SPEED_HZ)
    report = reconcile_kinematics(SPEC, [recorded(defect("outer_spall", 3, pair_s=pair))], [BASELINE], seed=0)
    first = report.causes[0]
    assert first.named and first.severity is not None and first.severity.low == 0.0
    assert 9.0 < np.degrees(first.severity.high / 0.0234899) < 15.0
    assert any("far edge or a rebound" in text for text in report.undecidable)
    assert "unless what strikes second is a rebound" in report.sentence


@pytest.mark.slow
def test_a_bound_is_no_size() -> None:
    report = reconcile_kinematics(SPEC, [recorded(defect("outer_spall", 2))], [BASELINE], seed=3)
    first = report.causes[0]
    assert first.named and first.severity is None
    bound_mm = 1e3 * first.values[BOUND]
    assert f"({bound_mm:.2g} mm) of the race" in report.sentence
    assert any(
        t.startswith("how large the defect is: less than") and f"{bound_mm:.2g} mm" in t for t in report.undecidable
    )
    json.dumps(report.document())


@pytest.mark.slow
def test_knocks_once_a_turn_are_an_alarm_only_against_a_baseline() -> None:
    knocking = recorded(sound(2) + train(np.random.default_rng(2), 1.0, 8.0, jitter=0.0))
    against = reconcile_kinematics(SPEC, [knocking], [BASELINE], seed=3)
    assert against.verdict == "ambiguous" and against.causes[0].term == "rub"
    alone = reconcile_kinematics(SPEC, [knocking], [], seed=3)
    assert alone.verdict == "not_decidable" and not alone.causes
    assert "once a turn of shaft" in alone.undecidable[0] and "without a baseline" in alone.sentence
    assert alone.next_experiment is not None and "baseline" in alone.next_experiment.sentence


@pytest.mark.slow
def test_a_channel_that_is_cut_off_gives_no_extent() -> None:
    pair = 0.75 * 9.0 / 360 / (0.3983 * SPEED_HZ)
    whole = defect("outer_spall", 3, pair_s=pair)
    limit = np.quantile(np.abs(whole), 0.9)
    report = reconcile_kinematics(SPEC, [recorded(np.clip(whole, -limit, limit))], [BASELINE], seed=0)
    assert report.causes[0].term == "outer_spall" and report.causes[0].named
    assert report.causes[0].severity is None
    assert any("how large" in text for text in report.undecidable)


@pytest.mark.slow
def test_a_defect_of_the_baseline_that_grew() -> None:
    small, large = (0.75 * d / 360 / (0.3983 * SPEED_HZ) for d in (4.0, 8.0))
    before = recorded(defect("outer_spall", 3, pair_s=small))
    same = reconcile_kinematics(SPEC, [recorded(defect("outer_spall", 4, pair_s=small))], [before], seed=0)
    assert same.verdict == "nothing_missing" and "deep in both" in same.sentence
    grown = reconcile_kinematics(SPEC, [recorded(defect("outer_spall", 4, pair_s=large))], [before], seed=0)
    assert grown.verdict == "explained" and "grew from" in grown.sentence


@pytest.mark.slow
def test_a_sensor_that_hears_the_sound_bearing_pass_does_not_hide_what_another_hears() -> None:
    passing = [defect("outer_spall", seed) for seed in (3, 4)]
    before = recorded([sound(5), passing[0]])
    there = defect("outer_spall", 6)
    same = reconcile_kinematics(SPEC, [recorded([sound(7), passing[1]])], [before], seed=0)
    assert same.verdict == "nothing_missing"
    grown = reconcile_kinematics(SPEC, [recorded([there, passing[1]])], [before], seed=0)
    assert grown.verdict == "explained"
    assert [(c.term, c.named) for c in grown.causes] == [("outer_spall", True)]


@pytest.mark.slow
def test_bearings_alike_make_a_set_unless_a_sensor_tells() -> None:
    two = [BEARING, {**BEARING, "name": "bearing2"}]
    spec = read_kinematic_spec({"kinematics": {"shafts": [SHAFT], "bearings": two}})
    hit = defect("outer_spall", 2)
    report = reconcile_kinematics(spec, [recorded(hit)], [BASELINE], seed=0)
    assert report.verdict == "ambiguous"
    assert {c.site for c in report.causes} == {"bearing1", "bearing2"} and not any(c.named for c in report.causes)
    far = sound(9) + 0.08 * (hit - sound(2))
    both = reconcile_kinematics(spec, [recorded([far, hit])], [recorded([sound(10), sound(11)])], seed=0)
    assert both.where.sites[0].site == "bearing2"


@pytest.mark.slow
def test_impacts_at_an_order_of_no_part() -> None:
    test = sound(2) + train(np.random.default_rng(2), 3.15, 1.0, jitter=0.001)
    report = reconcile_kinematics(SPEC, [recorded(test)], [BASELINE], seed=0)
    assert report.verdict == "unknown_physics"
    assert report.where.lines[0].frequency_hz == pytest.approx(3.15 * SPEED_HZ, rel=0.003)


@pytest.mark.slow
def test_impacts_without_an_order_are_ambiguous() -> None:
    rng = np.random.default_rng(6)
    force = train(rng, 1.7, 3.0, jitter=0.6)
    report = reconcile_kinematics(SPEC, [recorded(sound(2) + force)], [BASELINE], seed=0)
    assert report.verdict == "ambiguous"
    assert "ball_spall" in {c.term for c in report.causes}


@pytest.mark.slow
def test_unbalance_is_one_of_a_set() -> None:
    t = np.arange(N) / RATE_HZ
    test = sound(2) + 4 * np.sin(2 * np.pi * SPEED_HZ * t)
    report = reconcile_kinematics(SPEC, [recorded(test)], [BASELINE], seed=0)
    assert report.verdict == "ambiguous" and report.causes[0].term == "unbalance"
    assert {c.score_unit for c in report.causes} == {"dB"}


def test_where_no_channel_is_usable_the_machine_is_not_judged() -> None:
    rows = sound(8)
    for first in (N // 4, N // 2):
        rows[first : first + N // 10] = np.nan
    report = reconcile_kinematics(SPEC, [recorded(rows)], [BASELINE], seed=0)
    assert report.verdict == "measurement_fault" and report.undecidable == NOT_JUDGED


@pytest.mark.slow
def test_a_sensor_fault_is_the_answer_when_nothing_else_is() -> None:
    rows = sound(8)
    rows[2000:2400] = 0.0
    report = reconcile_kinematics(SPEC, [recorded(rows)], [BASELINE], seed=0)
    assert report.verdict == "measurement_fault"
    assert report.fault is not None and report.fault.kind == "dropouts"


@pytest.mark.slow
def test_a_defect_behind_a_bad_sensor_is_still_found() -> None:
    rows = defect("outer_spall", 2)
    rows[2000:2400] = 0.0
    report = reconcile_kinematics(SPEC, [recorded(rows)], [BASELINE], seed=0)
    assert report.verdict == "explained" and report.causes[0].term == "outer_spall"


@pytest.mark.slow
def test_what_cannot_carry_the_kinematics_is_said() -> None:
    short = recorded(sound(1)).select(end_s=0.3)
    report = reconcile_kinematics(SPEC, [short], [], seed=0)
    assert report.verdict == "not_decidable" and "turns" in report.sentence
    slow = recorded(sound(1), speed_hz=600.0)
    assert reconcile_kinematics(SPEC, [slow], [], seed=0).verdict == "not_decidable"


def test_a_foreign_shaft_is_refused() -> None:
    spec = read_kinematic_spec(
        {"kinematics": {"shafts": [{"name": "a", "speed_hz": 10.0}, {"name": "b", "speed_hz": 5.0}]}}
    )
    with pytest.raises(SpecError, match="is no shaft"):
        reconcile_kinematics(spec, [recorded(sound(1))], [], seed=0)


@pytest.mark.slow
def test_the_same_seed_gives_the_same_report() -> None:
    test = replace(recorded(defect("inner_spall", 2)))
    one, two = (reconcile_kinematics(SPEC, [test], [BASELINE], seed=5) for _ in range(2))
    assert {**one.provenance, "cost": {}} == {**two.provenance, "cost": {}}
    assert replace(one, provenance={}).document() == replace(two, provenance={}).document()
