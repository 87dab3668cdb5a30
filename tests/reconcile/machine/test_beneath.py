"""A pattern beneath the burst of a tooth is the answer where it is clearly another effect's and explains the change."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.judge.adequacy import Rest
from reconcile.judge.screen import Screen
from reconcile.machine import beneath
from reconcile.machine.beneath import asked_beneath, beneath_a_tooth, burst_leads, set_aside
from reconcile.machine.budget import QUICK
from reconcile.machine.decide import STRANGE, STRUCK, decide
from reconcile.machine.search import leaders
from reconcile.machine.weigh import FAR_AHEAD, HOPELESS, credible_set, merged_weights
from tests.reconcile.machine.screens import screen

NAMES = (
    "tooth_spall@pinion",
    "tooth_crack@pinion",
    "missing_tooth@pinion",
    "fit_clearance_series@bearing2",
    "fit_clearance@bearing2",
    "cubic_support@gear",
)
TEETH, FIT = NAMES[:3], NAMES[3]
M038 = [4.3, 1.0, 0.5, 18.0, 4.1, 4.7]
OF_TEETH = Rest(unmet=3.3, kept=0.2, pooled=0.07, elsewhere=3.3, rough=False)
OF_FIT = Rest(unmet=0.95, kept=0.75, pooled=0.41, elsewhere=0.95, rough=True)


def told(
    patterns: list[float], burst: float = 23.0, names: tuple[str, ...] = NAMES, heard: float = 0.0, **how: object
) -> Screen:
    """Of m038: all faults of a tooth of the pinion have the burst; `heard`: direct evidence of the fourth effect."""
    direct = np.array([burst, burst, burst, heard, 0.0, 0.0])
    fitted = {"likelihoods": dict.fromkeys(names[3:], 49.0), "rest": OF_TEETH} | how
    return replace(screen(list(np.array(patterns) + direct), names, **fitted), direct=direct)


@pytest.fixture
def rest(monkeypatch: pytest.MonkeyPatch) -> dict[str, object]:
    """What the best effect leaves is `rest`, how ill it fits `misfit`; the effects of which it was asked."""
    left: dict[str, object] = {"rest": OF_FIT, "misfit": 0.27, "asked": []}

    def of_best(made: Screen, views: object, observed: object) -> Screen:
        left["asked"].append(made.names[int(np.argmax(made.evidence))])  # type: ignore[attr-defined]
        return replace(made, rest=left["rest"], misfit=left["misfit"])  # type: ignore[arg-type]

    monkeypatch.setattr(beneath, "of_best", of_best)
    return left


def after(made: Screen) -> Screen:
    return beneath_a_tooth(made, (), np.zeros(1))


def test_a_loose_fit_beneath_the_burst_is_the_first(rest: dict[str, object]) -> None:
    before = told(M038)
    assert decide(before, views=9).chosen[0] in TEETH
    made = after(before)
    assert rest["asked"] == [FIT] and not made.rest.rough
    found = decide(made, views=9)
    assert (found.word, found.chosen) == ("explained", (FIT,))
    assert credible_set(merged_weights(made)) == (FIT,), "weights and scores say so too"
    assert made.patterns == pytest.approx(before.patterns), "the patterns are as they were"
    np.testing.assert_array_equal(made.direct, before.direct)
    assert set_aside(made) == TEETH and set_aside(before) == ()
    assert not made.yields, "the teeth are not told as being as likely and leaving more"


@pytest.mark.parametrize(
    ("patterns", "burst", "why"),
    [
        ([4.3, 1.0, 0.5, HOPELESS - 0.1, 0.0, 0.0], 23.0, "faint"),
        ([18.0 - FAR_AHEAD + 0.1, 1.0, 0.5, 18.0, 4.1, 4.7], 23.0, "the tooth has nearly as much of a pattern"),
        ([4.3, 1.0, 0.5, 18.0, 4.1, 18.0 - FAR_AHEAD + 0.1], 23.0, "another effect has"),
        ([11.0, 1.0, 0.5, 18.0, 4.1, 4.7], STRUCK - 0.1, "the burst is not sure"),
        ([-9.0, -9.0, -9.0, 40.0, 4.1, 4.7], 23.0, "the fit leads anyway"),
    ],
)
def test_else_nothing_changes(patterns: list[float], burst: float, why: str, rest: dict[str, object]) -> None:
    made = told(patterns, burst)
    assert after(made) is made and rest["asked"] == [], why


@pytest.mark.parametrize(
    "left",
    [
        {"rest": Rest(unmet=2.5, kept=0.3, pooled=0.2, elsewhere=2.5, rough=True)},
        {"misfit": STRANGE + 0.005},
    ],
)
def test_what_does_not_explain_the_change_is_no_answer(left: dict[str, object], rest: dict[str, object]) -> None:
    rest |= left
    made = told(M038)
    assert after(made) is made and rest["asked"] == [FIT]


def test_what_was_not_fitted_with_the_machine_is_no_answer_but_is_fitted(rest: dict[str, object]) -> None:
    made = told(M038, likelihoods={})
    assert after(made) is made and rest["asked"] == []
    assert burst_leads(made) and asked_beneath(made) == FIT
    leading = leaders(SimpleNamespace(screen=made), QUICK)  # type: ignore[arg-type]
    assert set(TEETH) < set(leading) and leading[-1] == FIT


@pytest.mark.parametrize("heard", [-25.0, 0.0, 7.0])
@pytest.mark.parametrize("name", ["outer_spall@bearing1", "tooth_crack@gear"])
def test_what_strikes_is_never_beneath(name: str, heard: float, rest: dict[str, object]) -> None:
    """An unheard pit's pattern, another gear's tooth: impacts are what they are told by."""
    names = (*TEETH, name, *NAMES[4:])
    made = told([4.3, 1.0, 0.5, 18.0, 1.0, 2.0], names=names, heard=heard)
    assert after(made) is made and asked_beneath(made) is None and rest["asked"] == []


def test_another_form_of_the_fit_and_a_twin_do_not_stand_against_it(rest: dict[str, object]) -> None:
    assert decide(after(told([4.3, 1.0, 0.5, 18.0, 17.0, 4.7])), views=9).chosen == (FIT,)
    twins = (*TEETH, "unbalance@pinion", "bent_shaft@pinion", "cubic_support@gear")
    found = decide(after(told([4.3, 1.0, 0.5, 18.0, 17.9, 4.7], names=twins)), views=9)
    assert set(found.chosen) == set(twins[3:5]), "both of them, which are the same force"
    assert rest["asked"] == [FIT, twins[3]]


def test_few_views_exclude_no_more_than_without_a_burst(rest: dict[str, object]) -> None:
    found = decide(after(told([4.3, 1.0, 0.5, 18.5, 4.1, 10.0])), views=1)
    assert rest["asked"] == [FIT] and found.word == "ambiguous" and "cubic_support@gear" in found.chosen


def test_what_yielded_to_another_counts_less(rest: dict[str, object]) -> None:
    made = told([4.3, 1.0, 0.5, 12.0, 4.1, 2.0], yields={FIT: 6.0})
    assert made.patterns[3] == pytest.approx(18.0) and after(made) is made and rest["asked"] == []
