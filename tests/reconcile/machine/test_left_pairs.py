"""A second effect beside one that does not strike: named where both leave less than the first alone and any other."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.machine import asked as asked_of
from reconcile.machine import left_pairs
from reconcile.machine.asked import LEAST_GAIN
from reconcile.machine.causes import ranked_causes
from reconcile.machine.decide import Decision
from reconcile.machine.heldout import held_out, with_drawn
from reconcile.machine.left_pairs import best_left_pair
from reconcile.machine.library import joined
from reconcile.machine.pairs import Pair, Pairs, named_pair
from reconcile.machine.setting import Found
from reconcile.machine.told_by import HALF_HEARD
from sim.core.spec import TermSpec
from tests.reconcile.machine.rubs import FEATURES, MADE, RIGHT, WRONG, Asked, asked_of_the_made, found_in
from tests.reconcile.machine.test_leftover import TRUE, seen

EXPLAINED = Decision(word="explained", chosen=(RIGHT,), p=1e-6, reasons=())
SMALLER, THIRD = 5e6, "rub@wheel"


@pytest.fixture
def simulated(monkeypatch: pytest.MonkeyPatch) -> Asked:
    """Simulating is asking the made world, in which one operating point stands for several; what was asked for."""
    monkeypatch.setattr(left_pairs, "at_one_point", lambda _: False)
    return asked_of_the_made(monkeypatch, THIRD)


def pairs_in(observed: np.ndarray, decision: Decision = EXPLAINED, most: int = 2) -> Pairs | None:
    setting, found = found_in(observed)
    return best_left_pair(setting, found, decision, found.known, 8, most, map)  # type: ignore[arg-type]


def test_a_second_is_named_and_a_single_effect_gets_none(simulated: Asked) -> None:
    told = pairs_in(seen(SMALLER))
    assert told is not None and told.best is not None
    best = told.best
    assert (best.first, best.beside.names, best.others) == (RIGHT, (WRONG,), ()) and best.gain > LEAST_GAIN
    assert told.tried[0][0] == WRONG and told.tried[0][2] == best.gain
    together = best.beside.together
    assert together is not None and abs(np.log(together.severity.value / SMALLER)) < 0.9
    assert together.own is not None and abs(np.log(together.own.value / 2e7)) < 0.5, "and the first's size beside it"
    first = ranked_causes(found_in(seen(SMALLER))[1], EXPLAINED, {RIGHT: 0.9, WRONG: 0.1}, seen(SMALLER), best.beside)
    alone = ranked_causes(found_in(seen(SMALLER))[1], EXPLAINED, {RIGHT: 0.9, WRONG: 0.1}, seen(SMALLER), None)[0]
    size, own = first[0].severity, alone.severity
    assert size is not None and own is not None and first[1].severity == together.severity
    assert size.value == pytest.approx(np.sqrt(own.value * together.own.value)), "between both"
    assert (size.low, size.high) == (min(own.low, together.own.low), max(own.high, together.own.high))
    assert {t.site for t in together.terms[0]} == {"gear", "pinion"}
    decision, beside = named_pair(EXPLAINED, None, told)
    assert decision.chosen == (RIGHT,) and beside is best.beside
    simulated.clear()
    alone = pairs_in(seen())
    assert alone is not None and alone.best is None and simulated == [], "nothing adds enough to be worth simulating"
    for word in ("nothing_missing", "unknown_physics"):
        assert pairs_in(seen(SMALLER), replace(EXPLAINED, word=word)) is None


def test_forecasts_are_of_machines_that_were_not_led_to_the_observation(simulated: Asked) -> None:
    observed = seen(SMALLER)
    setting, found = found_in(observed)
    led = MADE.catalogue(RIGHT, [TRUE] * 8, [TermSpec(term="rub", site="gear", parameters={"stiffness": 2e7})] * 8)
    found = replace(found, before=found.known, known=joined(found.known, led))
    told = best_left_pair(setting, found, EXPLAINED, found.unled, 8, 2, map)  # type: ignore[arg-type]
    assert told is not None and told.best is not None and told.best.drawn is not None
    assert [label for label, _, _ in simulated] == [f"{RIGHT}+pinion", f"{RIGHT}+nothing", f"{RIGHT}+pinion"]
    fitted, _, drawn = simulated
    own = {tuple(o.values) for o in setting.plan.offsets}
    assert {tuple(o) for o in drawn[1]} <= own and not {tuple(o) for o in fitted[1]} <= own
    assert tuple(TRUE) not in {tuple(o) for o in drawn[1]}, "nor are draws that an effect alone was led by"
    given = {"spectral": np.ones(FEATURES, dtype=bool), "frequency": np.linspace(10.0, 1e3, FEATURES), "seed": 1}
    both = held_out(setting.changes, found.unled, RIGHT, beside=WRONG, drawn=told.best.drawn, **given)  # type: ignore[arg-type]
    alone = held_out(setting.changes, found.unled, RIGHT, **given)  # type: ignore[arg-type]
    assert both.gain > alone.gain + 0.1 and both.effects == (RIGHT, WRONG)
    rows = with_drawn(found.unled, RIGHT, told.best.drawn).library
    assert np.array_equal(rows.changes[list(rows.groups[RIGHT])], told.best.drawn)
    assert with_drawn(found.known, RIGHT, None) is found.known


def test_no_pair_where_the_machines_of_its_forecast_do_not_run(
    simulated: Asked, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(left_pairs, "_drawn", lambda *_, **__: None)
    told = pairs_in(seen(SMALLER))
    assert told is not None and told.best is None and simulated


def test_what_the_first_gains_by_being_moved_once_more_is_not_the_seconds(
    simulated: Asked, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = pairs_in(seen(SMALLER))
    made = left_pairs.led_again
    exact = MADE.change(RIGHT, TRUE, 2e7)

    def again(asked, start, second):  # type: ignore[no-untyped-def]
        found = made(asked, start, second)
        if second:
            return found
        library = replace(found.known.library, changes=np.repeat(exact[None], len(found.known.terms), axis=0))
        return replace(found, known=replace(found.known, library=library))

    monkeypatch.setattr(left_pairs, "led_again", again)
    less = pairs_in(seen(SMALLER))
    assert whole is not None and less is not None and simulated
    assert whole.tried[0][2] is not None and less.tried[0][2] is not None
    assert less.tried[0][2] < whole.tried[0][2] - 0.3


@pytest.mark.parametrize(("gain", "stands"), [(LEAST_GAIN - 0.1, False), (LEAST_GAIN + 0.1, True)])
def test_a_second_must_add_enough(gain: float, stands: bool, simulated: Asked, monkeypatch: pytest.MonkeyPatch) -> None:
    fitted = left_pairs._fitted

    def so_much(asked, name, rows):  # type: ignore[no-untyped-def]
        return replace(fitted(asked, name, rows), gain=gain)

    monkeypatch.setattr(left_pairs, "_fitted", so_much)
    monkeypatch.setattr(left_pairs, "_fairly", lambda _, made: made)
    monkeypatch.setattr(left_pairs, "_searched", lambda *_: {})
    told = pairs_in(seen(SMALLER))
    assert told is not None and (told.best is not None) == stands and simulated


def test_what_a_driving_first_makes_rattle_is_searched_and_must_beat_the_others(
    simulated: Asked, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[tuple[tuple[int, ...], float]] = []
    made, real = left_pairs._fitted, left_pairs._pair

    def searched(_asked, _start, rows, beat=0.0):  # type: ignore[no-untyped-def]
        asked.append((rows, beat))
        return None if len(rows) == 1 else "machines"

    def pair(asked, name, machines):  # type: ignore[no-untyped-def]
        if machines != "machines":
            return real(asked, name, machines)
        found = made(asked, WRONG, list(asked.every.library.groups[WRONG]))
        assert found is not None
        return replace(found, beside=replace(found.beside, names=(name,)), gain=10.0 * LEAST_GAIN)

    monkeypatch.setattr(left_pairs, "searched", searched)
    monkeypatch.setattr(left_pairs, "_pair", pair)
    monkeypatch.setattr(left_pairs, "_fitted", alike(WRONG))
    monkeypatch.setattr(left_pairs, "_drawn", lambda *_: np.zeros((1, FEATURES)))
    monkeypatch.setattr(left_pairs, "interplaying", lambda *_: {THIRD: (0, 1), "rub@shaft": (2,)})
    told = pairs_in(seen(SMALLER))
    assert told is not None and told.best is not None and told.best.beside.names == (THIRD,) and simulated
    assert [rows for rows, _ in asked] == [(0, 1), (2,)]
    assert {beat for _, beat in asked} == {max(b for _, b in asked)} and asked[0][1] > LEAST_GAIN, "what WRONG adds"
    asked.clear()
    monkeypatch.setattr(left_pairs, "rattles", lambda name: name == WRONG)
    told = pairs_in(seen(SMALLER))
    assert told is not None and told.best is not None and told.best.beside.names == (WRONG,) and asked == []


def test_of_an_open_set_both_must_leave_what_known_effects_do(
    simulated: Asked, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(left_pairs, "inadequate", lambda _: True)
    open_set = replace(EXPLAINED, word="ambiguous", chosen=(RIGHT, WRONG))
    for decision, stands in ((open_set, False), (EXPLAINED, True)):
        told = pairs_in(seen(SMALLER), decision)
        assert told is not None and (told.best is not None) == stands and simulated


def test_a_second_of_the_set_itself_is_no_other_first(simulated: Asked) -> None:
    told = pairs_in(seen(SMALLER), replace(EXPLAINED, word="ambiguous", chosen=(RIGHT, WRONG)))
    assert told is not None and told.best is not None and simulated


def alike(second: str, behind: float = left_pairs.LEAD + 1.0) -> Callable[..., Pair]:
    """Whatever is fitted is the right second, called so, and enough; all others are as far behind."""
    made = left_pairs._fitted

    def one(asked, name, rows):  # type: ignore[no-untyped-def]
        right = made(asked, second, list(asked.every.library.groups[second]))
        assert right is not None
        gain = right.gain + LEAST_GAIN - (0.0 if name == second else behind)
        return replace(right, beside=replace(right.beside, names=(name,)), gain=gain)

    return one


def test_a_rival_close_by_is_told_beside_it(simulated: Asked, monkeypatch: pytest.MonkeyPatch) -> None:
    setting, found = found_in(seen(SMALLER))
    library = found.known.library
    groups = {**library.groups, "unbalance@pinion": library.groups[WRONG]}
    atlas = replace(found.known, library=replace(library, groups=groups))
    for lead, others in ((left_pairs.LEAD + 1.0, ()), (1.0, (WRONG, "unbalance@pinion"))):
        with monkeypatch.context() as patched:
            patched.setattr(left_pairs, "_fitted", alike(WRONG, lead))
            told = best_left_pair(setting, found, EXPLAINED, atlas, 8, 2, map)  # type: ignore[arg-type]
        assert told is not None and told.best is not None and told.best.others == others
        assert (told.best.drawn is None) == bool(others), "nothing is forecast for what is not named"
    assert simulated


def test_a_second_that_is_a_fault_of_a_tooth_is_told_with_the_others(
    simulated: Asked, monkeypatch: pytest.MonkeyPatch
) -> None:
    """m038 of the proof: a broken tooth beside a loose fit, 16 ahead of a pit as log evidence; the crack was summed."""
    heard: list[tuple[str, float | None]] = []

    def of_its_tooth(second: str, tried: Sequence[tuple[str, float, float | None]]) -> list[str]:
        heard.extend((name, made) for name, _, made in tried)
        assert second == WRONG
        return [THIRD]

    monkeypatch.setattr(left_pairs, "of_its_tooth", of_its_tooth)
    told = pairs_in(seen(SMALLER))
    assert simulated and told is not None and told.best is not None and told.best.others == (WRONG, THIRD)
    assert heard[0] == (WRONG, told.best.gain / asked_of.TEMPER), "as log evidence"


def with_third(found: Found, change: np.ndarray) -> Found:
    """Four draws of another effect that all show this change."""
    third = MADE.catalogue(RIGHT, [TRUE] * 4, [TermSpec(term="rub", site="wheel", parameters={"stiffness": 2e7})] * 4)
    library = replace(third.library, changes=np.repeat(change[None], 4, axis=0), groups={THIRD: (0, 1, 2, 3)})
    return replace(found, known=joined(found.known, replace(third, library=library)))


def test_no_pair_where_another_effect_alone_or_another_first_does_as_well(
    simulated: Asked, monkeypatch: pytest.MonkeyPatch
) -> None:
    observed = seen(SMALLER)
    setting, found = found_in(observed)
    told = best_left_pair(setting, with_third(found, observed), EXPLAINED, found.known, 8, 2, map)  # type: ignore[arg-type]
    assert told is not None and told.best is None, "one effect is enough"
    rivals = replace(EXPLAINED, word="ambiguous", chosen=(RIGHT, THIRD))
    twin = with_third(found, MADE.change(RIGHT, TRUE, 2e7))
    told = best_left_pair(setting, twin, rivals, found.known, 8, 2, map)  # type: ignore[arg-type]
    assert told is not None and told.best is not None, "simulated, the other first does not do"
    for made in (MADE.patterns, MADE.turns):
        monkeypatch.setitem(made, THIRD, made[RIGHT])
    told = best_left_pair(setting, twin, rivals, found.known, 8, 2, map)  # type: ignore[arg-type]
    assert told is not None and told.best is None, "what is first is open"
    assert simulated[-1][0] == f"{THIRD}+pinion"
    told = best_left_pair(setting, twin, EXPLAINED, found.known, 8, 2, map)  # type: ignore[arg-type]
    assert told is not None and told.best is not None and simulated


def test_what_adds_as_much_by_sums_and_was_not_simulated_is_told_too(simulated: Asked) -> None:
    setting, found = found_in(seen(SMALLER))
    twin = with_third(found, MADE.change(WRONG, TRUE, SMALLER))
    for most, others in ((3, ()), (1, (WRONG, THIRD))):
        with pytest.MonkeyPatch.context() as patched:
            patched.setattr(left_pairs, "LEAST_ASKED", 1)
            patched.setattr(asked_of, "LEAST_GAIN", 12.0)
            patched.setattr(left_pairs, "_alone", lambda *_: -np.inf)
            patched.setattr(left_pairs, "_fitted", alike(WRONG))
            told = best_left_pair(setting, twin, EXPLAINED, found.known, 8, most, map)  # type: ignore[arg-type]
        assert told is not None and told.best is not None
        assert set(told.best.others) == set(others)
    assert simulated


def test_what_would_strike_is_asked_only_if_it_is_heard(monkeypatch: pytest.MonkeyPatch) -> None:
    setting, found = found_in(seen(SMALLER))
    monkeypatch.setattr(left_pairs, "strikes", lambda name: name == WRONG)
    for evidence, there in (({}, False), ({WRONG: HALF_HEARD - 0.1}, False), ({WRONG: HALF_HEARD}, True)):
        setting.direct.evidence = evidence
        assert left_pairs._possible(setting, found.known, RIGHT) == [WRONG] * there  # type: ignore[arg-type]


def test_without_single_lines_nothing_is_looked_for(simulated: Asked) -> None:
    setting, found = found_in(seen(SMALLER))
    blind = replace(found, fine=None)
    assert best_left_pair(setting, blind, EXPLAINED, found.known, 8, 2, map) is None and simulated == []  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("teeth", "gain", "told"), [(True, 84.0, False), (True, 86.0, True), (False, 20.0, True), (True, None, False)]
)
def test_a_bow_is_told_with_an_unbalance_where_nothing_tells_them_apart(
    teeth: bool, gain: float | None, told: bool
) -> None:
    setting, _ = found_in(seen(SMALLER))
    setting.machine.gears = ("gear",) * teeth
    asked = SimpleNamespace(setting=setting, first="radial_clearance@bearing1")
    best, bow = (SimpleNamespace(beside=SimpleNamespace(names=(f"{n}@disc",))) for n in ("unbalance", "bent_shaft"))
    best.gain, bow.gain = 100.0, gain
    sums = {"bent_shaft@disc": 40.0, "unbalance@disc": 60.0, "bent_shaft@gear": 45.0}
    near = left_pairs._rivals(asked, best, [bow] if gain else [], sums)  # type: ignore[arg-type]
    assert near == ["bent_shaft@disc"] * told


@pytest.mark.parametrize(("first", "told"), [("fit_clearance@bearing2", True), ("unbalance@gear", False)])
def test_beside_a_play_a_second_must_lead_by_more(first: str, told: bool) -> None:
    setting, _ = found_in(seen(SMALLER))
    setting.machine.gears = ("gear",)
    names = ("shaft_crack@bearing3", "outer_waviness@bearing2", "shaft_crack@bearing4")
    best, waves, other = (SimpleNamespace(beside=SimpleNamespace(names=(n,))) for n in names)
    best.gain, waves.gain, other.gain = 36.0, 27.6, 22.7
    sums = dict(zip(names, (5.9, 9.5, 11.5), strict=True))
    asked = SimpleNamespace(setting=setting, first=first)
    near = left_pairs._rivals(asked, best, [waves, other], sums)  # type: ignore[arg-type]
    assert near == [names[1]] * told


def test_half_of_an_ensemble_starts_where_sums_fit_best() -> None:
    setting, found = found_in(seen(SMALLER))
    asked = left_pairs._asked(setting, found, RIGHT, found.known, found.fine, 8, map)  # type: ignore[arg-type]
    ((_, _, rows),) = left_pairs.ranked_seconds(asked.left, setting.changes, asked.every, [WRONG])
    start = left_pairs.start_of(asked, rows, WRONG)
    alone = left_pairs.start_of(asked, (), "")
    assert start.terms[:4] == alone.terms[:4] and alone.also == () and len(start.also) == 8
    own = [k for k in asked.every.library.groups[RIGHT] if k >= asked.local]
    every = asked.every.library.changes
    told = [asked.left.likelihood(setting.changes.both(every[[a]], every[list(rows[:3])])).max() for a in own]
    best = np.sort(told)[::-1][:4]
    assert asked.left.likelihood(start.changes[4:]) == pytest.approx(best), "the likeliest sums, every first once"
    assert len({id(t) for t in start.terms[4:]}) == 4
