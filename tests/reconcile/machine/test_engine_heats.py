"""Which effects are simulated on the fitted machines, and what happens where none of them runs."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.judge.adequacy import Rest
from reconcile.machine import search
from reconcile.machine.direct import NOTHING
from sim.core.errors import Problem, SpecError

NAMES = (
    "outer_spall@bearing1",
    "outer_spall@bearing2",
    "inner_spall@bearing1",
    "ball_spall@bearing1",
    "pedestal_looseness@bearing1",
    "unbalance@pinion",
    "rub@gear",
)
EVIDENCE = np.array([40.0, 20.0, 6.0, 5.0, 4.0, 3.0, 2.0])


def screened(misfit: float, direct: float, evidence: np.ndarray = EVIDENCE) -> SimpleNamespace:
    shown = np.array([direct, *[0.0] * (len(NAMES) - 1)])
    return SimpleNamespace(
        screen=SimpleNamespace(names=NAMES, evidence=evidence, direct=shown, misfit=misfit, rest=Rest())
    )


def test_the_metric_gets_five_effects_however_far_ahead_the_best_is() -> None:
    ranked = search.with_others(screened(0.3, 25.0), screened(0.3, 25.0))  # type: ignore[arg-type]
    assert ranked == [*NAMES[:6]], "five effects, the best first, with the other place of the best"


def test_what_may_stand_beside_the_best_is_simulated_too() -> None:
    both = screened(0.95, 25.0), screened(0.95, 25.0)
    ranked = search.with_others(*both, ["rub@gear", "unbalance@pinion"])  # type: ignore[arg-type]
    assert ranked == list(NAMES), "each once"


def test_single_lines_nominate_as_well_as_machines_of_the_kind() -> None:
    seen = screened(0.3, 0.0, 0.1 * EVIDENCE[::-1])
    ranked = search.with_others(screened(0.3, 0.0, 0.1 * EVIDENCE), seen)  # type: ignore[arg-type]
    assert ranked[:4] == ["outer_spall@bearing1", "rub@gear", "outer_spall@bearing2", "unbalance@pinion"]
    assert sorted(ranked) == sorted(NAMES), "each once"


def test_loose_rings_that_nothing_speaks_for_are_not_simulated() -> None:
    rings = tuple(f"fit_clearance@bearing{k}" for k in range(1, 5))
    others = tuple(f"rub@{k}" for k in range(search.NEAR_RANK + 5))
    names = (*others, *rings)

    def look(first: float, *best: str) -> SimpleNamespace:
        evidence = np.array([first, *np.linspace(1.0, 0.5, len(names) - 1)])
        evidence[[names.index(n) for n in best]] = 2.0
        return SimpleNamespace(screen=SimpleNamespace(names=names, evidence=evidence))

    led, flat = look(40.0, "fit_clearance@bearing1"), look(2.0)
    kept = search.without_hopeless(names, led, led)  # type: ignore[arg-type]
    assert kept == [*others, "fit_clearance@bearing1"], "one near the best"
    near = search.without_hopeless(names, led, led, ["fit_clearance@bearing2"])  # type: ignore[arg-type]
    assert near == [*others, "fit_clearance@bearing1", "fit_clearance@bearing2"], "one whose draw is near"
    for screened_, seen in ((led, flat), (flat, led)):
        assert search.without_hopeless(names, screened_, seen) == list(names), "none is out of the question"  # type: ignore[arg-type]
    many = look(2.0)
    many.screen.evidence[-4:] = -50.0
    assert search.without_hopeless(names, many, many) == list(names), "a ring less would be little saved"  # type: ignore[arg-type]


@pytest.mark.parametrize(("misfit", "direct", "looks"), [(0.95, 25.0, True), (0.95, 2.0, False), (0.3, 25.0, False)])
def test_a_second_is_thought_of_where_sure_impacts_leave_something(
    monkeypatch: pytest.MonkeyPatch, misfit: float, direct: float, looks: bool
) -> None:
    monkeypatch.setattr(search, "beside", lambda *_: SimpleNamespace(names=("rub@gear",)))
    expected = ("rub@gear",) if looks else ()
    assert search.possible_seconds(SimpleNamespace(direct=NOTHING), screened(misfit, direct)) == expected  # type: ignore[arg-type]


def test_draws_of_which_none_runs_leave_what_was_known(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_args: object, **_how: object) -> None:
        raise SpecError(Problem(field="machine", message="no candidate effect could be simulated on this machine"))

    monkeypatch.setattr(search, "simulated_banks", lambda *_: ())
    monkeypatch.setattr(search, "catalogued", refuse)
    changes = SimpleNamespace(with_baseline=True)
    setting = SimpleNamespace(seen_through=(), plan=None, banks=(), changes=changes)
    known = SimpleNamespace(terms=())
    assert search.simulated(setting, None, map, known) is known  # type: ignore[arg-type]
    with pytest.raises(SpecError):
        search.simulated(setting, None, map)  # type: ignore[arg-type]


TEETH = ("tooth_spall", "missing_tooth", "tooth_crack")
CLOSELY = (*TEETH, "fit_clearance_series", "radial_clearance", "fit_clearance", "torque_ripple", "angular_misalignment")


@pytest.mark.parametrize(
    ("best", "with_it"),
    [
        ("missing_tooth@gear", ["tooth_spall@gear"]),
        ("tooth_crack@gear", []),
        ("radial_clearance@gear", ["fit_clearance_series@gear"]),
        ("fit_clearance_series@gear", ["radial_clearance@gear"]),
        ("fit_clearance@gear", ["radial_clearance@gear"]),
        ("torque_ripple@gear", ["angular_misalignment@gear"]),
        ("angular_misalignment@gear", ["torque_ripple@gear"]),
        ("radial_clearance@wheel", ["fit_clearance@wheel"]),  # whose fit the machine file has loose already
        ("radial_clearance@pinion", []),  # where a fit cannot be loose
    ],
)
def test_what_looks_like_the_best_is_simulated_as_closely_pitted_and_broken_teeth_plays_and_twists(
    monkeypatch: pytest.MonkeyPatch, best: str, with_it: list[str]
) -> None:
    asked: list[str] = []
    first: list[str] = []
    found = SimpleNamespace(screen=None, known=SimpleNamespace(library=SimpleNamespace(groups={})))

    def heat(_plan: object, names: list[str], *_: object) -> SimpleNamespace:
        asked.extend(names)
        return SimpleNamespace(draws=())

    for name, made in {
        "with_others": lambda *_: [best],
        "without_hopeless": lambda ranked, *_: [*ranked, "kept@gear"],
        "_draws": lambda *_: {**{f"{term}@gear": [] for term in CLOSELY}, "fit_clearance@wheel": []},
        "first_heat": lambda _plan, names, *_: first.extend(names),
        "simulated": lambda *_: None,
        "fit_views": lambda *_: found,
        "plausible": lambda _: [best],
        "nearest_effects": lambda *_: (),
        "looks_for_second": lambda _: False,
        "second_heat": heat,
    }.items():
        monkeypatch.setattr(search, name, made)
    setting = SimpleNamespace(plan=None, changes=SimpleNamespace(observed=None))
    budget = SimpleNamespace(terms=1, candidates=4)
    search.located(setting, found, setting, budget, map, found)  # type: ignore[arg-type]
    assert asked == [best, *with_it] and first == [best, "kept@gear"], "what is not hopeless comes first"
    first.clear()
    search.located(setting, found, setting, budget, map, found, ["rub@gear"])  # type: ignore[arg-type]
    assert first == [best], "all, where something may be second"
