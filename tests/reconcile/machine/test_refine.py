"""Effects simulated again: near their best draws, and over the sizes where most draws hide the effect."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.atlas.candidates import size_parameter, size_range
from reconcile.atlas.plan import AtlasPlan
from reconcile.calibrate.uncertain import Offsets
from reconcile.machine import refine, search
from reconcile.machine.refine import (
    LARGER,
    NEAR,
    NEAR_ANGLE_RAD,
    NEAR_SIZE,
    NEAR_UNSTATED,
    SMALLER,
    near_draws,
    refined_plan,
    spread_plan,
)
from reconcile.machine.search import MOSTLY_SEEN, SPREAD, spread_out
from sim.core.spec import TermSpec
from sim.presets import preset
from sim.terms import REGISTRY

PIT, RACE = "outer_spall@bearing1", "inner_spall@bearing1"
LOOSE = "pedestal_looseness@bearing1"
TERM = REGISTRY.get("outer_spall")
assert TERM is not None
SIZE = size_parameter(TERM)


def pit(width_m: float, angle: float = -1.8) -> TermSpec:
    return TermSpec(term="outer_spall", site="bearing1", parameters={"width": width_m, "depth": 5e-5, "angle": angle})


@pytest.fixture(scope="module")
def plan() -> AtlasPlan:
    rest = tuple(Offsets(values=np.zeros(1)) for _ in range(8))
    return AtlasPlan(machine=preset("paper"), numbers=(), offsets=rest, twins=rest, draws=(), seed=3)


def test_leaders_come_first_and_further_draws_stand_about_them() -> None:
    leaders = [pit(5e-4), pit(8e-4)]
    drawn = near_draws(leaders, 6, np.random.default_rng(2))
    assert drawn[:2] == leaders and len(drawn) == 6 and near_draws(leaders, 1, np.random.default_rng(2)) == leaders[:1]
    for k, term in enumerate(drawn[2:]):
        ratio = term.parameters["width"] / leaders[k % 2].parameters["width"]
        assert ratio != 1.0 and 0.2 < ratio < 5.0


def test_what_nobody_measured_goes_farther_than_what_is_known() -> None:
    fit = {"gap": 1e-5, "damping": 2e4, "friction": 0.1, "length": 15.0, "friction_speed": 1e-2, "housing_mass": 0.02}
    ring = TermSpec(term="fit_clearance_series", site="bearing1", parameters=fit)
    drawn = near_draws([ring], 200, np.random.default_rng(2))[1:]
    apart = {n: float(np.std([np.log(t.parameters[n] / fit[n]) for t in drawn])) for n in fit}
    assert apart["friction"] == pytest.approx(NEAR, rel=0.2) and apart["length"] == pytest.approx(NEAR, rel=0.2)
    for name in ("damping", "friction_speed", "housing_mass"):
        assert apart[name] == pytest.approx(NEAR_UNSTATED, rel=0.2)
    assert apart["gap"] == pytest.approx(NEAR_SIZE, rel=0.2)


def test_sizes_are_spread_about_the_best_and_the_rest_stays_near(plan: AtlasPlan) -> None:
    around = [(PIT, [pit(5e-4), pit(8e-4)])]
    spread = spread_plan(plan, around, draws=6, pairs=8, seed=1)
    terms = [d.term for d in spread.draws if d.term is not None]
    widths = np.array([t.parameters["width"] for t in terms])
    middle = np.sqrt(5e-4 * 8e-4)
    low, high = max(middle / SMALLER, size_range(SIZE)[0]), min(middle * LARGER, size_range(SIZE)[1])
    assert np.allclose(widths, np.geomspace(low, high, 13)[1::2])
    assert {d.candidate.label for d in spread.draws if d.candidate} == {PIT} and len(terms) == 6
    assert all(abs(t.parameters["angle"] + 1.8) < 4 * NEAR_ANGLE_RAD for t in terms)
    assert len({t.parameters["angle"] for t in terms}) == 6
    assert len({d.pair for d in spread.draws}) == 6 and spread.offsets == plan.offsets and spread.seed != plan.seed
    assert spread_plan(plan, around, draws=6, pairs=8, seed=1) == spread


@pytest.mark.parametrize("width", [SIZE.low, SIZE.high])
def test_sizes_stay_within_what_is_sought(plan: AtlasPlan, width: float) -> None:
    spread = spread_plan(plan, [(PIT, [pit(width)])], draws=6, pairs=8, seed=1)
    widths = [d.term.parameters["width"] for d in spread.draws if d.term is not None]
    low, high = size_range(SIZE)
    assert low <= min(widths) < max(widths) <= high


def test_a_pit_that_the_machine_has_is_spread_from_its_size_on(plan: AtlasPlan) -> None:
    own = replace(plan, machine=plan.machine.model_copy(update={"terms": [pit(1e-3)]}))
    spread = spread_plan(own, [(PIT, [pit(1.2e-3)])], draws=6, pairs=8, seed=1)
    widths = [d.term.parameters["width"] for d in spread.draws if d.term is not None]
    assert min(widths) > 1e-3 and max(widths) > 4e-3


def test_near_the_best_means_near_in_size_too(plan: AtlasPlan) -> None:
    near = refined_plan(plan, [(PIT, [pit(5e-4)])], draws=8, pairs=8, seed=1)
    widths = np.array([d.term.parameters["width"] for d in near.draws if d.term is not None])
    assert widths.size == 8 and 0.05 < np.std(np.log(widths)) < 0.8 and np.all(np.abs(np.log(widths / 5e-4)) < 1.5)


Shown = list[Sequence[str]]


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> Shown:
    """Which effects were spread, and how often."""
    shown: Shown = []

    def planned(_plan: object, around: Sequence[tuple[str, Sequence[TermSpec]]], *, draws: int, **_: object) -> str:
        shown.append([name for name, _ in around])
        assert draws == SPREAD
        assert [t.parameters["width"] for t in around[0][1]] == pytest.approx([4e-4, 3e-4]), "draws that show something"
        return "plan"

    monkeypatch.setattr(search, "spread_plan", planned)
    monkeypatch.setattr(refine, "best_draws", lambda _, known, *__, count: known.terms[7::-1][:count])
    monkeypatch.setattr(search, "simulated", lambda _, plan, *__: f"simulated {plan}")
    monkeypatch.setattr(search, "fit_views", lambda _, known: f"judged {known}")
    return shown


def found_with(shares: dict[str, float]) -> SimpleNamespace:
    """Eight draws of each effect, so large a share of them seen."""
    groups = {name: tuple(range(8 * k, 8 * k + 8)) for k, name in enumerate(shares)}
    visible = np.concatenate([np.arange(8) < round(8 * share) for share in shares.values()])
    known = SimpleNamespace(library=SimpleNamespace(groups=groups), terms=[pit(1e-4 * k) for k in range(1, 25)])
    return SimpleNamespace(fitted=SimpleNamespace(visible=visible), known=known, view=lambda _: None)


def test_only_what_strikes_and_most_draws_hide_is_spread(asked: Shown) -> None:
    setting = SimpleNamespace(
        plan=SimpleNamespace(offsets=(0,) * 8), seed=0, changes=SimpleNamespace(observed=np.zeros(3))
    )
    hidden = found_with({PIT: 0.5, RACE: MOSTLY_SEEN, LOOSE: 0.25})
    told = spread_out(setting, hidden, [PIT, RACE, LOOSE], map)  # type: ignore[arg-type]
    assert asked == [[PIT]] and told == "judged simulated plan"
    asked.clear()
    seen = found_with({PIT: 1.0, LOOSE: 0.25})
    assert spread_out(setting, seen, [PIT, LOOSE], map) is seen and asked == []  # type: ignore[arg-type]
    assert spread_out(setting, hidden, [RACE, LOOSE], map) is hidden and asked == [], "nor what does not lead"  # type: ignore[arg-type]
    silent = found_with({PIT: 0.0})
    assert spread_out(setting, silent, [PIT], map) is silent and asked == [], "nor about draws that show nothing"  # type: ignore[arg-type]


@pytest.mark.parametrize(("turn", "spread"), [(0, [[PIT]]), (1, [])])
def test_leaders_are_spread_before_they_are_refined_once(
    turn: int, spread: list[list[str]], monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[list[str]] = []

    def spread_out(_setting: object, found: object, leading: list[str], _mapper: object) -> object:
        asked.append(leading)
        return found

    for name in ("looks_for_second", "struck_too", "beside"):
        monkeypatch.setattr(search, name, lambda *_: None)
    monkeypatch.setattr(search, "spread_out", spread_out)
    monkeypatch.setattr(search, "leaders", lambda *_: [PIT])
    monkeypatch.setattr(search, "draws_around", lambda *_: [pit(5e-4)])
    monkeypatch.setattr(search, "refined_plan", lambda _, around, **__: [name for name, _ in around])
    monkeypatch.setattr(search, "simulated", lambda _, plan, *__: plan)
    monkeypatch.setattr(search, "fit_views", lambda _, known: known)
    setting = SimpleNamespace(plan=SimpleNamespace(offsets=()), seed=0, changes=SimpleNamespace(observed=None))
    found = SimpleNamespace(view=lambda _: None, known=None)
    budget = SimpleNamespace(members=8)
    assert search.refined(setting, found, budget, map, turn) == [PIT] and asked == spread  # type: ignore[arg-type]


@pytest.mark.parametrize(("shown", "taken"), [(True, [3e-4]), (False, [7e-4])])
def test_where_no_visible_draw_is_on_the_path_of_a_view_sizes_are_spread_about_the_nearest(
    shown: bool, taken: list[float], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A sealed case (c069 of the proof) ended in an error there."""
    around: list[Sequence[tuple[str, Sequence[TermSpec]]]] = []
    monkeypatch.setattr(search, "seen_draws", lambda *_: [pit(3e-4)] if shown else [])
    monkeypatch.setattr(search, "best_draws", lambda *_: [pit(7e-4)])
    monkeypatch.setattr(search, "spread_plan", lambda _plan, told, **_: around.append(told))
    monkeypatch.setattr(search, "simulated", lambda *_: None)
    monkeypatch.setattr(search, "fit_views", lambda *_: "judged")
    setting = SimpleNamespace(
        plan=SimpleNamespace(offsets=(0,) * 8), seed=0, changes=SimpleNamespace(observed=np.zeros(3))
    )
    assert spread_out(setting, found_with({PIT: 0.5}), [PIT], map) == "judged"  # type: ignore[arg-type]
    ((name, terms),) = around[0]
    assert name == PIT and [t.parameters["width"] for t in terms] == taken
