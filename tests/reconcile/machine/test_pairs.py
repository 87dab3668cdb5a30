"""Two effects that are fitted together: a second one is named where it adds what the first alone does not bring."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from reconcile.judge.adequacy import Rest
from reconcile.machine import pairs, pictures
from reconcile.machine.causes import ITS_IMPACTS, TOGETHER, ranked_causes
from reconcile.machine.decide import Decision
from reconcile.machine.direct import HEARD
from reconcile.machine.heldout import held_out, with_sums
from reconcile.machine.of_teeth import APART
from reconcile.machine.pairs import LEAST_GAIN, Pair, best_pair, fitted_pair, named_pair, of_its_tooth, sums
from reconcile.observe.phases import DB_PER_RAD
from sim.core.spec import TermSpec
from tests.reconcile.judge.made import FEATURES, changes, world
from tests.reconcile.machine import test_second
from tests.reconcile.machine.rubs import MADE, MEMBERS, RIGHT, WRONG, found_in

TRUE = np.array([0.06, -0.05, 0.03])
EXPLAINED = Decision(word="explained", chosen=(RIGHT,), p=1e-6, reasons=())
UNKNOWN = replace(EXPLAINED, word="unknown_physics")


MEMBERS_MADE: list[tuple[TermSpec, TermSpec]] = []
"""First and second effect of the members that were simulated last."""


@pytest.fixture
def simulated(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Simulating is asking the made world; what was asked for."""
    asked: list[str] = []

    def again(_setting, candidate, offsets, terms, _mapper, also=()):  # type: ignore[no-untyped-def]
        """The first member does not run."""
        asked.append(f"{candidate.label}+rub@{also[0].site}")
        MEMBERS_MADE[:] = list(zip(terms, also, strict=True))
        made = MADE.catalogue(candidate.label, [o.values for o in offsets[1:]], list(terms[1:]), also[1:])
        return replace(made, pairs=tuple(range(1, len(terms))))

    monkeypatch.setattr(pairs, "simulated_again", again)
    return asked


SMALLER = 5e6


def seen(second: float | None = None) -> np.ndarray:
    """A rub at the gear; one of so many N/m at the pinion beside it."""
    noise = np.random.default_rng(8).normal(0, 1, FEATURES)
    both = MADE.change(RIGHT, TRUE, 2e7) + noise
    return both if second is None else both + MADE.change(WRONG, TRUE, second)


def pair_in(observed: np.ndarray, decision: Decision = EXPLAINED) -> Pair | None:
    setting, found = found_in(observed)
    pairs_of = best_pair(setting, found, decision, 8, 2, map)  # type: ignore[arg-type]
    return pairs_of.best if pairs_of is not None else None


MIXED = changes(world(), np.zeros(FEATURES))


def summed(a: float, b: float, phases: int = 0) -> np.ndarray:
    full = np.full(FEATURES, a), np.full(FEATURES, b)
    return replace(MIXED, phases=phases).both(*full)


@given(st.floats(-30, 60), st.floats(-30, 60))
def test_two_changes_add_as_powers_where_both_rise(a: float, b: float) -> None:
    both = float(summed(a, b)[0])
    assert both == pytest.approx(float(summed(b, a)[0]))
    assert float(summed(a, 0.0)[0]) == pytest.approx(a)
    if a > 0.0 and b > 0.0:
        assert max(a, b) - 1e-9 <= both <= max(a, b) + 3.02 + 1e-9
    else:
        assert both == pytest.approx(a + b)


@given(st.floats(-25, 25), st.floats(-25, 25))
def test_phases_add_and_turn_round(a: float, b: float) -> None:
    turn = 2 * np.pi * DB_PER_RAD
    mixed = summed(a, b, phases=7)
    assert mixed[-8] == pytest.approx(summed(a, b)[0]), "levels as before"
    assert abs(mixed[-1]) <= 0.5 * turn + 1e-9
    assert (mixed[-1] - (a + b)) / turn == pytest.approx(round((mixed[-1] - (a + b)) / turn), abs=1e-9)
    rows = replace(MIXED, phases=7).both(np.full((3, 1, FEATURES), a), np.full(FEATURES, b))
    assert np.allclose(rows, mixed)


