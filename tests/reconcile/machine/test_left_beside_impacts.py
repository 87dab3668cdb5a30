"""A second effect beside one that strikes: the teeth's own lines tell, whatever the forest of the impacts leaves."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.machine import asked as asked_of
from reconcile.machine import left_pairs, left_start
from reconcile.machine.asked import BESIDE_PIT
from reconcile.machine.causes import ranked_causes
from reconcile.machine.decide import STRUCK, Decision
from reconcile.machine.left_pairs import LEAD, best_left_pair
from reconcile.machine.pairs import Pair, Pairs
from reconcile.machine.setting import Found
from reconcile.machine.told_by import own_lines, teeth_tell
from reconcile.machine.weigh import LEAST_EVIDENCE
from tests.reconcile.machine.rubs import FEATURES, RIGHT, WRONG, Asked, asked_of_the_made, found_in
from tests.reconcile.machine.test_left_pairs import with_third
from tests.reconcile.machine.test_leftover import seen

EXPLAINED = Decision(word="explained", chosen=(RIGHT,), p=1e-6, reasons=())
SMALLER = 5e6
THIRD = "rub@wheel"
OWN = np.arange(FEATURES) >= 28
"""The teeth's lines: two that the first moves, and all of the second's."""
FOREST = np.where(OWN, 0.0, np.random.default_rng(3).choice([-12.0, 12.0], FEATURES))
"""What the form of an impact's law leaves of the other lines."""


@pytest.fixture
def simulated(monkeypatch: pytest.MonkeyPatch) -> Asked:
    """The rub at the gear stands for a pit."""
    for module in (left_pairs, asked_of):
        monkeypatch.setattr(module, "strikes", lambda name: name == RIGHT)
    monkeypatch.setattr(left_pairs, "teeth_tell", lambda *_: True)
    return asked_of_the_made(monkeypatch, THIRD)


def struck(observed: np.ndarray) -> tuple[SimpleNamespace, Found]:
    setting, found = found_in(observed)
    single = replace(setting.changes.single, chosen=OWN)
    setting.changes = replace(setting.changes, single=single)
    return setting, found


def pairs_in(observed: np.ndarray, decision: Decision = EXPLAINED) -> Pairs | None:
    """A third effect of the atlas shows just the forest."""
    setting, found = struck(observed)
    atlas = with_third(found, FOREST).known
    return best_left_pair(setting, found, decision, atlas, 8, 2, map)  # type: ignore[arg-type]


def test_the_forest_that_impacts_leave_neither_makes_nor_hides_a_second(simulated: Asked) -> None:
    both = pairs_in(seen(SMALLER) + FOREST)
    assert both is not None and both.best is not None
    assert (both.best.first, both.best.beside.names, both.best.others) == (RIGHT, (WRONG,), ())
    assert both.best.gain > BESIDE_PIT
    simulated.clear()
    alone = pairs_in(seen() + FOREST)
    assert alone is not None and alone.best is None and simulated == []


def test_only_the_teeths_own_lines_are_asked(simulated: Asked) -> None:
    setting, found = struck(seen(SMALLER))
    left = left_pairs._left(setting, found, RIGHT)  # type: ignore[arg-type]
    assert np.array_equal(left.used, OWN) and not left.quiet[~OWN].any() and simulated == []
    assert np.array_equal(own_lines(setting), OWN)  # type: ignore[arg-type]
    setting.changes = replace(setting.changes, phased=(setting.changes.sides, setting.changes.single))
    assert np.array_equal(own_lines(setting), setting.changes.sides.chosen), "with their phases where there are any"  # type: ignore[arg-type]
    assert left_pairs._left(setting, found, WRONG).used.all(), "what does not strike is seen by all"  # type: ignore[arg-type]


