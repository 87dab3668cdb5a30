"""The force by lines in the report: where it is told, what it says, and what stays as it was."""

from __future__ import annotations

import json
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.machine import estimated
from reconcile.machine.added_power import Reached
from reconcile.machine.estimated import NO_BASELINE, NO_RISE, NO_WORK, UNHEARD, estimated_force, with_force
from reconcile.machine.force import Heard
from reconcile.report.strict import plain
from reconcile.verdict import EstimatedForce, LineChange, Report

RESPONSE = 1e-4
HZ = np.array([60.0, 62.0, 690.0, 1380.0])


def reached(force: np.ndarray, before: float = 0.0) -> Reached:
    """One channel that hears these forces along y, N rms, at lines of which the first two share a lobe."""
    test = (force**2 * RESPONSE + before)[None]
    known = np.full((2, 1, HZ.size), RESPONSE)
    known[0] = np.nan
    there = np.full((1, HZ.size), before)
    heard = Heard(
        test=test, before=there, deviation=0.1 * there + 1e-9, response=known, spread_db=np.zeros(known.shape)
    )
    return Reached(hz=HZ, heard=heard, axes=("y",))


def setting_of(*speeds: float) -> SimpleNamespace:
    test = SimpleNamespace(resolution_hz=1.5)
    data = tuple(
        SimpleNamespace(point=SimpleNamespace(speed_hz=s, torque_ratio=1.0), test=test, baseline=test, lines_hz=HZ)
        for s in speeds
    )
    return SimpleNamespace(data=data, banks=(), plan=None)


@pytest.fixture
def by_point(monkeypatch: pytest.MonkeyPatch) -> dict[int, Reached | None]:
    """What is reached at each operating point, instead of a machine."""
    found: dict[int, Reached | None] = {}
    monkeypatch.setattr(estimated, "machines_like", lambda _setting: ())
    monkeypatch.setattr(estimated, "reached", lambda _setting, k, *_rest: found[k])
    return found


def test_lines_that_rose_are_told_with_their_sum(by_point: dict[int, Reached | None]) -> None:
    by_point |= {0: reached(np.array([3.0, 2.9, 4.0, 0.0])), 1: reached(np.array([0.0, 0.0, 2.0, 0.0]))}
    found = estimated_force(setting_of(30.0, 40.0), "bearing2")  # type: ignore[arg-type]
    rows = dict(
        zip(zip(found.samples["speed_hz"], found.samples["frequency_hz"], strict=True), range(99), strict=False)
    )
    assert (30.0, 60.0) in rows and (30.0, 62.0) not in rows, "lines in one lobe are one"
    k = rows[(30.0, 690.0)]
    assert found.samples["order"][k] == 23.0
    assert found.samples["force_n"][k] == pytest.approx(4.0, rel=0.15)
    assert found.samples["low_n"][k] < 4.0 < found.samples["high_n"][k]
    first, second = found.points
    assert (first.lines, second.lines) == (2, 1)
    assert first.force_n == pytest.approx(5.0, rel=0.15) and first.low_n < 5.0 < first.high_n
    assert found.axes == ("y",) and found.work_per_cycle_j is None and NO_WORK in found.remarks
    assert "no sensor hears a force along x" in found.remarks[0]
    assert json.loads(json.dumps(plain(found.samples), allow_nan=False))["order"][k] == 23.0


def test_where_nothing_changed_only_upper_ends_are_told(by_point: dict[int, Reached | None]) -> None:
    by_point[0] = reached(np.zeros(4), before=1e-2)
    found = estimated_force(setting_of(30.0), "bearing2")  # type: ignore[arg-type]
    assert not found.points and set(found.samples["low_n"]) == {0.0} and NO_RISE in found.remarks


def test_without_a_baseline_or_a_channel_that_hears_it_none_is_told(by_point: dict[int, Reached | None]) -> None:
    bare = setting_of(30.0)
    bare.data[0].baseline = None
    found = estimated_force(bare, "bearing2")  # type: ignore[arg-type]
    assert found.samples == {} and found.remarks == (NO_BASELINE, NO_WORK)
    by_point[0] = None
    assert estimated_force(setting_of(30.0), "bearing2").remarks == (UNHEARD, NO_WORK)  # type: ignore[arg-type]
    deaf = reached(np.ones(4))
    deaf.heard.response[:] = np.nan
    by_point[0] = replace(deaf, axes=())
    assert estimated_force(setting_of(30.0), "bearing2").remarks == (UNHEARD, NO_WORK)  # type: ignore[arg-type]


def test_the_list_is_bounded(by_point: dict[int, Reached | None]) -> None:
    speeds = [10.0 + k for k in range(30)]
    by_point |= {k: reached(np.array([3.0, 0.0, 4.0, 5.0])) for k in range(30)}
    found = estimated_force(setting_of(*speeds), "bearing2")  # type: ignore[arg-type]
    assert len(found.samples["order"]) == estimated.MOST_LINES and min(found.samples["low_n"]) > 0.0


def test_lines_told_beside_the_watched_ones_are_asked_too() -> None:
    here = setting_of(30.0).data[0]
    lines = [LineChange(label="", frequency_hz=f, change_db=d, speed_hz=s)
             for f, d, s in ((591.0, 20.0, 30.0), (592.0, 20.0, 30.0), (689.0, 9.0, 30.0), (400.0, -9.0, 30.0),
                             (791.0, 20.0, 40.0))]  # fmt: skip
    assert estimated.beside(here, lines) == [591.0]


def test_nothing_but_the_force_of_an_unknown_physics_without_a_law_changes(by_point: dict[int, Reached | None]) -> None:
    by_point[0] = reached(np.array([3.0, 0.0, 4.0, 0.0]))
    setting = setting_of(30.0)
    plain_report = Report(verdict="unknown_physics", sentence="x", level="machine")
    found = with_force(plain_report, setting, ("bearing3", "bearing1"))  # type: ignore[arg-type]
    assert found.force is not None and found.force.site == "bearing3" and found.force.points
    assert replace(found, force=None) == plain_report
    placed = replace(plain_report, force=EstimatedForce(site="bearing1", samples={}, law=None))
    again = with_force(placed, setting, ("bearing3",))  # type: ignore[arg-type]
    assert again.force is not None and again.force.site == "bearing1"
    law = replace(plain_report, force=EstimatedForce(site="bearing1", samples={}, law="z^3"))
    for kept in (law, replace(plain_report, verdict="explained")):
        assert with_force(kept, setting, ("bearing3",)) is kept  # type: ignore[arg-type]
    assert with_force(plain_report, setting, ()) is plain_report  # type: ignore[arg-type]
    setting.data[0].baseline = None
    assert with_force(plain_report, setting, ("bearing3",)) is plain_report  # type: ignore[arg-type]
