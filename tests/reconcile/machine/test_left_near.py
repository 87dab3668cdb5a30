"""Seconds that by their sums come as near as the best does simulated are simulated too, before they open it."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from reconcile.machine import left_pairs


def test_what_comes_as_near_as_the_best_does_simulated_is_simulated_too(monkeypatch: pytest.MonkeyPatch) -> None:
    """A pit and a loose ring (tw045 of the proof): the ring added 14.4 by sums and 12.3 simulated, a foot 6.7 by sums,
    more than half of the latter and less than half of the former."""
    fitted = {"half": SimpleNamespace(gain=5.0), "late": None}
    monkeypatch.setattr(left_pairs, "_fitted", lambda _asked, name, _rows: fitted[name])
    asked = SimpleNamespace(least=7.5)
    made = {"best": SimpleNamespace(gain=12.3), "next": None}
    others = [("half", 6.7, ()), ("late", 6.3, ()), ("far", 6.1, ())]
    near = left_pairs._as_near
    assert near(asked, made, others, 6) == fitted  # type: ignore[arg-type]
    assert near(asked, made, others, 3) == {"half": fitted["half"]}, "while there may be so many"  # type: ignore[arg-type]
    assert near(asked, made, others, 2) == {}  # type: ignore[arg-type]
    none = {"best": SimpleNamespace(gain=7.4), "next": None}
    assert near(asked, none, others, 6) == {}, "nothing stands that these could open"  # type: ignore[arg-type]
