"""Machine and effect fitted together: what the right effect leaves shrinks, a wrong one stays wrong."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.atlas.candidates import Candidate, candidates, draw_term
from reconcile.judge.adequacy import rest_of
from reconcile.machine import assimilate
from reconcile.machine.assimilate import Task, assimilated, known_ensemble, moved, packed, settled, unpacked
from reconcile.machine.setting import Found
from sim import presets
from sim.core.spec import TermSpec
from sim.core.terms import Term
from sim.terms import REGISTRY
from tests.reconcile.judge.made import FEATURES
from tests.reconcile.machine.rubs import MADE, MEMBERS, RIGHT, WRONG, found_in


def tasks(setting: SimpleNamespace, found: Found, *names: str) -> list[Task]:
    """The whole change for each."""
    return [Task(name=n, view=found.lines(n), target=setting.changes.observed) for n in names]


@pytest.fixture
def observed(monkeypatch: pytest.MonkeyPatch) -> np.ndarray:
    """Of a machine that is none of the draws'; simulating again is asking the made world."""

    def again(_setting, candidate, offsets, terms, _mapper):  # type: ignore[no-untyped-def]
        return MADE.catalogue(candidate.label, [o.values for o in offsets], list(terms))

    monkeypatch.setattr(assimilate, "simulated_again", again)
    return MADE.change(RIGHT, np.array([0.06, -0.05, 0.03]), 2e7) + np.random.default_rng(8).normal(0, 1, FEATURES)


def test_the_right_effect_is_met_and_the_wrong_one_is_not(observed: np.ndarray) -> None:
    setting, before = found_in(observed)
    after = assimilated(setting, before, tasks(setting, before, RIGHT, WRONG), MEMBERS, 2, map)  # type: ignore[arg-type]
    assert before.fine is not None and after.fine is not None
    right, wrong = (rest_of(after.fine, observed, n) for n in (RIGHT, WRONG))
    assert right.kept > rest_of(before.fine, observed, RIGHT).kept + 0.05 and right.kept > 0.9
    assert before.screen.rest.rough and not after.screen.rest.rough
    assert right.unmet == 0.0 and wrong.kept < 0.3 and wrong.unmet > 1.0
    gain = after.screen.evidence - before.screen.evidence
    assert gain[0] > 0.0 and gain[0] > 2.0 * gain[1]
    true, start = np.array([0.06, -0.05, 0.03]), np.mean([o.values for o in setting.plan.offsets], axis=0)
    assert np.linalg.norm(after.led[RIGHT].values - true) < 0.6 * np.linalg.norm(start - true)
    last = after.known.terms[3 * MEMBERS : 4 * MEMBERS]
    assert {t.site for t in last} == {"gear"}
    assert np.median([abs(np.log(t.parameters["stiffness"] / 2e7)) for t in last]) < 0.5


def test_a_second_effect_is_fitted_to_what_the_first_leaves(observed: np.ndarray) -> None:
    other = MADE.change(WRONG, np.array([0.06, -0.05, 0.03]), 1e8)
    setting, before = found_in(observed + other)
    task = Task(name=RIGHT, view=before.lines(RIGHT), target=observed, second=True)
    after = assimilated(setting, before, [task], MEMBERS, 2, map)  # type: ignore[arg-type]
    assert before.fine is not None and after.fine is not None
    assert rest_of(after.fine, observed, RIGHT).kept > rest_of(before.fine, observed, RIGHT).kept + 0.05
    assert set(after.led) == {RIGHT}


def test_how_unusual_the_change_is_stays(observed: np.ndarray) -> None:
    setting, before = found_in(observed)
    after = assimilated(setting, before, tasks(setting, before, RIGHT), MEMBERS, 1, map)  # type: ignore[arg-type]
    for name in ("p_any", "p_best", "p_lines", "p_direct", "strongest"):
        assert getattr(after.screen, name) == getattr(before.screen, name)
    assert after.unled is before.known and len(after.known.terms) == 3 * MEMBERS


def test_without_single_lines_or_members_nothing_is_moved(observed: np.ndarray) -> None:
    setting, before = found_in(observed)
    families = replace(before.screen, by=np.zeros_like(before.screen.by))
    blind = replace(before, fine=None, screen=families)
    assert blind.views == (before.fitted,)
    assert assimilated(setting, blind, tasks(setting, blind, RIGHT), MEMBERS, 1, map) is blind  # type: ignore[arg-type]
    few = replace(before.known.library, groups={RIGHT: (0, 1, 2)})
    assert known_ensemble(setting, replace(before.known, library=few), RIGHT, MEMBERS) is None  # type: ignore[arg-type]


def test_what_is_far_behind_one_that_is_met_need_not_be_moved(observed: np.ndarray) -> None:
    setting, before = found_in(observed)
    after = assimilated(setting, before, tasks(setting, before, RIGHT), MEMBERS, 2, map)  # type: ignore[arg-type]
    assert settled(after, WRONG) and not settled(after, RIGHT) and not settled(before, RIGHT)


def test_members_move_within_the_bounds_of_numbers_and_parameters(observed: np.ndarray) -> None:
    setting, before = found_in(np.full(FEATURES, 500.0))
    one = known_ensemble(setting, before.known, RIGHT, MEMBERS)  # type: ignore[arg-type]
    assert one is not None and one.candidate == Candidate(term="rub", site="gear") and before.fine is not None
    led = moved(one, before.fine, np.full(FEATURES, 500.0), 1.0, np.random.default_rng(0))
    assert np.abs([o.values for o in led.offsets]).max() <= 0.16 + 1e-12
    assert all(0.0 <= t.parameters["stiffness"] <= 1e9 for t in led.terms)


def test_parameters_come_back_as_they_went() -> None:
    one = TermSpec(term="outer_spall", site="bearing1", parameters={"width": 1e-3, "depth": 1e-4, "angle": -1.2})
    values = packed(one)
    assert values[0] == pytest.approx(np.log(1e-3))
    back = unpacked(one, values)
    assert back.parameters == pytest.approx(one.parameters)
    far = unpacked(one, values + 50.0)
    assert far.parameters["width"] < 1.0


@pytest.mark.parametrize("term", list(REGISTRY), ids=lambda t: t.key)
def test_all_members_of_an_effect_have_the_same_parameters_to_move(term: Term) -> None:
    machine = presets.preset("paper-lightly-damped")
    for candidate in [c for c in candidates(machine) if c.term == term.key][:1]:
        rng = np.random.default_rng(3)
        terms = [draw_term(candidate, share, rng, machine) for share in (0.0, 0.3, 1.0)]
        again = [unpacked(t, packed(t) + rng.normal(0.0, 3.0, packed(t).size)) for t in terms]
        assert len({packed(t).size for t in (*terms, *again)}) == 1
        for one in again:
            known = {p.name: p for p in term.params}
            assert all(known[n].low <= v <= known[n].high for n, v in one.parameters.items())