def test_the_first_keeps_its_size(simulated: Asked) -> None:
    observed = seen(SMALLER)
    told = pairs_in(observed)
    assert told is not None and told.best is not None and simulated
    together = told.best.beside.together
    assert together is not None and together.own is None
    sizes = [
        ranked_causes(struck(observed)[1], EXPLAINED, {RIGHT: 0.9, WRONG: 0.1}, observed, beside)[0].severity
        for beside in (told.best.beside, None)
    ]
    assert sizes[0] == sizes[1] is not None


def test_machines_start_where_the_first_was_nearest(simulated: Asked) -> None:
    setting, found = struck(seen(SMALLER))
    asked = left_pairs._asked(setting, found, RIGHT, found.known, found.fine, 8, map)  # type: ignore[arg-type]
    ((_, _, rows),) = left_pairs.ranked_seconds(asked.left, setting.changes, asked.every, [WRONG])
    start = left_pairs.start_of(asked, rows, WRONG)
    assert start.terms == left_pairs.start_of(asked, (), "").terms and len(start.also) == 8 and simulated == []


@pytest.mark.parametrize(
    ("gain", "behind", "stands", "others"),
    [
        (BESIDE_PIT - 0.1, 20.0, False, 0),
        (BESIDE_PIT + 0.1, LEAD + 0.1, True, 0),
        (BESIDE_PIT + 0.1, LEAD - 0.1, True, 2),
    ],
)
def test_how_much_it_must_add_and_lead(
    gain: float, behind: float, stands: bool, others: int, simulated: Asked, monkeypatch: pytest.MonkeyPatch
) -> None:
    fitted = left_pairs._fitted

    def so_much(asked, name, rows):  # type: ignore[no-untyped-def]
        made = fitted(asked, WRONG, list(asked.every.library.groups[WRONG]))
        beside = replace(made.beside, names=(name,))
        return replace(made, beside=beside, gain=gain if name == WRONG else gain - behind)

    monkeypatch.setattr(left_pairs, "_fitted", so_much)
    monkeypatch.setattr(left_pairs, "_fairly", lambda _, made: made)
    setting, found = struck(seen(SMALLER))
    library = found.known.library
    groups = {**library.groups, "unbalance@pinion": library.groups[WRONG]}
    atlas = replace(found.known, library=replace(library, groups=groups))
    told = best_left_pair(setting, found, EXPLAINED, atlas, 8, 2, map)  # type: ignore[arg-type]
    assert told is not None and (told.best is not None) == stands and simulated
    assert told.best is None or len(told.best.others) == others


@pytest.mark.parametrize(("lead", "named"), [(LEAST_EVIDENCE - 0.1, False), (LEAST_EVIDENCE + 0.1, True)])
def test_which_part_is_struck_must_be_decided_by_impacts_and_families(
    lead: float, named: bool, simulated: Asked, monkeypatch: pytest.MonkeyPatch
) -> None:
    setting, found = struck(seen(SMALLER))
    names = (RIGHT, WRONG, THIRD)
    direct, families = np.array([11.0, 0.0, 12.0 - lead]), np.array([9.0, 30.0, 8.0])
    screen = replace(found.screen, names=names, direct=direct, evidence=np.array([0.0, 0.0, 99.0]))
    monkeypatch.setattr(left_pairs, "looked", lambda *_: SimpleNamespace(evidence=families))
    rivals = replace(EXPLAINED, word="ambiguous", chosen=(RIGHT, THIRD))
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(left_pairs, "inadequate", lambda _: False)
        told = best_left_pair(setting, replace(found, screen=screen), rivals, found.known, 8, 2, map)  # type: ignore[arg-type]
    assert told is not None and (told.best is not None) == named and simulated


