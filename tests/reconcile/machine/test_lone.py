"""A sensor that changed at one operating point alone is left out of all views, and the report says so."""

from __future__ import annotations

from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.atlas.plan import Point
from reconcile.machine import lone
from reconcile.machine.setting import Found, Setting
from reconcile.observe.observation import LEFT_OUT
from tests.reconcile.judge.cells import CHANNELS, FEATURES, PHASES, POINTS, noise, space

FAR = 8.0
SPEEDS_HZ = (20.0, 30.0, 40.0)


@dataclass(frozen=True, kw_only=True)
class Seen:
    """What `Changes` are asked for here."""

    observed: np.ndarray
    measured: np.ndarray
    phases: int = PHASES


def setting(cube: np.ndarray) -> Setting:
    data = tuple(SimpleNamespace(point=Point(speed_hz=hz)) for hz in SPEEDS_HZ)
    given: dict[str, object] = dict.fromkeys(("machine", "simulated", "plan", "banks", "seen_through"))
    changes = Seen(observed=cube.ravel(), measured=np.ones(cube.size))
    return Setting(data=data, channels=("a.x", "b.x", "c.x"), changes=changes, seed=0, **given)  # type: ignore[arg-type]


def fitted(p_best: float = 0.5) -> Found:
    screen = SimpleNamespace(p_best=p_best)
    return Found(known="known", fitted=space(), screen=screen)  # type: ignore[arg-type]


def one_cell() -> np.ndarray:
    cube = noise(2)
    cube[1, 2] += FAR
    return cube


@pytest.fixture(autouse=True)
def views(monkeypatch: pytest.MonkeyPatch) -> list[Setting]:
    """The settings that views are made for."""
    asked: list[Setting] = []

    def fit(here: Setting, known: object) -> Found:
        asked.append(here)
        return Found(known=known, fitted="again", screen=None)  # type: ignore[arg-type]

    monkeypatch.setattr(lone, "fit_views", fit)
    return asked


def test_it_is_left_out_of_both_looks_and_told(views: list[Setting]) -> None:
    kind, closer = setting(one_cell()), setting(one_cell())
    (first, of_kind), (second, seen) = lone.without_lone((kind, fitted()), (closer, fitted()))
    assert views == [first, second] and of_kind.fitted == seen.fitted == "again" and of_kind.known == "known"
    for left in (first, second):
        unknown = np.isnan(left.changes.measured).reshape(POINTS, CHANNELS, FEATURES)
        assert unknown[1, 2].all() and unknown[1, 1, -PHASES:].all() and unknown.sum() == FEATURES + PHASES
        assert np.array_equal(left.changes.observed, kind.changes.observed)
        (told,) = left.lone
        assert told.startswith(LEFT_OUT) and "c.x at 30 Hz" in told and "baseline at this operating point" in told


@pytest.mark.parametrize(
    ("cube", "p_best"),
    [(noise(2), 0.5), (one_cell() + FAR * (np.arange(CHANNELS) == 0)[:, None], 0.5), (one_cell(), 0.002)],
)
def test_it_stays_where_there_is_none_or_a_known_effect_has_its_pattern(
    cube: np.ndarray, p_best: float, views: list[Setting]
) -> None:
    of_kind, closer = (setting(cube), fitted()), (setting(cube), fitted(p_best))
    assert lone.without_lone(of_kind, closer) == (of_kind, closer)
    assert not views and not closer[0].lone
