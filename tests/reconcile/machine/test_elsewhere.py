"""The same effect at another place that forecasts held-out data better leaves the place open."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import pytest

from reconcile.machine.decide import LEFT_OVER, LITTLE_LEFT, NAME_P, NO_PATTERN, UNMATCHED, Decision
from reconcile.machine.elsewhere import (
    BY_FORECAST,
    CLEARLY,
    CLEARLY_LATER,
    HALF_OF_IT,
    LEAST_GAIN,
    MOST_OF_IT,
    by_forecast,
    with_place,
)
from reconcile.machine.heldout import LATER, MANY
from reconcile.machine.weigh import MOST_NAMED
from reconcile.report.action import PLACE_OPEN, to_do
from reconcile.verdict import Cause, HeldOut, Placebo, PlaceWeight, Report, Where

HELD = HeldOut(
    metric="log_spectral_distance", unit="dB", before=7.0, after=3.8, gain=0.46, gain_low=0.38, gain_high=0.52,
    retuned=0.06, black_box=0.4, placebo=0.54, held="each operating point in turn", ceiling=0.8, numbers=4,
    placebos=(
        Placebo(term="ball_spall", site="bearing1", gain=0.7, draws=16),
        Placebo(term="outer_spall", site="bearing2", gain=0.54, draws=16),
        Placebo(term="outer_spall", site="bearing4", gain=0.0, draws=2),
    ),
    effects=("outer_spall@bearing1",),
)  # fmt: skip
CAUSES = (
    Cause(term="outer_spall", site="bearing1", score=42.9, named=True, reasons=("a part of the change is left",)),
    Cause(term="unbalance", site="gear", score=25.0),
    Cause(term="outer_spall", site="bearing2", score=20.0),
)
NAMED = Report(
    verdict="explained",
    sentence="Outer-race spall at bearing1.",
    level="machine",
    where=Where(sites=(PlaceWeight(site="bearing1", weight=0.99),), limits=("known",)),
    causes=CAUSES,
    held_out=HELD,
    undecidable=("impacts come from another part too, one of these: outer_spall@bearing3",),
    machine={"name": "revised"},
)
HEARD = {"outer_spall@bearing1": 25.0, "outer_spall@bearing2": 25.0}


def told(report: Report = NAMED, heard: Mapping[str, float] = HEARD) -> Report:
    return with_place(report, heard, 3, ("bearing1", "bearing4"))


def test_a_better_forecast_of_the_same_effect_elsewhere_opens_the_place() -> None:
    report = told()
    assert report.verdict == "ambiguous"
    assert report.sentence == (
        f"Something is missing, but {PLACE_OPEN}: at bearing1 it fits best, but forecasts data it was not fitted to "
        "less well (46 %) than at bearing2 (54 %): outer-race spall at bearing1, or outer-race spall at bearing2."
    )
    assert [(s.site, s.weight) for s in report.where.sites] == [("bearing1", 0.5), ("bearing2", 0.5)]
    assert [(c.term, c.site, c.named) for c in report.causes] == [
        ("outer_spall", "bearing1", False), ("outer_spall", "bearing2", False), ("unbalance", "gear", False),
    ]  # fmt: skip
    assert report.causes[0].reasons[1:] == CAUSES[0].reasons and report.causes[2].reasons == ()
    assert report.undecidable[0].startswith(PLACE_OPEN) and report.undecidable[1:] == NAMED.undecidable
    assert report.next_experiment is not None and "nearest to bearing2" in report.next_experiment.sentence
    assert report.next_experiment.separation_now is None, "what fits better is what the forecast speaks against"
    assert to_do(report).startswith("plan to inspect bearing1 and bearing2: one of them has it.")
    assert report.where.limits == NAMED.where.limits and report.machine == NAMED.machine


def rival(**changes: object) -> Report:
    ball, outer, other = HELD.placebos
    placebos = (ball, replace(outer, **changes), other)  # type: ignore[arg-type]
    return replace(NAMED, held_out=replace(HELD, placebos=placebos))


@pytest.mark.parametrize(
    "report",
    [
        replace(NAMED, held_out=None),
        replace(NAMED, held_out=replace(HELD, gain_high=0.55)),
        replace(NAMED, held_out=replace(HELD, effects=("outer_spall@bearing1", "unbalance@gear"))),
        replace(NAMED, causes=CAUSES[:2]),
        replace(NAMED, verdict="ambiguous"),
        rival(draws=MANY - 1),
        rival(term="inner_spall"),
        replace(rival(gain=0.99 * LEAST_GAIN), held_out=replace(rival(gain=0.09).held_out, gain_high=0.0)),  # type: ignore[type-var]
    ],
    ids=["no forecast", "within", "two effects", "not simulated", "no name", "few draws", "other effect", "no gain"],
)
def test_else_the_name_stands(report: Report) -> None:
    assert told(report) is report


def test_impacts_at_a_places_own_lines_are_there_whatever_the_levels_forecast() -> None:
    assert told(heard={"outer_spall@bearing1": 25.0}) is NAMED
    assert told(heard={**HEARD, "outer_spall@bearing2": 13.0}).verdict == "ambiguous"
    assert told(heard={}).verdict == "ambiguous", "what does not strike"


PLACES = ("outer_spall@bearing1", "outer_spall@bearing2")
OPEN = Decision(word="ambiguous", chosen=PLACES, p=1e-4, reasons=(PLACE_OPEN,))
FARTHER = Placebo(term="outer_spall", site="bearing2", gain=0.3, draws=16)
FAR = replace(HELD, gain=0.83, gain_low=0.79, placebos=(FARTHER,))


def test_held_out_data_name_the_place_that_alone_forecasts_them() -> None:
    found = by_forecast(OPEN, FAR)
    assert (found.word, found.chosen, found.reasons) == ("explained", OPEN.chosen[:1], (BY_FORECAST,))


@pytest.mark.parametrize(
    ("decision", "held"),
    [
        (replace(OPEN, word="not_decidable"), FAR),
        (replace(OPEN, chosen=("outer_spall@bearing1", "inner_spall@bearing1")), FAR),
        (replace(OPEN, chosen=(*OPEN.chosen, "outer_spall@bearing4")), FAR),
        (OPEN, None),
        (OPEN, replace(FAR, effects=("outer_spall@bearing2",))),
        (OPEN, replace(FAR, gain_low=LEAST_GAIN - 0.01)),
        (OPEN, replace(FAR, gain_low=0.3 + CLEARLY - 0.01)),
        (OPEN, replace(FAR, gain_low=float("nan"))),
        (OPEN, replace(FAR, gain_low=0.3 + CLEARLY_LATER - 0.01, held=f"{LATER}: 30 Hz")),
        (replace(OPEN, reasons=("only impacts tell",)), FAR),
        (OPEN, replace(FAR, placebos=(replace(FARTHER, draws=MANY - 1),))),
    ],
)  # fmt: skip
def test_and_stay_silent_where_they_do_not(decision: Decision, held: HeldOut | None) -> None:
    assert by_forecast(decision, held) is decision


LONE = Decision(word="unknown_physics", chosen=PLACES[:1], p=1e-4, reasons=(UNMATCHED,))


def test_a_forecast_of_nearly_all_of_it_stands_for_a_pattern_that_no_draw_came_near() -> None:
    for decision in (LONE, replace(LONE, chosen=PLACES)):
        found = by_forecast(decision, FAR)
        assert (found.word, found.chosen, found.reasons) == ("explained", PLACES[:1], ())


@pytest.mark.parametrize(
    ("decision", "held"),
    [
        (replace(LONE, reasons=(NO_PATTERN,)), FAR),
        (replace(LONE, chosen=(*PLACES, "outer_spall@bearing4")), FAR),
        (LONE, None),
        (LONE, replace(FAR, effects=PLACES)),
        (LONE, replace(FAR, gain_low=0.99 * MOST_OF_IT * 0.8, black_box=0.0)),
        (LONE, replace(FAR, gain_low=float("nan"))),
        (LONE, replace(FAR, black_box=0.79 - 0.5 * CLEARLY)),
        (LONE, replace(FAR, black_box=None)),
        (replace(LONE, p=1.01 * NAME_P), FAR),
        (LONE, replace(FAR, ceiling=None)),
        (LONE, replace(FAR, placebos=(replace(FARTHER, gain=0.79 - 0.5 * CLEARLY),))),
        (LONE, replace(FAR, placebos=(replace(FARTHER, gain=0.79 - 0.9 * CLEARLY_LATER),), held=f"{LATER}: 30 Hz")),
        (LONE, replace(FAR, placebos=(replace(FARTHER, draws=MANY - 1),))),
    ],
)  # fmt: skip
def test_and_nothing_less_does(decision: Decision, held: HeldOut | None) -> None:
    assert by_forecast(decision, held) is decision


RING = ("fit_clearance_series@bearing1",)
LITTLE = Decision(word="not_decidable", chosen=RING, p=4e-6, reasons=(LITTLE_LEFT,))
FORETOLD = replace(
    HELD, gain=0.33, gain_low=0.17, gain_high=0.45, retuned=0.13, black_box=0.2, ceiling=0.59, effects=RING,
    placebos=(
        Placebo(term="outer_waviness", site="bearing1", gain=0.21, draws=2),
        Placebo(term="coulomb_friction", site="bearing1", gain=0.01, draws=16),
    ),
)  # fmt: skip


SURE = replace(FORETOLD, gain_low=0.27)


def test_a_forecast_of_half_of_it_before_all_others_names_what_leaves_a_little() -> None:
    found = by_forecast(LITTLE, SURE)
    assert (found.word, found.chosen, found.reasons) == ("explained", RING, (LEFT_OVER,))
    bare = replace(SURE, retuned=None)
    assert by_forecast(LITTLE, bare).word == "explained"


@pytest.mark.parametrize(
    ("decision", "held", "measured"),
    [
        (replace(LITTLE, p=1.01 * NAME_P), SURE, True),
        (LITTLE, FORETOLD, True),
        (LITTLE, replace(SURE, gain_low=0.2 + 0.5 * CLEARLY), True),
        (LITTLE, replace(SURE, held=f"{LATER}: 30 Hz"), True),
        (LITTLE, SURE, False),
    ],
    ids=["seen in sound machines", "within", "hardly above", "one record", "no baseline"],
)
def test_a_name_needs_more_than_a_set(decision: Decision, held: HeldOut, measured: bool) -> None:
    assert by_forecast(decision, held, measured=measured) is decision


def test_a_set_is_told_with_less_but_not_without_a_baseline_or_of_one_record() -> None:
    both = replace(LITTLE, chosen=(*RING, "inner_waviness@bearing2"), p=5.0 * NAME_P)
    assert by_forecast(both, FORETOLD).word == "ambiguous"
    assert by_forecast(both, FORETOLD, measured=False) is both
    one = replace(FORETOLD, held=f"{LATER}: 30 Hz")
    assert by_forecast(both, one) is both
    ahead = replace(one, placebos=(replace(FORETOLD.placebos[1], gain=0.33 - 1.1 * CLEARLY_LATER),))
    assert by_forecast(both, ahead).word == "ambiguous"


def test_every_wrong_law_counts_wherever_it_stands_in_the_list() -> None:
    for placebos in (SURE.placebos, SURE.placebos[::-1]):
        beaten = tuple(replace(p, gain=0.33) if p.term == "outer_waviness" else p for p in placebos)
        assert by_forecast(LITTLE, replace(SURE, placebos=beaten)) is LITTLE


def test_and_tells_the_set_that_it_is_where_more_effects_are_in_question() -> None:
    both = (*RING, "inner_waviness@bearing2")
    found = by_forecast(replace(LITTLE, chosen=both), FORETOLD)
    assert (found.word, found.chosen) == ("ambiguous", both) and found.reasons[1:] == (LEFT_OVER,)
    many = replace(LITTLE, chosen=(*RING, *(f"radial_clearance@bearing{k}" for k in range(MOST_NAMED - 1))))
    assert by_forecast(many, FORETOLD) is many, "a set cut short"


@pytest.mark.parametrize(
    ("decision", "held"),
    [
        (replace(LITTLE, reasons=("8 effects look alike",)), SURE),
        (LITTLE, None),
        (LITTLE, replace(SURE, effects=("radial_clearance@bearing1",))),
        (LITTLE, replace(SURE, gain_low=LEAST_GAIN - 0.01)),
        (LITTLE, replace(SURE, gain_low=float("nan"))),
        (LITTLE, replace(SURE, ceiling=0.34 / HALF_OF_IT)),
        (LITTLE, replace(SURE, ceiling=None)),
        (LITTLE, replace(SURE, black_box=0.33 - 0.5 * CLEARLY)),
        (LITTLE, replace(SURE, black_box=None)),
        (LITTLE, replace(SURE, retuned=0.33 - 0.5 * CLEARLY)),
        (LITTLE, replace(SURE, placebos=(replace(SURE.placebos[0], gain=0.33 - 0.5 * CLEARLY),))),
        (LITTLE, replace(SURE, placebos=())),
        (LITTLE, replace(SURE, placebos=SURE.placebos[:1])),
    ],
)  # fmt: skip
def test_and_a_lesser_one_does_not(decision: Decision, held: HeldOut | None) -> None:
    assert by_forecast(decision, held) is decision
