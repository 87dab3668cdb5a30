"""Every verdict from screens that are made for it."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from reconcile.atlas.places import sensor_sites
from reconcile.judge.adequacy import Rest
from reconcile.machine.decide import (
    CLEAR_P,
    GLARING,
    LEFT_OVER,
    LITTLE_LEFT,
    STRANGE,
    Decision,
    chance,
    decide,
    remarkable,
    tempered,
    unmeasured,
)
from reconcile.machine.direct import HEARD
from reconcile.machine.left_lines import LEAST_LEFT_ELSEWHERE, LEAST_LEFT_UNKNOWN
from reconcile.machine.weigh import MOST_NAMED, credible_set, exclusive, merged_weights, plausible, variants
from reconcile.machine.words import next_experiment, sentence, title
from reconcile.verdict import HeldOut, Severity
from sim import presets
from tests.reconcile.machine.screens import NAMES, screen, struck


def test_a_known_place_goes_before_an_unknown_effect() -> None:
    names = ("radial_clearance@bearing1", "fit_clearance_series@bearing1", "rub@gear", "unbalance@gear")
    left = Rest(unmet=2.1, kept=0.3)
    here = decide(screen([20.0, 14.0, 8.0, 1.0], names, rest=left), views=9)
    assert here.word == "ambiguous" and here.chosen == names[:2] and "bearing1" in here.reasons[0]
    near = decide(screen([20.0, 14.0, 13.0, 1.0], names, rest=left, p_lines=CLEAR_P), views=9)
    assert near.word == "unknown_physics", "an effect elsewhere says nearly as much"
    weak = decide(screen([2.9, 2.8, -9.0, -9.0], names, rest=left, p_lines=CLEAR_P), views=9)
    assert weak.word == "unknown_physics", "nothing says anything"


def test_impacts_choose_among_pits_of_one_bearing_that_leave_lines() -> None:
    """m024 of the proof: the outer race at 5.3 deviations, the inner one and the balls silent."""
    names = ("outer_spall@b", "inner_spall@b", "ball_spall@b", "ball_spall@c")
    left = Rest(unmet=0.0, kept=0.06, pooled=0.5, elsewhere=1.83, rough=False)

    def told(
        evidence: list[float], heard: float = 6.9, silent: tuple[str, ...] = names[1:3], views: int = 9
    ) -> Decision:
        made = screen(evidence, names, rest=left, silent=frozenset(silent))
        return decide(replace(made, direct=np.array([heard, 0.0, 0.0, 0.0])), views=views)

    found = told([17.5, 15.8, 12.8, 3.2])
    assert (found.word, found.chosen, found.reasons) == ("explained", names[:1], (LEFT_OVER,))
    assert told([17.5, 15.8, 12.8, 3.2], heard=HEARD - 0.1).word == "ambiguous", "hardly heard"
    assert told([17.5, 15.8, 12.8, 3.2], silent=names[1:2]).word == "ambiguous", "silence of one says nothing"
    assert told([15.8, 17.5, 12.8, 3.2]).chosen[0] == names[1], "the silent one leads"
    assert told([17.5, 15.8, 12.8, 3.2], views=2).word != "explained", "so few views fit by chance"
    assert told([17.5, 15.8, 12.8, 12.3]).reasons == (LITTLE_LEFT,), "nor a place"


def test_lines_without_any_pattern_count_only_when_they_are_clear() -> None:
    faint = {"p_any": 1e-6, "p_best": 0.3, "strongest": 10.0}
    assert decide(screen([0.1, 0.0], p_lines=2e-4, **faint), views=24).word == "nothing_missing"
    assert decide(screen([0.1, 0.0], p_lines=5e-5, **faint), views=24).word != "nothing_missing"
    assert decide(screen([9.0, 0.0], p_lines=2e-4, **(faint | {"p_best": 0.04})), views=24).word == "explained"


def test_what_strikes_at_another_part_is_no_rival() -> None:
    two = screen([20.0, 19.5, 4.0])
    assert decide(two, views=9).word == "ambiguous"
    apart = replace(two, struck=(frozenset({NAMES[0], NAMES[3]}), frozenset({NAMES[1]})))
    assert decide(apart, views=9).chosen == (NAMES[0],)
    rivals = replace(two, struck=(frozenset(NAMES[:2]), frozenset({NAMES[2]})))
    assert decide(rivals, views=9).chosen == NAMES[:2], "bearings with the same lines stay rivals"
    none = replace(screen([1.0, 2.0, 3.0, 4.0, 20.0, 19.5]), struck=apart.struck)
    assert decide(none, views=9).chosen == NAMES[4:6], "the likeliest strikes nowhere"


def test_one_effect_far_ahead_is_named() -> None:
    found = decide(screen([20.0, 9.0]), views=9)
    assert (found.word, found.chosen) == ("explained", NAMES[:1])


@pytest.mark.parametrize(
    ("evidence", "chosen", "why"),
    [
        ([12.0, 11.5], NAMES[:2], "place"),
        ([12.0, -5.0, 11.5], (NAMES[0], NAMES[2]), "mechanism"),
        ([12.0, -5.0, -5.0, 11.5], (NAMES[0], NAMES[3]), "look alike"),
    ],
)
def test_what_looks_alike_is_a_set_and_says_what_is_undecided(
    evidence: list[float], chosen: tuple[str, ...], why: str
) -> None:
    found = decide(screen(evidence), views=9)
    assert (found.word, found.chosen) == ("ambiguous", chosen)
    assert why in found.reasons[0]


def test_a_set_too_large_decides_nothing() -> None:
    found = decide(screen([12.0] * len(NAMES)), views=9)
    assert found.word == "not_decidable" and len(found.chosen) > MOST_NAMED


def test_a_bad_fit_is_unknown_whoever_is_nearest() -> None:
    assert decide(screen([20.0, 9.0], misfit=STRANGE + 0.01), views=9).word == "unknown_physics"
    fitted = Rest(unmet=2.0, kept=0.5, pooled=0.5, rough=False)
    assert decide(screen([20.0, 9.0], misfit=STRANGE + 0.01, rest=fitted), views=9).word == "explained", "far ahead"
    assert decide(screen([20.0, 15.0], misfit=STRANGE + 0.01, rest=fitted), views=9).word == "unknown_physics"
    assert decide(screen([2.0, -9.0], p_lines=CLEAR_P), views=9).word == "unknown_physics"


def test_a_lead_is_not_enough_for_what_fits_badly_and_explains_next_to_nothing() -> None:
    """The set are the effects of the place, which all lead those elsewhere."""
    hardly = Rest(unmet=3.3, kept=0.14, pooled=0.3, rough=False)
    found = decide(screen([28.0, 10.0, -1.0, -1.0], misfit=1.0, rest=hardly), views=24)
    assert found.word in {"ambiguous", "unknown_physics"}
    assert decide(screen([28.0, 10.0], misfit=0.9, rest=hardly), views=24).word == "explained"
    assert decide(screen([28.0, 10.0], misfit=1.0, rest=replace(hardly, kept=0.5)), views=24).word == "explained"


def test_what_healthy_machines_show_too_is_nothing() -> None:
    quiet = decide(screen([20.0], p_any=0.3, p_best=0.2, strongest=2.0), views=9)
    assert (quiet.word, quiet.chosen) == ("nothing_missing", ())
    assert "p = 1" in quiet.reasons[0]
    # A pattern in a change that is not unusual, and an unusual change that is not glaring, are nothing either.
    assert decide(screen([20.0], p_any=0.3), views=9).word == "nothing_missing"
    assert decide(screen([20.0], p_best=0.3, strongest=GLARING - 1), views=9).word == "nothing_missing"
    assert decide(screen([20.0], p_best=0.3, strongest=GLARING + 1), views=9).word == "explained"


def test_four_looks_cost_a_factor_of_four() -> None:
    assert chance(screen([1.0], p_any=0.02, p_best=0.002, strongest=1.0)) == pytest.approx(0.008)
    assert chance(screen([1.0], p_any=0.002, p_best=0.5)) == pytest.approx(0.008)
    assert chance(screen([1.0], p_any=0.5, p_best=0.5, p_direct=1e-4)) == pytest.approx(4e-4)
    assert chance(screen([1.0], p_any=0.5, p_best=0.5, p_lines=1e-5)) == pytest.approx(4e-5)
    assert chance(screen([1.0], p_any=0.5, p_best=0.5, strongest=1.0)) == 1.0


def test_a_pattern_that_stood_out_among_all_machines_needs_no_unusual_change() -> None:
    assert chance(screen([1.0], p_any=0.3, p_best=0.002, p_first=0.001)) == pytest.approx(0.004)
    assert chance(screen([1.0], p_any=0.3, p_best=0.03, p_first=0.001)) == pytest.approx(0.004)
    assert chance(screen([1.0], p_any=0.3, p_best=0.3, p_first=0.001)) == 1.0
    assert chance(screen([1.0], p_any=0.3, p_best=0.002, p_first=0.1)) == 1.0
    beside = {"p_first": 0.001, "p_best": 0.06}
    assert chance(screen([1.0], p_any=0.03, p_lines=0.01, **beside)) == pytest.approx(0.004), "all else is unusual"
    assert chance(screen([1.0], p_any=0.03, p_lines=0.2, **beside)) > 0.1
    assert chance(screen([1.0], p_any=0.2, p_lines=0.01, **beside)) > 0.1


def test_single_lines_that_the_best_effect_leaves_are_unknown_physics() -> None:
    changed = partial(screen, p_lines=CLEAR_P)
    found = decide(changed([20.0, 15.0], rest=Rest(unmet=2.1, kept=0.3)), views=9)
    assert found.word == "unknown_physics" and "2.1 times" in found.reasons[0]
    assert decide(changed([20.0, 15.0], rest=Rest(unmet=1.0, kept=0.3)), views=9).word == "explained"
    assert decide(changed([30.0, 15.0], rest=Rest(unmet=2.1, kept=0.3)), views=9).word == "explained", "far ahead"
    assert decide(changed([20.0, 15.0], rest=Rest(unmet=4.5, kept=0.65)), views=9).word == "explained"
    fitted = Rest(unmet=LEAST_LEFT_UNKNOWN, kept=0.65, pooled=0.4, rough=False)
    assert decide(changed([20.0, 15.0], rest=fitted), views=9).word == "unknown_physics", "fitted with the machine"
    assert decide(changed([20.0, 15.0], rest=replace(fitted, pooled=0.55)), views=9).word == "explained"
    assert decide(changed([20.0, 15.0], rest=replace(fitted, unmet=0.5)), views=9).word == "explained"
    other = replace(fitted, unmet=0.0, elsewhere=LEAST_LEFT_ELSEWHERE)
    assert decide(changed([20.0, 15.0], rest=other), views=9).word == "unknown_physics", "lines of the other view"
    assert decide(changed([20.0, 15.0], rest=replace(other, elsewhere=1.4)), views=9).word == "explained"
    assert decide(changed([20.0, 15.0], rest=replace(other, pooled=0.55)), views=9).word == "explained"
    beside = decide(struck([30.0, 5.0], [20.0], p_lines=CLEAR_P, rest=Rest(unmet=3.0, kept=0.3)), views=9)
    assert beside.word == "explained" and "left" in beside.reasons[0]


def test_clear_single_lines_are_not_too_faint_to_tell() -> None:
    assert decide(screen([1.0, 0.5], strongest=5.0, p_lines=0.01), views=9).word == "not_decidable"
    assert decide(screen([1.0, 0.5], strongest=5.0, p_lines=1e-6), views=9).word == "unknown_physics"


def test_forms_of_one_effect_count_together() -> None:
    assert variants("fit_clearance@bearing1", "fit_clearance_series@bearing1")
    assert not variants("fit_clearance@bearing1", "fit_clearance_series@bearing2")
    assert not variants("outer_spall@bearing1", "outer_spall@bearing1")
    # a support that stiffens cannot act where a fit has no support, and is another effect all the same
    assert exclusive("bearing_stiffness@bearing1", "fit_clearance@bearing1")
    assert not variants("bearing_stiffness@bearing1", "fit_clearance@bearing1")
    assert not exclusive("bearing_stiffness@bearing1", "fit_clearance@bearing2")
    names = ("fit_clearance@bearing1", "fit_clearance_series@bearing1", "unbalance@pinion")
    made = screen([10.0, 10.0, 5.0], names)
    weights = merged_weights(made)
    assert list(weights) == ["fit_clearance@bearing1", "unbalance@pinion"]
    assert sum(weights.values()) == pytest.approx(1.0)
    assert decide(made, views=9).word == "explained"


def test_the_smallest_set_that_carries_the_weight() -> None:
    weights = {"a": 0.5, "b": 0.3, "c": 0.15, "d": 0.05}
    assert credible_set(weights, 0.5) == ("a",)
    assert credible_set(weights, 0.9) == ("a", "b", "c")


def test_sentences_say_what_where_and_how_large() -> None:
    size = Severity(name="width", value=1.5e-3, unit="m", low=1.2e-3, high=1.9e-3)
    held = HeldOut(
        metric="log_spectral_distance",
        unit="dB",
        before=6.0,
        after=2.0,
        gain=0.67,
        gain_low=0.6,
        gain_high=0.7,
        retuned=0.1,
        black_box=0.2,
        placebo=0.0,
    )
    text = sentence(decide(screen([20.0]), views=9), size, held)
    assert "bearing1" in text and "1.5 mm" in text and "67 %" in text
    assert sentence(decide(screen([20.0], p_any=1.0, p_best=1.0, strongest=0.0), views=9), None, None).startswith(
        "Nothing"
    )
    assert " or " in sentence(decide(screen([12.0, 11.5]), views=9), None, None)
    assert title("outer_spall@bearing1").endswith("at bearing1")


def test_the_next_experiment_is_a_sensor_where_places_are_open_else_another_speed() -> None:
    sensor = next_experiment(NAMES[:2], 0.5, 1, ["bearing1"])
    assert sensor is not None and "bearing3" in sensor.sentence and sensor.separation_now == 0.5
    speed = next_experiment((NAMES[0], NAMES[2]), 0.5, 2, ["bearing1"])
    assert speed is not None and "one more speed" in speed.sentence
    for asked in (sensor, speed):
        assert asked.separation_expected is None and "not known" in asked.sentence, "nothing at hand predicts it"
    assert next_experiment(NAMES[:1], 0.5, 1, []) is None


def test_no_sensor_is_advised_where_one_is() -> None:
    machine = presets.preset("paper-lightly-damped")
    heard = sensor_sites(machine, ["resonator1.y.acceleration", "bearing3.outer.x.acceleration", "gear.y.acceleration"])
    assert heard == ("bearing1", "bearing3", "gear")
    told = next_experiment(NAMES[:2], 0.5, 1, heard)
    assert told is not None and "accelerometer" not in told.sentence


def test_a_sound_machine_is_told_the_chance_that_decided() -> None:
    sound = replace(screen([20.0], p_any=1.0, p_best=0.04, strongest=0.0), p_lines=0.003)
    told = decide(sound, views=9)
    assert told.word == "nothing_missing" and told.p == pytest.approx(0.012) and "0.012" in told.reasons[0]


def test_a_closer_look_is_taken_only_where_something_is_unusual() -> None:
    assert not remarkable(screen([1.0], p_any=0.3, p_best=0.25))
    assert remarkable(screen([1.0], p_any=0.01, p_best=0.5)) and remarkable(screen([1.0], p_any=0.5, p_best=0.01))


def test_impacts_without_the_change_they_bring_are_unknown_physics() -> None:
    alone = struck([12.0, 1.0], [11.0])
    found = decide(alone, views=9)
    assert found.word == "unknown_physics" and "impacts" in found.reasons[0]
    faint = struck([12.0, 1.0], [11.0], strongest=10.0)
    assert decide(faint, views=9).word == "explained", "a change too faint to tell may be all impacts"
    assert decide(struck([16.0, 1.0], [11.0]), views=9).word == "explained"


def test_where_only_impacts_tell_the_machine_chosen_to_fit_decides_nothing() -> None:
    made = struck([9.0, 4.5, 4.2, -1.0], [4.0, 4.0, 4.0], strongest=3.0, misfit=1.0, p_best=0.7, p_direct=1e-5)
    fitted = replace(made, unmoved=0.4)
    found = decide(fitted, views=9)
    assert (found.word, found.chosen) == ("ambiguous", NAMES[:3]) and "only impacts" in found.reasons[0]
    assert decide(replace(made, unmoved=3.5), views=9).word == "unknown_physics", "a pattern that was there before"
    one = replace(struck([9.0, 4.5], [8.0, 1.0], strongest=3.0, p_direct=1e-5), unmoved=0.4)
    assert decide(one, views=9).chosen == NAMES[:1]
    loud = replace(fitted, strongest=40.0)
    assert decide(loud, views=9).word == "unknown_physics", "what impacts do not bring"
    many = replace(made, direct=np.full(len(NAMES), 4.0), unmoved=0.4)
    assert decide(many, views=9).word == "not_decidable"


@pytest.mark.parametrize("unusual", [{"p_direct": 1.0}, {"p_lines": 1e-6}, {"strongest": GLARING + 1.0}])
def test_impacts_choose_nothing_where_something_else_is_unusual(unusual: dict[str, float]) -> None:
    quiet: dict[str, object] = {"strongest": 3.0, "misfit": 1.0, "p_direct": 1e-5, "p_best": 1e-3, "p_lines": 1.0}
    rest = Rest(unmet=6.0, kept=0.1)
    made = replace(struck([4.1, 1.0], [3.1], rest=rest, **quiet), unmoved=1.0)
    assert decide(made, views=9).word == "explained"
    other = replace(struck([4.1, 1.0], [3.1], rest=rest, **{**quiet, **unusual}), unmoved=1.0)
    assert decide(other, views=9).word == "unknown_physics"


def test_without_a_baseline_a_pattern_must_explain_something() -> None:
    weak = unmeasured(screen([2.0], p_any=0.02, p_best=0.001))
    assert decide(weak, views=9).word == "nothing_missing"
    sure = screen([12.0], p_any=0.02, p_best=0.001)
    assert unmeasured(sure) == sure


def test_sure_impacts_are_named_though_something_else_is_left() -> None:
    made = struck([30.0, 5.0], [20.0], misfit=1.0)
    found = decide(made, views=9)
    assert found.word == "explained" and "left" in found.reasons[0]
    assert decide(struck([30.0, 5.0], [2.0], misfit=1.0), views=9).word == "unknown_physics"


def test_what_is_far_behind_is_not_simulated_again() -> None:
    assert plausible(screen([20.0, 9.0, 7.0])) == list(NAMES[:2])


def test_fitted_machines_make_no_change_more_glaring_than_it_was() -> None:
    first, local = screen([1.0], strongest=9.0, p_best=0.5), screen([1.0], strongest=30.0, p_best=0.5)
    assert decide(local, views=9).word == "not_decidable"
    assert decide(tempered(local, first), views=9).word == "nothing_missing"
    assert tempered(first, local).strongest == 9.0
    assert tempered(local, replace(first, p_best=0.02)).p_first == 0.02
