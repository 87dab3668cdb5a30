"""Effects that look alike at some speeds are told apart by what they forecast of the others."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.judge.space import Library
from reconcile.machine import contest as module
from reconcile.machine.contest import BEATEN, BY_FORECAST, CLEARLY, FORM_BY_FIT, MOST, by_contest, contest
from reconcile.machine.decide import Decision
from reconcile.machine.heldout import MANY, lead_by, trial
from reconcile.machine.library import Catalogued
from reconcile.machine.meter import Meter
from reconcile.machine.stages import of_contest
from reconcile.machine.unstruck import SILENT
from signals.series import FloatArray
from sim.core.spec import TermSpec

FEATURES, POINTS, HAND, FAIR = 40, 3, 8, 20
RIGHT, WRONG, THIRD = "rub@gear", "pitch_error@gear", "squeeze_film@bearing1"
ELSEWHERE = "rub@pinion"
OUTER, INNER = "outer_spall@bearing1", "inner_spall@bearing1"
SPECTRAL = np.ones(POINTS * FEATURES, dtype=bool)
METER = Meter(map)


def pattern(number: int) -> FloatArray:
    """Change of an effect of full size, (points * F,) dB: the first two are alike at the first point only, and the
    third is a pattern of its own."""
    rng = np.random.default_rng(number)
    own = rng.normal(0.0, 8.0, (POINTS, FEATURES))
    if number < 2:
        own[0] = np.random.default_rng(9).normal(0.0, 8.0, FEATURES)
        own[1:] *= -1.0 if number else 1.0
    return own.ravel()


def drawn(names: tuple[str, ...], count: int, seed: int, shown: dict[str, FloatArray]) -> Catalogued:
    """`count` draws of each effect at sizes from a third to three times."""
    rng = np.random.default_rng(seed)
    sizes = np.exp(np.linspace(-1.1, 1.1, count))
    rows = [s * shown[n] + rng.normal(0.0, 1.0, SPECTRAL.size) for n in names for s in sizes]
    groups = {n: tuple(range(k * count, (k + 1) * count)) for k, n in enumerate(names)}
    terms = tuple(TermSpec(term=n.split("@")[0], site=n.split("@")[1], parameters={}) for n in names for _ in sizes)
    return Catalogued(library=Library(changes=np.array(rows), groups=groups, shares=np.zeros(len(rows))), terms=terms)


class Open:
    """What was observed of the first effect, and what is at hand of all."""

    def __init__(
        self,
        monkeypatch: pytest.MonkeyPatch,
        names: tuple[str, ...] = (RIGHT, WRONG, THIRD),
        *,
        evidence: tuple[float, ...] = (9.0, 10.0, 8.0),
        struck: tuple[float, ...] = (0.0, 0.0, 0.0),
        alike: bool = False,
        foreign_db: float = 0.0,
        hand: int = HAND,
    ) -> None:
        shown = {n: pattern(k) for k, n in enumerate(names)}
        if alike:
            shown[names[1]] = 1.02 * shown[names[0]]
        rng = np.random.default_rng(7)
        observed = shown[names[0]] + rng.normal(0.0, 1.0, SPECTRAL.size)
        observed += foreign_db * np.random.default_rng(8).normal(0.0, 1.0, SPECTRAL.size)
        self.asked: list[str] = []
        self.setting = SimpleNamespace(
            changes=SimpleNamespace(
                observed=observed,
                starts=tuple(FEATURES * p for p in range(POINTS + 1)),
                measured=np.ones(SPECTRAL.size),
                null=rng.normal(0.0, 0.5, (12, SPECTRAL.size)),
                with_baseline=True,
            ),
            data=(None,) * POINTS,
            fitted_machine=object(),
            direct=SimpleNamespace(evidence=dict(zip(names, struck, strict=True))),
            seed=3,
        )
        screen = SimpleNamespace(names=names, evidence=np.array(evidence), direct=np.array(struck))
        self.found = SimpleNamespace(unled=drawn(names, hand, 5, shown), screen=screen)
        self.shown = shown

        def simulated(_setting: object, _found: object, name: str, _meter: object) -> Catalogued | None:
            self.asked.append(name)
            return drawn((name,), FAIR, 11, shown)

        monkeypatch.setattr(module, "with_sizes", simulated)

    def told(self, decision: Decision) -> module.Contest | None:
        return contest(self.setting, self.found, decision, SPECTRAL, METER)  # type: ignore[arg-type]


SET = Decision(word="ambiguous", chosen=(WRONG, RIGHT), p=1e-4, reasons=("they look alike",))


def test_the_law_that_holds_at_the_speeds_held_out_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    made = Open(monkeypatch)
    held = made.told(SET)
    assert held is not None
    assert (held.decision.word, held.decision.chosen, held.decision.reasons) == ("explained", (RIGHT,), (BY_FORECAST,))
    assert next(iter(held.gains)) == RIGHT and held.gains[RIGHT] > 0.6 * held.ceiling
    assert min(held.ahead.values()) >= CLEARLY and set(held.ahead) == {WRONG, THIRD}
    assert sorted(made.asked) == sorted((RIGHT, WRONG, THIRD)), "each has its chance, once"
    assert set(held.drawn) == set(made.asked)
    (shown,) = of_contest(held)
    assert str(shown["held_out_gain"]).count("behind by") == 2


def test_so_it_is_of_a_set_too_large_to_tell(monkeypatch: pytest.MonkeyPatch) -> None:
    many = replace(SET, word="not_decidable", chosen=(RIGHT, WRONG, THIRD), reasons=("3 effects look alike",))
    held = Open(monkeypatch).told(many)
    assert held is not None and held.decision.word == "explained" and held.decision.chosen == (RIGHT,)


def test_what_forecasts_alike_stays_a_set(monkeypatch: pytest.MonkeyPatch) -> None:
    """At hand one of both is far off, so that it gets its chance; and takes it."""
    made = Open(monkeypatch, alike=True)
    library = made.found.unled.library
    rows = list(library.groups[WRONG])
    library.changes[rows] += np.random.default_rng(1).normal(0.0, 9.0, (len(rows), SPECTRAL.size))
    held = made.told(SET)
    assert held is not None and WRONG in made.asked
    assert held.decision is SET and min(held.ahead.values()) < CLEARLY
    name = Decision(word="explained", chosen=(WRONG,), p=1e-4, reasons=())
    again = made.told(name)
    assert again is not None and again.ahead.get(WRONG, -1.0) <= 0.0 and again.decision is name, "nor is a name beaten"


def test_nothing_is_simulated_where_the_draws_at_hand_forecast_alike(monkeypatch: pytest.MonkeyPatch) -> None:
    made = Open(monkeypatch, alike=True)
    assert made.told(SET) is None and made.asked == []
    few = Open(monkeypatch, alike=True, hand=MANY - 1)
    assert few.told(SET) is not None and WRONG in few.asked, "unless too few of them are"


def test_what_forecasts_less_than_half_of_it_is_no_name(monkeypatch: pytest.MonkeyPatch) -> None:
    """Most of the change is none that a known effect brings."""
    made = Open(monkeypatch, foreign_db=6.5)
    held = made.told(SET)
    assert held is None or held.decision.word == "ambiguous"
    beside = Open(monkeypatch, foreign_db=6.5, struck=(0.0, 0.0, 12.0)).told(SET)
    assert beside is not None and beside.decision.word == "explained", (
        "sure impacts say that something stands beside it"
    )


def test_a_name_that_another_forecasts_better_than_is_a_set_of_both(monkeypatch: pytest.MonkeyPatch) -> None:
    name = Decision(word="explained", chosen=(WRONG,), p=1e-4, reasons=())
    beaten = Open(monkeypatch, foreign_db=6.5).told(name)
    assert beaten is not None
    assert (beaten.decision.word, beaten.decision.chosen) == ("ambiguous", (RIGHT, WRONG))
    assert beaten.decision.reasons == (BEATEN,)
    other = Open(monkeypatch).told(name)
    assert other is not None and other.decision.chosen == (RIGHT,), "unless that forecasts nearly all of it"
    right = replace(name, chosen=(RIGHT,))
    made = Open(monkeypatch)
    assert made.told(right) is None and made.asked == [], "the best forecast is the name's own: nothing is open"


def test_impacts_that_are_sure_prove_a_name_whatever_is_forecast(monkeypatch: pytest.MonkeyPatch) -> None:
    name = Decision(word="explained", chosen=(WRONG,), p=1e-4, reasons=())
    assert Open(monkeypatch, struck=(0.0, 12.0, 0.0)).told(name) is None


def test_a_pit_that_is_heard_beats_one_that_is_not(monkeypatch: pytest.MonkeyPatch) -> None:
    silent = Decision(word="unknown_physics", chosen=(INNER,), p=1e-4, reasons=(SILENT,))
    made = Open(monkeypatch, (OUTER, INNER, RIGHT), evidence=(20.0, 30.0, 3.0), struck=(6.0, 0.0, 0.0))
    held = made.told(silent)
    assert held is not None and held.decision.word == "explained" and held.decision.chosen == (OUTER,)
    assert sorted(made.asked) == sorted((OUTER, INNER)), "pits of that bearing alone"
    unheard = Open(monkeypatch, (OUTER, INNER, RIGHT), evidence=(20.0, 30.0, 3.0), struck=(2.0, 0.0, 0.0))
    assert unheard.told(silent) is None
    told = silent, None
    one, decision, other = by_contest(made.setting, made.found, silent, told, SPECTRAL, METER)  # type: ignore[arg-type]
    assert one is not None and decision.chosen == (OUTER,) and other is None


@pytest.mark.parametrize(
    ("evidence", "word", "chosen"),
    [
        (12.1, "explained", ("fit_clearance_series@bearing1",)),
        (10.0, "ambiguous", ("fit_clearance_series@bearing1", "radial_clearance@bearing1")),
        (6.1, "ambiguous", ("radial_clearance@bearing1", "fit_clearance_series@bearing1")),
        (5.9, "explained", ("radial_clearance@bearing1",)),
        (1.0, "explained", ("radial_clearance@bearing1",)),
    ],
)
def test_which_of_what_shows_alike_at_one_place_is_the_screens_to_tell(
    monkeypatch: pytest.MonkeyPatch, evidence: float, word: str, chosen: tuple[str, ...]
) -> None:
    """A wider clearance forecasts best; a loose fit of that bearing is far behind, but of quite its form nothing is."""
    names = ("radial_clearance@bearing1", WRONG, "fit_clearance_series@bearing1")
    made = Open(monkeypatch, names, evidence=(9.0, 10.0, evidence))
    held = made.told(replace(SET, chosen=(WRONG, names[0])))
    assert held is not None and (held.decision.word, held.decision.chosen) == (word, chosen)
    assert next(iter(held.gains)) == names[0] and held.ahead.get(names[2], 1.0) >= CLEARLY
    told = {"explained": FORM_BY_FIT if chosen[0] == names[2] else BY_FORECAST, "ambiguous": BEATEN}
    assert held.decision.reasons == (told[word],)


def test_a_name_is_not_beaten_by_what_shows_alike(monkeypatch: pytest.MonkeyPatch) -> None:
    names = ("radial_clearance@bearing1", WRONG, "fit_clearance_series@bearing1")
    name = Decision(word="explained", chosen=(names[2],), p=1e-4, reasons=())
    held = Open(monkeypatch, names, evidence=(9.0, 8.0, 20.0), foreign_db=6.5).told(name)
    assert held is not None and held.decision is name


@pytest.mark.parametrize(
    "decision",
    [
        replace(SET, chosen=(RIGHT, ELSEWHERE)),
        replace(SET, word="not_decidable", chosen=(WRONG, RIGHT), reasons=("the change is too faint",)),
        replace(SET, word="unknown_physics", reasons=("none of the known",)),
    ],
    ids=["places of one effect", "too faint", "none of the known"],
)
def test_what_is_open_for_another_reason_stays_open(monkeypatch: pytest.MonkeyPatch, decision: Decision) -> None:
    made = Open(monkeypatch)
    assert made.told(decision) is None and made.asked == []


@pytest.mark.parametrize("why", ["one point", "no baseline", "no machine", "a tooth", "nothing missing"])
def test_nothing_is_asked_where_held_out_points_cannot_tell(monkeypatch: pytest.MonkeyPatch, why: str) -> None:
    names = ("missing_tooth@gear", WRONG, THIRD) if why == "a tooth" else (RIGHT, WRONG, THIRD)
    made = Open(monkeypatch, names)
    decision = replace(SET, chosen=(WRONG, names[0]))
    if why == "one point":
        made.setting.data = (None,)
    elif why == "no baseline":
        made.setting.changes.with_baseline = False
    elif why == "no machine":
        made.setting.fitted_machine = None
    elif why == "nothing missing":
        decision = Decision(word="nothing_missing", chosen=(), p=0.5, reasons=("usual",))
    assert made.told(decision) is None and made.asked == []


def test_where_a_second_effect_is_named_nothing_is_open(monkeypatch: pytest.MonkeyPatch) -> None:
    made = Open(monkeypatch)
    paired = replace(SET, word="explained", chosen=(WRONG,))
    second = object()
    told = by_contest(made.setting, made.found, SET, (paired, second), SPECTRAL, METER)  # type: ignore[arg-type]
    assert told == (None, paired, second) and made.asked == []


def test_none_takes_part_that_is_worse_than_no_change_however_well_it_forecasts(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    names = (RIGHT, "unbalance@gear", WRONG)
    made = Open(monkeypatch, names, evidence=(9.0, -20.0, 10.0), alike=True, hand=MANY - 1)
    held = made.told(replace(SET, chosen=(WRONG, RIGHT)))
    assert held is not None and set(held.gains) == {RIGHT, WRONG}


def test_only_so_many_take_part(monkeypatch: pytest.MonkeyPatch) -> None:
    names = (RIGHT, WRONG, THIRD, *(f"unbalance@part{k}" for k in range(4)))
    made = Open(monkeypatch, names, evidence=(9.0,) * 7, struck=(0.0,) * 7)
    many = replace(SET, word="not_decidable", chosen=names, reasons=("7 effects look alike",))
    held = made.told(many)
    assert held is not None and len(held.gains) == MOST == len(made.asked) and RIGHT in held.gains


def test_another_form_of_the_one_that_leads_is_no_rival(monkeypatch: pytest.MonkeyPatch) -> None:
    names = ("fit_clearance@bearing1", WRONG, "fit_clearance_series@bearing1")
    held = Open(monkeypatch, names).told(replace(SET, chosen=(WRONG, names[0], names[2])))
    assert held is not None and set(held.gains) == {names[0], WRONG} and held.decision.chosen == (names[0],)


def test_a_lead_is_sure_only_beyond_what_chance_makes_of_it() -> None:
    rng = np.random.default_rng(2)
    observed = rng.normal(0.0, 6.0, SPECTRAL.size)
    changes = SimpleNamespace(
        observed=observed,
        starts=tuple(FEATURES * p for p in range(POINTS + 1)),
        measured=np.ones(SPECTRAL.size),
        null=np.zeros((4, SPECTRAL.size)),
    )
    held = trial(changes, SPECTRAL)  # type: ignore[arg-type]
    parts = [observed[FEATURES * p : FEATURES * (p + 1)] for p in range(POINTS)]
    half = [0.5 * p for p in parts]
    assert held.gain(half) == pytest.approx(0.5) and held.gain(parts) == pytest.approx(0.0)
    assert lead_by(held, half, parts, 1) == pytest.approx(0.5), "of every block, whichever are drawn"
    assert lead_by(held, half, half, 1) == 0.0
    noisy = [[p + rng.normal(0.0, 3.0, FEATURES) for p in half] for _ in range(2)]
    assert min(lead_by(held, *noisy, 1), lead_by(held, *noisy[::-1], 1)) < 0.0, "equals do not lead each other"
    assert lead_by(held, half, parts, 1) == lead_by(held, half, parts, 1)
