"""Which views of single lines are asked on machines that agree with the baseline."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.machine import search

TEETH, NONE = np.array([True, False]), np.array([False, False])


@pytest.mark.parametrize(
    ("chosen", "phased", "points", "asked"),
    [
        (TEETH, ("mesh phases", "side phases"), 2, ["single", "sides", "twice", "mesh phases", "side phases"]),
        (TEETH, (), 2, ["single", "sides", "twice"]),
        (NONE, (), 2, ["single", "sides"]),
        (TEETH, (), 1, []),
    ],
)
def test_second_sidebands_are_a_view_where_there_are_teeth(
    monkeypatch: pytest.MonkeyPatch, chosen: np.ndarray, phased: tuple[str, ...], points: int, asked: list[str]
) -> None:
    twice = SimpleNamespace(chosen=chosen, name="twice")
    monkeypatch.setattr(search, "noisy", lambda *_: None)
    monkeypatch.setattr(search, "fit_space", lambda *_, view=None, **__: getattr(view, "name", view))
    monkeypatch.setattr(search, "judge", lambda views, *_: views)
    changes = SimpleNamespace(single="single", sides="sides", twice=twice, phased=phased, observed=None)
    setting = SimpleNamespace(
        changes=changes, direct=SimpleNamespace(evidence={}, p=1.0), seed=0, overdispersion=2.0,
        data=(None,) * points, channels=("a", "b"), fitted_machine=object(),
    )  # fmt: skip
    found = search.fit_views(setting, SimpleNamespace(library=SimpleNamespace(changes=None)))  # type: ignore[arg-type]
    assert list(found.screen[1:]) == asked  # type: ignore[index]
    if asked:
        assert (found.fine, found.sides, found.twice, found.phases) == (
            "single", "sides", "twice" if chosen.any() else None, phased
        )  # fmt: skip
