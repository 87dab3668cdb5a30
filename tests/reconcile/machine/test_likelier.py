"""What is no set: a first effect far likelier, feature by feature, than all others; impacts beside a pattern."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reconcile.judge.adequacy import Rest
from reconcile.judge.screen import Screen
from reconcile.machine import leftover
from reconcile.machine import likelier as machine_likelier
from reconcile.machine.decide import FEW_BESIDE_REST, FEW_VIEWS, LINE_BY_LINE, decide
from reconcile.machine.left_lines import UNMET_ROUGH
from reconcile.machine.leftover import likelihoods
from reconcile.machine.likelier import BEHIND, LEAST_LIKELIER, LIKELIER_SHARE, likelier, rivals, yielding
from tests.reconcile.machine.rubs import FEATURES, MADE, RIGHT, WRONG, found_in
from tests.reconcile.machine.test_decide import NAMES, screen

EVIDENCE = [20.0, 19.0, 0.0, 0.0]
BOTH = NAMES[:2]


def told(first: float, second: float) -> dict[str, float]:
    return dict(zip(BOTH, (first, second), strict=True))


def test_the_likelier_of_a_set_is_named_with_the_reason() -> None:
    assert decide(screen(EVIDENCE), views=9).word == "ambiguous"
    found = decide(screen(EVIDENCE, likelihoods=told(100.0, 70.0)), views=9)
    assert (found.word, found.chosen, found.reasons) == ("explained", BOTH[:1], (LINE_BY_LINE,))


@pytest.mark.parametrize(
    "likelihoods",
    [
        {},
        {BOTH[0]: 100.0},
        told(LEAST_LIKELIER - 1.0, 0.0),
        told(1000.0, 1000.0 * (1.0 - LIKELIER_SHARE) + 1.0),
        told(80.0, 100.0),
        told(100.0, 76.0),
        told(-50.0, -70.0),
    ],
)
def test_and_stays_one_where_it_is_not(likelihoods: dict[str, float]) -> None:
    assert decide(screen(EVIDENCE, likelihoods=likelihoods), views=9).word == "ambiguous"
    assert likelier(screen(EVIDENCE, likelihoods=likelihoods), BOTH) == BOTH


def test_few_views_fit_by_chance_and_one_name_needs_no_lead() -> None:
    sure = screen(EVIDENCE, likelihoods=told(100.0, 0.0))
    assert decide(sure, views=FEW_VIEWS).word == "ambiguous"
    assert likelier(sure, BOTH[:1]) == BOTH[:1]


def test_what_leaves_a_part_of_few_views_is_not_chosen_feature_by_feature() -> None:
    """x024 of the proof: a ring at one point, which rattles as no draw of it does, as good as a wider clearance."""
    part = Rest(unmet=UNMET_ROUGH + 0.1, kept=0.83, pooled=0.35, elsewhere=4.8, rough=False)
    made = screen(EVIDENCE, likelihoods=told(100.0, -740.0), rest=part)
    assert decide(made, views=FEW_BESIDE_REST).word == "ambiguous"
    assert decide(made, views=FEW_BESIDE_REST + 1).chosen == BOTH[:1]
    less = replace(part, unmet=UNMET_ROUGH)
    assert decide(replace(made, rest=less), views=FEW_BESIDE_REST).chosen == BOTH[:1]


def test_what_is_far_less_likely_leaves_the_set_and_a_bow_stays_with_its_unbalance() -> None:
    names = ("unbalance@pinion", "bent_shaft@pinion", "bent_shaft@gear")
    known = dict(zip(names, (106.0, 20.0, 20.0), strict=True))
    made = screen([20.0, 19.0, 18.0], names, likelihoods=known)
    assert likelier(made, names) == names[:2]
    found = decide(made, views=9)
    assert (found.word, found.chosen) == ("ambiguous", names[:2]) and LINE_BY_LINE not in found.reasons


M009 = ("bearing_stiffness@bearing1", "fit_clearance@bearing1", "squeeze_film@bearing1", "rub@pinion")


def test_a_lead_by_patterns_alone_is_no_proof_of_what_leaves_much_of_the_lines() -> None:
    """m009 of the proof: a support that stiffens before the loose fit of its bearing, which was as likely."""
    values, left = [43.2, 34.8, 16.4, 11.3], Rest(unmet=6.6, kept=0.39, pooled=0.68, rough=False)
    alone = decide(screen(values, M009, rest=left), views=9)
    assert (alone.word, alone.chosen) == ("explained", M009[:1])
    known = dict(zip(M009, (73.0, 72.0, 12.0), strict=False))
    found = decide(screen(values, M009, rest=left, likelihoods=known), views=9)
    assert (found.word, found.chosen) == ("ambiguous", M009[:2]), "a film is far less likely than either"
    elsewhere = decide(screen(values, M009, rest=left, likelihoods={M009[0]: 73.0, M009[3]: 73.0}), views=9)
    assert (elsewhere.word, elsewhere.chosen) == ("ambiguous", (M009[0], M009[3])), "wherever the other is"
    behind = decide(screen(values, M009, rest=left, likelihoods={**known, M009[1]: 60.0}), views=9)
    assert (behind.word, behind.chosen) == ("explained", M009[:1])
    fits = decide(screen(values, M009, likelihoods=known), views=9)
    assert (fits.word, fits.chosen) == ("explained", M009[:1]), "where nothing is left the lead is enough"
    nothing = decide(screen(values, M009, rest=left, likelihoods={M009[0]: 2.0, M009[1]: 1.5}), views=9)
    assert (nothing.word, nothing.chosen) == ("explained", M009[:1]), "neither is likelier than no change"


def yielded(
    monkeypatch: pytest.MonkeyPatch, rests: dict[str, Rest], values: tuple[float, ...], second: float = 72.0
) -> Screen:
    """m009 with these rests, evidence and likelihood of the fit."""
    monkeypatch.setattr(machine_likelier, "rest_in", lambda _v, _o, name, _s: rests[name])
    monkeypatch.setattr(
        machine_likelier, "of_best", lambda s, _v, _o: replace(s, rest=rests[s.names[int(np.argmax(s.evidence))]])
    )
    known = dict(zip(M009, (73.0, second, 12.0), strict=False))
    made = screen(list(values), M009, rest=rests[M009[0]], likelihoods=known)
    return yielding(made, (), np.zeros(1))


LEAVES = Rest(unmet=6.6, kept=0.39, pooled=0.68, elsewhere=6.6, rough=False)
KEEPS = Rest(unmet=2.5, kept=0.76, pooled=0.77, elsewhere=2.5, rough=False)


def test_what_leaves_lines_comes_behind_what_is_as_likely_and_does_not(monkeypatch: pytest.MonkeyPatch) -> None:
    rests = dict(zip(M009, (LEAVES, KEEPS, LEAVES, LEAVES), strict=True))
    values = (43.2, 34.8, 16.4, 11.3)
    made = yielded(monkeypatch, rests, values)
    assert made.yields == {M009[0]: pytest.approx(43.2 - 34.8 + BEHIND)} and made.rest == KEEPS
    assert made.patterns.max() == pytest.approx(43.2), "how unusual the change is stays what it was"
    found = decide(made, views=9)
    assert (found.word, found.chosen) == ("explained", M009[1:2]) and found.reasons, "a part is left"


@pytest.mark.parametrize(
    ("first", "second", "values", "likelihood"),
    [
        (KEEPS, KEEPS, (43.2, 34.8, 16.4, 11.3), 72.0),  # the best leaves nothing that it should not
        (LEAVES, LEAVES, (43.2, 34.8, 16.4, 11.3), 72.0),  # so does the other
        (LEAVES, KEEPS, (43.2, 34.8, 16.4, 11.3), 60.0),  # which is less likely
        (LEAVES, KEEPS, (43.2, 34.8, 36.4, 11.3), 72.0),  # and not the next
        (LEAVES, KEEPS, (47.2, 34.8, 16.4, 11.3), 72.0),  # and far behind
        (LEAVES, replace(KEEPS, kept=0.58, pooled=0.77), (43.2, 34.8, 16.4, 11.3), 72.0),  # and explains hardly more
    ],
)
def test_and_stays_the_best_else(
    monkeypatch: pytest.MonkeyPatch, first: Rest, second: Rest, values: tuple[float, ...], likelihood: float
) -> None:
    rests = dict(zip(M009, (first, second, LEAVES, LEAVES), strict=True))
    made = yielded(monkeypatch, rests, values, likelihood)
    assert not made.yields and made.evidence.tolist() == list(values)


def test_all_forms_of_what_yields_come_behind(monkeypatch: pytest.MonkeyPatch) -> None:
    names = ("fit_clearance@b", "bearing_stiffness@b", "fit_clearance_series@b")
    rests = dict(zip(names, (LEAVES, KEEPS, LEAVES), strict=True))
    monkeypatch.setattr(machine_likelier, "rest_in", lambda _v, _o, name, _s: rests[name])
    monkeypatch.setattr(machine_likelier, "of_best", lambda s, _v, _o: s)
    known = dict(zip(names, (73.0, 72.0), strict=False))
    made = yielding(screen([43.0, 34.8, 36.0], names, rest=LEAVES, likelihoods=known), (), np.zeros(1))
    assert made.evidence.tolist() == pytest.approx([30.8, 34.8, 30.8]) and set(made.yields) == {names[0], names[2]}


def test_forms_of_one_effect_and_a_bow_of_an_unbalance_are_no_rivals() -> None:
    names = ("fit_clearance@bearing1", "fit_clearance_series@bearing1", "rub@gear")
    both = dict(zip(names, (73.0, 72.0, -5.0), strict=True))
    assert not rivals(screen([40.0, 35.0, 3.0], names, likelihoods=both))
    assert rivals(screen([40.0, 35.0, 3.0], names, likelihoods={**both, names[2]: 72.0}))
    assert not rivals(screen([40.0, 35.0, 3.0], names, likelihoods={names[2]: 72.0})), "the first was not fitted"
    twins = ("unbalance@pinion", "bent_shaft@pinion")
    assert not rivals(screen([40.0, 35.0], twins, likelihoods=dict(zip(twins, (73.0, 72.0), strict=True))))


def test_likelihoods_are_of_what_was_fitted_and_does_not_strike(monkeypatch: pytest.MonkeyPatch) -> None:
    observed = MADE.change(RIGHT, np.array([0.06, -0.05, 0.03]), 2e7)
    observed += np.random.default_rng(8).normal(0, 1, FEATURES)
    setting, found = found_in(observed)
    assert likelihoods(setting, found) == {}  # type: ignore[arg-type]
    found.led.update(dict.fromkeys((RIGHT, WRONG), setting.plan.offsets[0]))  # type: ignore[attr-defined]
    both = likelihoods(setting, found)  # type: ignore[arg-type]
    assert both[RIGHT] > 30.0 and both[WRONG] < 0.0, "what moves other features is less likely than no change"
    monkeypatch.setattr(leftover, "strikes", lambda name: name == WRONG)
    assert likelihoods(setting, found) == {RIGHT: both[RIGHT]}  # type: ignore[arg-type]


def test_impacts_of_a_part_are_no_other_answer_than_a_pattern_that_strikes_nowhere() -> None:
    """Neither explains the other's: a loose pedestal and the pit of one of two bearings with the same lines."""
    looseness, spalls = "pedestal_looseness@bearing2", ("outer_spall@bearing3", "outer_spall@bearing4")
    names = (looseness, *spalls, "rub@gear")
    struck = np.array([0.0, 13.0, 13.0, 0.0])
    both = replace(screen([15.0, 15.0, 14.8, 7.0], names), direct=struck)
    assert decide(both, views=9).chosen == (looseness,)
    behind = replace(screen([14.9, 15.0, 14.0, 7.0], names), direct=struck)
    assert decide(behind, views=9).chosen == (looseness,), "chance decides which of both is first"
    left = {"misfit": 1.0, "rest": Rest(unmet=9.0, kept=0.0)}
    pit = decide(replace(behind, **left), views=9)  # type: ignore[arg-type]
    assert (pit.word, pit.chosen) == ("explained", (looseness,)), "a pit leaves what stands beside it"
    unsure = replace(behind, direct=np.array([0.0, 4.0, 13.0, 0.0]), **left)  # type: ignore[arg-type]
    assert decide(unsure, views=9).word != "explained", "nothing tells that it fits"
    far = replace(screen([13.0, 15.0, 14.8, 7.0], names), direct=struck)
    assert len(decide(far, views=9).chosen) > 1, "the first's own pattern is not asked for"
    rivals = replace(screen([15.0, 15.0, 14.8, 14.0], names), direct=struck)
    assert len(decide(rivals, views=9).chosen) > 1, "the pattern is not decided"
    own = replace(screen([15.0, 27.0, 14.8, 7.0], names), direct=struck)
    assert decide(own, views=9).chosen == spalls[:1], "the pit's own pattern is as good"
    near = replace(screen([15.0, 14.5, 4.8, 7.0], names), direct=np.array([0.0, 1.5, 0.0, 0.0]))
    assert decide(near, views=9).chosen == (looseness, spalls[0]), "impacts that are not sure"
    unsure = replace(screen([15.0, 14.9, 14.8, 1.0], names), direct=np.array([0.0, 1.0, 1.0, 0.0]))
    assert decide(unsure, views=9).word == "ambiguous"
