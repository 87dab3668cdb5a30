"""A name stands only where the machine with it, simulated, is nearer to the recordings than without it."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.judge.adequacy import Rest
from reconcile.machine.decide import MECHANISM_OPEN, Decision
from reconcile.machine.direct import HEARD
from reconcile.machine.proved import (
    BEYOND_DOUBT,
    FORM_UNMET,
    MOST_KEPT,
    NO_BETTER,
    NO_FORECAST,
    NO_NEARER,
    UNLIKE,
    proved,
)
from reconcile.machine.weigh import FAR_AHEAD
from reconcile.machine.words import sentence
from reconcile.verdict import Cause, Word

NAMES = ("coulomb_friction@gear", "outer_spall@bearing1")
CAUSES = tuple(
    Cause(term=n.split("@")[0], site=n.split("@")[1], score=7.0 - k, named=k == 0) for k, n in enumerate(NAMES)
)


def decided(word: Word = "explained") -> Decision:
    return Decision(word=word, chosen=NAMES[:1], p=6.6e-5, reasons=())


def found(struck: float, evidence: float = 10.0, second: float = 0.0) -> SimpleNamespace:
    screen = SimpleNamespace(
        names=NAMES, direct=np.array([struck, 0.0]), evidence=np.array([evidence, second]), bursts={}, rest=Rest()
    )
    return SimpleNamespace(screen=screen)


def revised(before_db: float, after_db: float) -> SimpleNamespace:
    return SimpleNamespace(before_db=before_db, after_db=after_db)


def test_a_name_whose_machine_is_no_nearer_is_taken_back() -> None:
    decision, causes = proved(decided(), CAUSES, found(0.0), revised(3.49, 3.92))  # type: ignore[arg-type]
    assert decision.word == "not_decidable" and decision.reasons == (NO_NEARER,)
    assert not any(c.named for c in causes) and [c.term for c in causes] == [c.term for c in CAUSES]
    said = sentence(decision, None, None)
    assert "dry friction at a support at gear" in said and "nothing is named" in said and "missing" not in said


def held(gain: float, *effects: str, gain_low: float | None = None, black_box: float | None = None) -> SimpleNamespace:
    low = gain - 0.01 if gain_low is None else gain_low
    return SimpleNamespace(gain=gain, gain_low=low, black_box=black_box, effects=effects or NAMES[:1])


def test_so_is_a_name_that_foretells_nothing_of_what_it_was_not_fitted_to() -> None:
    nearer = revised(1.65, 1.56)
    decision, causes = proved(decided(), CAUSES, found(0.0), nearer, held(-0.08))  # type: ignore[arg-type]
    assert decision.word == "not_decidable" and decision.reasons == (NO_FORECAST,)
    assert not any(c.named for c in causes)
    assert "brings the spectra no nearer" in (said := sentence(decision, None, None)) and "nothing is named" in said
    for kept in (
        proved(decided(), CAUSES, found(0.0), nearer, held(0.02)),  # type: ignore[arg-type]
        proved(decided(), CAUSES, found(0.0), nearer, held(-0.08, "rub@gear", NAMES[0])),  # type: ignore[arg-type]
        proved(decided(), CAUSES, found(0.0), nearer),  # type: ignore[arg-type]
        proved(decided(), CAUSES, found(12.0), nearer, held(-0.08)),  # type: ignore[arg-type]
        proved(decided(), CAUSES, found(0.0, BEYOND_DOUBT + 1), nearer, held(-0.08)),  # type: ignore[arg-type]
    ):
        assert kept == (decided(), CAUSES)
    left_open = decided("ambiguous")
    assert proved(left_open, CAUSES, found(0.0), nearer, held(-0.08)) == (left_open, CAUSES)  # type: ignore[arg-type]


def test_so_is_one_that_may_foretell_nothing_and_less_than_a_correction_without_physics() -> None:
    """A friction that was named for a loose sensor (j022 of the proof): 0.025 (-0.028 to 0.059), a black box 0.080."""
    nearer = revised(1.8, 1.76)
    weak = held(0.025, gain_low=-0.028, black_box=0.08)
    decision, causes = proved(decided(), CAUSES, found(0.0), nearer, weak)  # type: ignore[arg-type]
    assert decision.word == "not_decidable" and decision.reasons == (NO_BETTER,)
    assert not any(c.named for c in causes)
    assert "correction without physics" in (said := sentence(decision, None, None)) and "nothing is named" in said
    for enough in (
        held(0.025, gain_low=0.001, black_box=0.08),
        held(0.025, gain_low=-0.028, black_box=0.02),
        held(0.025, gain_low=-0.028),
    ):
        assert proved(decided(), CAUSES, found(0.0), nearer, enough) == (decided(), CAUSES)  # type: ignore[arg-type]
    assert proved(decided(), CAUSES, found(12.0), nearer, weak) == (decided(), CAUSES), "its impacts prove it"  # type: ignore[arg-type]


LOOSE = ("fit_clearance_series@bearing1", "radial_clearance@bearing2")


@pytest.mark.parametrize(
    ("names", "lead", "rest", "word"),
    [
        (LOOSE, FAR_AHEAD, Rest(unmet=0.0, kept=MOST_KEPT), "explained"),
        (LOOSE, FAR_AHEAD - 0.1, Rest(unmet=0.0, kept=MOST_KEPT), "not_decidable"),
        (LOOSE, FAR_AHEAD, Rest(unmet=0.01, kept=MOST_KEPT), "not_decidable"),
        (LOOSE, FAR_AHEAD, Rest(unmet=0.0, kept=MOST_KEPT - 0.01), "not_decidable"),
        (LOOSE[::-1], FAR_AHEAD, Rest(unmet=0.0, kept=MOST_KEPT), "not_decidable"),
    ],
)
def test_a_loose_ring_far_ahead_whose_lines_are_met_need_not_foretell_how_it_rattles(
    names: tuple[str, str], lead: float, rest: Rest, word: Word
) -> None:
    screen = SimpleNamespace(names=names, direct=np.zeros(2), evidence=np.array([16.2, 16.2 - lead]), bursts={})
    screen.rest = rest
    decision = Decision(word="explained", chosen=names[:1], p=1.2e-5, reasons=())
    nearer, found_so = revised(4.91, 4.5), SimpleNamespace(screen=screen)
    told = proved(decision, CAUSES, found_so, nearer, held(-0.01, names[0]))  # type: ignore[arg-type]
    assert told[0].word == word
    worse = proved(decision, CAUSES, found_so, nearer, held(-0.5, names[0]))  # type: ignore[arg-type]
    assert worse[0].word == word, "how far it forecasts the wrong way says no more"
    assert 0.6 < MOST_KEPT < 0.77, "which bk069 of the proof had"
    far = proved(decision, CAUSES, found_so, revised(4.91, 5.0), held(-0.01, names[0]))  # type: ignore[arg-type]
    assert far[0].word == "not_decidable", "the machine with it must come nearer"


def test_so_is_a_set_whose_best_hardly_stands_out() -> None:
    machine, none = revised(3.69, 3.73), found(0.0, 3.7)
    decision, _ = proved(decided("ambiguous"), CAUSES, none, machine)  # type: ignore[arg-type]
    assert decision.word == "not_decidable" and decision.reasons == (NO_NEARER,)
    struck = found(12.0, 3.7)
    assert proved(decided("ambiguous"), CAUSES, struck, machine)[0].word == "ambiguous"  # type: ignore[arg-type]


@pytest.mark.parametrize("word", ["explained", "ambiguous"])
def test_what_strikes_for_sure_need_come_no_nearer_but_is_none_where_its_machine_is_far_off(word: Word) -> None:
    struck = found(23.6, 23.6, 19.8)
    assert proved(decided(word), CAUSES, struck, revised(3.92, 5.5))[0].word == word  # type: ignore[arg-type]
    decision, causes = proved(decided(word), CAUSES, struck, revised(3.92, 11.23))  # type: ignore[arg-type]
    assert decision.word == "not_decidable" and decision.reasons == (UNLIKE,)
    assert not any(c.named for c in causes) and all(c.reasons == (UNLIKE,) for c in causes)
    assert "far off the recorded levels" in (said := sentence(decision, None, None)) and "nothing is named" in said


def test_a_burst_of_a_tooth_needs_no_level_that_comes_nearer() -> None:
    teeth = ("tooth_crack@gear", "tooth_spall@gear")
    screen = SimpleNamespace(names=teeth, direct=np.array([HEARD, HEARD]), evidence=np.array([6.6, 6.6]), bursts={})
    decision = Decision(word="ambiguous", chosen=teeth, p=4.9e-3, reasons=())
    told = proved(decision, CAUSES, SimpleNamespace(screen=screen), revised(1.0, 1.1))  # type: ignore[arg-type]
    assert told[0] == decision
    screen.direct[:] = HEARD - 0.1
    told = proved(decision, CAUSES, SimpleNamespace(screen=screen), revised(1.0, 1.1))  # type: ignore[arg-type]
    assert told[0].word == "not_decidable"


def test_a_name_beyond_doubt_stays_and_says_that_its_form_is_not_met() -> None:
    machine = revised(2.85, 3.45)
    decision, causes = proved(decided(), CAUSES, found(0.0, BEYOND_DOUBT + 1), machine)  # type: ignore[arg-type]
    assert decision == decided()
    assert causes[0].named and causes[0].reasons == (FORM_UNMET,)
    assert causes[1:] == CAUSES[1:]
    near = found(0.0, BEYOND_DOUBT + 1, second=BEYOND_DOUBT - 2)
    assert proved(decided(), CAUSES, near, machine)[0].word == "not_decidable"  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("word", "struck", "levels"),
    [
        ("explained", 0.0, (3.49, 3.2)),
        ("explained", 12.0, (3.49, 3.92)),
        ("explained", 0.0, None),
        ("ambiguous", 0.0, (3.49, 3.92)),
    ],
)
def test_other_answers_stand(word: Word, struck: float, levels: tuple[float, float] | None) -> None:
    machine = None if levels is None else revised(*levels)
    decision, causes = proved(decided(word), CAUSES, found(struck), machine)  # type: ignore[arg-type]
    assert decision == decided(word) and causes == CAUSES


def test_a_burst_stays_where_what_it_stood_beside_is_no_nearer() -> None:
    """The loose fit of m038, if its machine had not come nearer: the tooth is there whatever else is."""
    fit, teeth = "fit_clearance@bearing2", ("tooth_crack@pinion", "tooth_spall@pinion")
    names = (*reversed(teeth), fit)
    screen = SimpleNamespace(
        names=names, direct=np.array([23.0, 23.0, 0.0]), evidence=np.array([1.0, 4.3, 18.0]), bursts={}
    )
    causes = tuple(
        Cause(term=n.split("@")[0], site=n.split("@")[1], score=18.0 - k, named=k == 0)
        for k, n in enumerate((fit, *names[:2]))
    )
    decision = Decision(word="explained", chosen=(fit,), p=1e-6, reasons=())
    asked = decision, causes, SimpleNamespace(screen=screen), revised(1.0, 1.01)
    assert proved(*asked)[0].word == "not_decidable", "no burst has been set aside"  # type: ignore[arg-type]
    screen.bursts = dict.fromkeys(teeth, 23.0)
    told, ranked = proved(*asked)  # type: ignore[arg-type]
    assert (told.word, told.chosen, told.reasons) == ("ambiguous", teeth, (MECHANISM_OPEN,))
    assert [f"{c.term}@{c.site}" for c in ranked] == [*teeth, fit] and not any(c.named for c in ranked)
    screen.bursts = {teeth[1]: 23.0}
    told, ranked = proved(*asked)  # type: ignore[arg-type]
    assert (told.word, told.chosen) == ("explained", teeth[1:]) and ranked[0].named and not ranked[1].named