def test_what_is_there_beside_the_first_adds_and_nothing_else_does() -> None:
    setting, found = found_in(seen(SMALLER))
    (one,) = sums(setting, found, RIGHT, 8)  # type: ignore[arg-type]
    alone, known = found_in(seen())
    (none,) = sums(alone, known, RIGHT, 8)  # type: ignore[arg-type]
    assert one.name == none.name == WRONG and one.gain > 10.0 and none.gain < 1.0
    assert len(one.rows) == 8 and {a in found.known.library.groups[RIGHT] for a, _ in one.rows} == {True}
    assert {b in found.known.library.groups[WRONG] for _, b in one.rows} == {True} and one.view is found.fine
    assert sums(setting, replace(found, fine=None), RIGHT, 8) == []  # type: ignore[arg-type]


def test_both_are_fitted_together(simulated: list[str]) -> None:
    observed = seen(SMALLER)
    setting, found = found_in(observed)
    (one,) = sums(setting, found, RIGHT, 8)  # type: ignore[arg-type]
    pair = fitted_pair(setting, found, RIGHT, one, map)  # type: ignore[arg-type]
    assert pair is not None and pair.gain > one.gain > LEAST_GAIN
    assert simulated == [f"{RIGHT}+{WRONG}"]
    together = pair.beside.together
    assert together is not None and together.severity.low < SMALLER < together.severity.high
    assert abs(np.log(together.severity.value / SMALLER)) < 0.7
    assert [t.site for t in together.terms[0]] == ["gear", "pinion"]
    assert len(together.terms) == 7 and all(pair in MEMBERS_MADE[1:] for pair in together.terms)
    assert pair.rest.unmet == 0.0 and pair.rest.kept > 0.9 and not pair.rest.rough
    start = np.mean([o.values for o in setting.plan.offsets], axis=0)
    assert np.linalg.norm(together.middle.values - TRUE) < np.linalg.norm(start - TRUE)


def test_a_pair_is_named_and_a_single_effect_gets_no_second(simulated: list[str]) -> None:
    pair = pair_in(seen(SMALLER))
    assert pair is not None and pair.first == RIGHT and pair.beside.names == (WRONG,) and pair.others == ()
    simulated.clear()
    assert pair_in(seen()) is None and simulated == [], "nothing adds enough to be worth simulating"
    quiet = replace(EXPLAINED, word="nothing_missing")
    assert pair_in(seen(SMALLER), quiet) is None and simulated == []


