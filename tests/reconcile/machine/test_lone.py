"""A sensor that changed at one operating point alone is left out of all views, and the report says so."""

from __future__ import annotations

from dataclasses import dataclass, replace
from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.atlas.plan import Point
from reconcile.judge.lone import LOUD_P
from reconcile.machine import lone
from reconcile.machine.decide import ALSO_P
from reconcile.machine.setting import Found, Lone, Setting
from reconcile.observe.observation import LEFT_OUT
from reconcile.verdict import Report
from tests.reconcile.judge.cells import CHANNELS, FEATURES, PHASES, POINTS, noise, space

FAR = 8.0
SPEEDS_HZ = (20.0, 30.0, 40.0)


@dataclass(frozen=True, kw_only=True)
class Seen:
    """What `Changes` are asked for here."""

    observed: np.ndarray
    halves: np.ndarray
    phases: int = PHASES


def setting(cube: np.ndarray, *, gears: int = 2, speeds: tuple[float, ...] = SPEEDS_HZ, p: float = 1.0) -> Setting:
    data = tuple(SimpleNamespace(point=Point(speed_hz=hz)) for hz in speeds)
    given: dict[str, object] = dict.fromkeys(("simulated", "plan", "banks", "seen_through"))
    changes = Seen(observed=cube.ravel(), halves=np.stack([cube.ravel(), cube.ravel()]))
    return Setting(  # type: ignore[arg-type]
        machine=SimpleNamespace(gears=(None,) * gears),
        data=data,
        channels=("a.x", "b.x", "c.x"),
        changes=changes,
        direct=SimpleNamespace(p=p),
        seed=0,
        **given,
    )


def fitted(p_best: float = 0.5) -> Found:
    screen = SimpleNamespace(p_best=p_best, p_any=1e-5)
    return Found(known="known", fitted=space(), screen=screen)  # type: ignore[arg-type]


def one_cell() -> np.ndarray:
    cube = noise(2)
    cube[1, 2] += FAR
    return cube


AFTER = {"p_best": 0.5, "p_lines": 1.0}


@pytest.fixture
def after() -> dict[str, float]:
    """Chances without what was left out."""
    return dict(AFTER)


@pytest.fixture(autouse=True)
def views(monkeypatch: pytest.MonkeyPatch, after: dict[str, float]) -> list[Setting]:
    """The settings that views are made for."""
    asked: list[Setting] = []

    def fit(here: Setting, known: object) -> Found:
        asked.append(here)
        again = SimpleNamespace(overdispersion=7.0 + len(asked))
        return Found(known=known, fitted=again, screen=SimpleNamespace(**after))  # type: ignore[arg-type]

    monkeypatch.setattr(lone, "fit_views", fit)
    return asked


def test_it_is_left_out_of_both_looks_and_kept_to_be_told(views: list[Setting]) -> None:
    given = setting(one_cell())
    (first, of_kind), (second, seen) = lone.without_lone((given, fitted()), (given, fitted()))
    assert views == [first, second] and of_kind.known == seen.known == "known"
    assert of_kind.fitted.overdispersion == 8.0 == second.overdispersion, "as the atlas without it has it"
    for left in (first, second):
        for kept in (left.changes.observed, *left.changes.halves):
            unknown = np.isnan(kept).reshape(POINTS, CHANNELS, FEATURES)
            assert unknown[1, 2].all() and unknown[1, 1, -PHASES:].all() and unknown.sum() == FEATURES + PHASES
            assert np.array_equal(kept[~unknown.ravel()], given.changes.observed[~unknown.ravel()])
        assert left.lone == Lone(channel="c.x", point="30 Hz", p=1e-5)


@pytest.mark.parametrize(
    ("given", "kind", "closer"),
    [
        (setting(noise(2)), 0.5, 0.5),  # nothing changed
        (setting(one_cell() + FAR * (np.arange(CHANNELS) == 0)[:, None]), 0.5, 0.5),  # nor alone
        (setting(one_cell()), 0.5, LOUD_P),  # a known effect's pattern
        (setting(one_cell()), LOUD_P, 0.5),  # the same on machines of the kind
        (setting(one_cell(), p=LOUD_P), 0.5, 0.5),  # impacts
        (setting(one_cell(), gears=0), 0.5, 0.5),
        (setting(one_cell(), speeds=(30.0, 30.1, 30.2)), 0.5, 0.5),  # three loads at one speed
    ],
)
def test_it_stays_where_it_may_be_something_else(
    given: Setting, kind: float, closer: float, views: list[Setting]
) -> None:
    looks = (given, fitted(kind)), (given, fitted(closer))
    assert lone.without_lone(*looks) == looks and not views


@pytest.mark.parametrize("chance", AFTER)
def test_it_stays_where_what_is_left_is_unusual_too(chance: str, after: dict[str, float]) -> None:
    after[chance] = ALSO_P
    looks = (setting(one_cell()), fitted()), (setting(one_cell()), fitted())
    assert lone.without_lone(*looks) == looks


REPORT = Report(verdict="nothing_missing", sentence="Nothing is missing: p = 0.9.", level="machine")


def test_a_machine_that_is_sound_otherwise_is_told_so_with_what_to_record() -> None:
    found = lone.with_lone(REPORT, Lone(channel="c.x", point="30 Hz", p=2e-4))
    (limit,) = found.where.limits
    assert limit.startswith(f"{LEFT_OUT}: c.x at 30 Hz, which changed alone (p = 0.0002)")
    assert found.sentence == "Nothing is missing: p = 0.9, but for c.x at 30 Hz, which changed alone and is left out."
    assert found.next_experiment is not None and "further baseline at 30 Hz" in found.next_experiment.sentence


def test_beside_another_answer_it_is_a_limit_alone_and_without_it_nothing_is_said() -> None:
    other = replace(REPORT, verdict="explained")
    found = lone.with_lone(other, Lone(channel="c.x", point="30 Hz", p=2e-4))
    assert len(found.where.limits) == 1 and found.sentence == other.sentence and found.next_experiment is None
    assert lone.with_lone(REPORT, None) is REPORT