@pytest.mark.parametrize(("leaves", "named"), [(True, False), (False, True)])
def test_of_an_open_set_both_must_leave_what_known_ones_do(
    leaves: bool, named: bool, simulated: Asked, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(left_pairs, "inadequate", lambda _: leaves)
    told = pairs_in(seen(SMALLER), replace(EXPLAINED, word="ambiguous"))
    assert told is not None and (told.best is not None) == named and simulated


@pytest.mark.parametrize(
    ("first", "gears", "direct", "tell"),
    [
        ("outer_spall@bearing1", 2, STRUCK, True),
        ("ball_spall@bearing1", 2, STRUCK + 1, True),
        ("outer_spall@bearing1", 2, STRUCK - 0.1, False),
        ("outer_spall@bearing1", 0, STRUCK, False),
        ("tooth_crack@pinion", 2, STRUCK, False),
    ],
)
def test_teeth_tell_beside_a_pit_whose_impacts_are_sure(first: str, gears: int, direct: float, tell: bool) -> None:
    screen = SimpleNamespace(names=("rub@gear", first), direct=np.array([0.0, direct]))
    setting = SimpleNamespace(machine=SimpleNamespace(gears=("gear",) * gears))
    assert teeth_tell(setting, SimpleNamespace(screen=screen), first) is tell  # type: ignore[arg-type]


def test_else_nothing_is_looked_for_nor_in_what_no_effect_explains(
    simulated: Asked, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert pairs_in(seen(SMALLER), replace(EXPLAINED, word="unknown_physics")) is None
    monkeypatch.setattr(left_pairs, "teeth_tell", lambda *_: False)
    assert pairs_in(seen(SMALLER)) is None and simulated == []


def test_machines_are_led_by_the_teeths_own_lines_and_the_first_keeps_its_parameters(
    simulated: Asked, monkeypatch: pytest.MonkeyPatch
) -> None:
    setting, found = struck(seen(SMALLER))
    found = replace(found, sides=found.fitted)
    made, views = left_start.moved, []

    def moved(start, view, *rest):  # type: ignore[no-untyped-def]
        views.append((view, start.terms))
        return made(start, view, *rest)

    for module in (left_pairs, left_start):
        monkeypatch.setattr(module, "moved", moved, raising=False)
    monkeypatch.setattr(left_pairs, "pair_of", lambda *given: given)
    asked = left_pairs._asked(setting, found, RIGHT, found.known, left_pairs._lines(setting, found, EXPLAINED), 8, map)  # type: ignore[arg-type]
    ((_, _, rows),) = left_pairs.ranked_seconds(asked.left, setting.changes, asked.every, [WRONG])
    led = left_pairs.led_again(asked, left_pairs.start_of(asked, rows, WRONG), WRONG)
    assert led is not None and views[0][0] is found.fine
    assert (
        tuple(led.known.terms) == views[0][1] and led.also != left_pairs.start_of(asked, rows, WRONG).also and simulated
    )


def test_what_the_first_gains_by_being_moved_once_more_counts_from_the_limit_on(
    simulated: Asked, monkeypatch: pytest.MonkeyPatch
) -> None:
    setting, found = struck(seen(SMALLER))
    asked = left_pairs._asked(setting, found, RIGHT, found.known, found.fine, 8, map)  # type: ignore[arg-type]
    base = asked.left.base
    again = SimpleNamespace(known=SimpleNamespace(library=SimpleNamespace(changes=asked.left.members)))
    monkeypatch.setattr(left_pairs, "led_again", lambda *_: again)
    monkeypatch.setattr(type(asked.left), "base", base)
    monkeypatch.setattr(type(asked.left), "level", lambda *_: base + 3.0)
    for gain, left in ((BESIDE_PIT - 0.1, BESIDE_PIT - 0.1), (BESIDE_PIT + 0.1, BESIDE_PIT - 2.9)):
        pair = Pair(first=RIGHT, beside=None, gain=gain, rest=None, parts=(gain,))  # type: ignore[arg-type]
        told = left_pairs._fairly(asked, {WRONG: pair})[WRONG]
        assert told is not None and told.gain == pytest.approx(left)


def test_what_would_strike_too_is_not_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    setting, found = struck(seen(SMALLER))
    setting.direct.evidence = {WRONG: 20.0}
    for module in (left_pairs, asked_of):
        monkeypatch.setattr(module, "strikes", lambda _: True)
    assert left_pairs._possible(setting, found.known, RIGHT) == []  # type: ignore[arg-type]