def test_what_no_effect_explains_is_a_pair_only_if_both_leave_nothing(
    simulated: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    assert pair_in(seen(SMALLER), UNKNOWN) is not None
    left = Rest(unmet=2.0, kept=0.4, pooled=0.3, elsewhere=2.0, rough=False)
    monkeypatch.setattr(pairs, "_rest", lambda *_: left)
    assert pair_in(seen(SMALLER), UNKNOWN) is None
    assert pair_in(seen(SMALLER)) is not None, "an effect that is named stands, whatever both leave"
    assert simulated


def test_a_first_that_is_not_decided_gets_no_second(simulated: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    setting, found = found_in(seen(SMALLER))
    screen = found.screen
    names, evidence = (*screen.names, "unbalance@pinion"), np.append(screen.evidence, screen.evidence.max() - 1.0)
    rivals = replace(EXPLAINED, word="ambiguous", chosen=(RIGHT, "unbalance@pinion"))
    found = replace(found, screen=replace(screen, names=names, evidence=evidence))
    every = {RIGHT: sums(setting, found, RIGHT, 8)}  # type: ignore[arg-type]
    (one,) = every[RIGHT]
    for gain, decided in ((0.0, True), (one.gain + 20.0, False)):
        every["unbalance@pinion"] = [replace(one, gain=gain)]
        monkeypatch.setattr(pairs, "sums", lambda _s, _f, first, _m: every[first])
        told = best_pair(setting, found, rivals, 8, 2, map)  # type: ignore[arg-type]
        assert told is not None and (told.best is not None) == decided
    assert simulated


def test_a_rival_close_by_keeps_the_second_from_being_named(
    simulated: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    setting, found = found_in(seen(SMALLER))
    (one,) = sums(setting, found, RIGHT, 8)  # type: ignore[arg-type]
    pair = fitted_pair(setting, found, RIGHT, one, map)  # type: ignore[arg-type]
    assert pair is not None and simulated
    for gain, near in ((pair.gain - 1.0, ("rub@pinion", "unbalance@pinion")), (pair.gain - 7.0, ())):
        untried = replace(one, name="unbalance@pinion", gain=gain)
        monkeypatch.setattr(pairs, "sums", lambda *_, other=untried: [one, other])
        told = best_pair(setting, found, EXPLAINED, 8, 1, map)  # type: ignore[arg-type]
        assert told is not None and told.best is not None and told.best.others == near
        assert [(name, simulated is None) for name, _, simulated in told.tried] == [
            (WRONG, False),
            ("unbalance@pinion", True),
        ]
        decision, beside = named_pair(UNKNOWN, None, told)
        assert (beside is None) == bool(near) and decision.word == ("unknown_physics" if near else "explained")
    assert told is not None and named_pair(EXPLAINED, pair.beside, told)[1] is pair.beside, "what strikes too stands"
    assert named_pair(EXPLAINED, None, None) == (EXPLAINED, None)


def test_one_of_several_beside_impacts_must_add_as_much_as_without(
    simulated: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    setting, found = found_in(seen(SMALLER))
    (one,) = sums(setting, found, RIGHT, 8)  # type: ignore[arg-type]
    pair = fitted_pair(setting, found, RIGHT, one, map)  # type: ignore[arg-type]
    assert pair is not None and simulated
    monkeypatch.setattr(pairs, "strikes", lambda _: True)
    monkeypatch.setattr(pairs, "heard_in", lambda found, _: list(found.views))
    monkeypatch.setattr(pairs, "LEAST_GAIN", pair.gain + 1.0)
    for lead, stands in ((7.0, True), (1.0, False)):
        untried = replace(one, name="unbalance@pinion", gain=pair.gain - lead)
        monkeypatch.setattr(pairs, "sums", lambda *_, other=untried: [one, other])
        told = best_pair(setting, found, EXPLAINED, 8, 1, map)  # type: ignore[arg-type]
        assert told is not None and (told.best is not None) == stands


def test_what_would_strike_stands_beside_only_if_it_is_heard() -> None:
    observed = test_second.seen((2, 0), 1)
    setting, found = test_second.found_in(observed, 0.0)
    spall, seat = test_second.NAMES[:2]
    for evidence, there in (({}, False), ({spall: HEARD - 0.1}, False), ({spall: HEARD}, True)):
        setting.direct = SimpleNamespace(evidence=evidence)
        names = [one.name for one in sums(setting, found, seat, 8)]  # type: ignore[arg-type]
        assert (spall in names) == there
        assert not there or names[0] == spall


def test_sidebands_do_not_speak_beside_impacts() -> None:
    _, found = test_second.found_in(test_second.seen((0,), 1), 20.0)
    spall, seat = test_second.NAMES[:2]
    found = replace(found, sides=found.fine)
    assert len(pairs.heard_in(found, seat)) == 3 and len(pairs.heard_in(found, spall)) == 2


def test_the_second_cause_has_its_own_size_and_the_forecast_both(simulated: list[str]) -> None:
    observed = seen(SMALLER)
    setting, found = found_in(observed)
    pair = pair_in(observed)
    assert pair is not None and simulated and pair.beside.together is not None
    weights = {RIGHT: 0.9, WRONG: 0.1}
    first, second = ranked_causes(found, EXPLAINED, weights, observed, pair.beside)[:2]
    assert (first.site, second.site) == ("gear", "pinion") and first.named and second.named
    assert second.reasons == (TOGETHER,) and second.severity == pair.beside.together.severity
    for cause in (first, second):
        assert cause.severity is not None and cause.values[cause.severity.name] == cause.severity.value, "one size"
    alone = ranked_causes(found, EXPLAINED, weights, observed, None, [WRONG])
    assert alone[0].severity is not None
    told = replace(alone[0].severity, value=3.0, low=2.0, high=4.5)
    name = f"{alone[0].term}@{alone[0].site}"
    by_levels = ranked_causes(found, EXPLAINED, weights, observed, None, [WRONG], None, {}, {name: told})
    assert by_levels[0].severity == told and by_levels[1].severity == alone[1].severity
    heard = ranked_causes(found, EXPLAINED, weights, observed, None, [WRONG], None, {name: told}, {name: told})
    assert heard[0].severity is not None and heard[0].severity.value == pytest.approx(3.0)
    assert [f"{c.term}@{c.site}" for c in alone[:2]] == [EXPLAINED.chosen[0], WRONG]
    assert alone[1].reasons == (ITS_IMPACTS,) and not alone[1].named
    spectral, frequency = np.ones(FEATURES, dtype=bool), np.linspace(10.0, 1000.0, FEATURES)
    library = found.known.library
    flat = np.concatenate([library.changes, np.zeros((8, FEATURES))])
    groups = {**library.groups, "rub@wheel": tuple(range(len(library.changes), len(flat)))}
    more = replace(found.known, library=replace(library, changes=flat, groups=groups))
    known = {"spectral": spectral, "frequency": frequency, "seed": 1}
    alone = held_out(setting.changes, more, RIGHT, **known)
    told = held_out(setting.changes, more, RIGHT, beside=WRONG, **known)
    assert told.gain > alone.gain + 0.1 and (told.numbers or 0) > (alone.numbers or 0)
    assert (alone.effects, told.effects) == ((RIGHT,), (RIGHT, WRONG))
    (placebo,) = told.placebos
    assert placebo.site == "wheel" and placebo.gain == pytest.approx(alone.gain, abs=0.1), "the first with nothing"
    assert len(with_sums(setting.changes, more, RIGHT, WRONG).library.groups[RIGHT]) == MEMBERS * MEMBERS


def test_the_ranking_marks_both_names_and_shows_them_wherever_they_stand(monkeypatch: pytest.MonkeyPatch) -> None:
    setting, found = found_in(seen(SMALLER))
    rows = pictures.ranking(setting, found, [RIGHT, WRONG])
    assert sum(bool(row["named"]) for row in rows) == 2
    monkeypatch.setattr(pictures, "MOST_RANKED", 1)
    fewer = pictures.ranking(setting, found, [RIGHT, WRONG])
    assert sorted(row["score"] for row in fewer if row["named"]) == sorted(r["score"] for r in rows if r["named"])
    assert not any(row["named"] for row in pictures.ranking(setting, found, []))


def test_a_fault_of_a_tooth_leads_the_others_far_enough_or_is_one_of_them() -> None:
    broken, pit, crack = (f"{kind}@pinion" for kind in ("missing_tooth", "tooth_spall", "tooth_crack"))
    tried = ((pit, 25.5, 19.2), (broken, 21.2, 36.0), ("cage_slip@bearing1", 12.7, None), (crack, 8.6, None))
    assert of_its_tooth(broken, tried) == [pit, crack]  # a pit always; the crack was summed only
    for gain, others in ((36.0 - APART, [pit]), (36.0 - APART + 0.1, [pit, crack])):
        asked = tuple((n, by, gain if n == crack else one) for n, by, one in tried)
        assert of_its_tooth(broken, asked) == others
    assert of_its_tooth(crack, ((crack, 8.6, 36.0), (broken, 21.2, 36.0 - APART))) == []
    assert of_its_tooth("cage_slip@bearing1", tried) == []
    assert of_its_tooth(broken, (*tried[:3], ("tooth_crack@gear", 8.6, None))) == [pit]


def test_a_second_that_is_a_fault_of_a_tooth_is_told_with_those_that_were_summed_only(
    simulated: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    setting, found = found_in(seen(SMALLER))
    real, (one,) = pair_in(seen(SMALLER)), sums(setting, found, RIGHT, 8)  # type: ignore[arg-type]
    assert real is not None and simulated
    summed_up = {"tooth_spall": 25.5, "missing_tooth": 21.2, "tooth_crack": 8.6}
    gains = {"tooth_spall@pinion": 19.2, "missing_tooth@pinion": 36.0}
    tried = [replace(one, name=f"{kind}@pinion", gain=gain) for kind, gain in summed_up.items()]
    monkeypatch.setattr(pairs, "sums", lambda *_: tried)
    made = {n: replace(real, gain=g, beside=replace(real.beside, names=(n,))) for n, g in gains.items()}
    monkeypatch.setattr(pairs, "fitted_pair", lambda _s, _f, _first, second, _m: made[second.name])
    told = best_pair(setting, found, EXPLAINED, 8, 2, map)  # type: ignore[arg-type]
    assert told is not None and told.best is not None
    assert told.best.others == ("missing_tooth@pinion", "tooth_spall@pinion", "tooth_crack@pinion")
