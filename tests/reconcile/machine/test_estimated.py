"""The force by lines in the report: where it is told, what it says, and what stays as it was."""

from __future__ import annotations

import json
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.machine import estimated
from reconcile.machine.added_power import Reached, ways
from reconcile.machine.estimated import (
    ASSUMED,
    HIDDEN,
    MIXED_LINES,
    NO_BASELINE,
    NO_RISE,
    NO_WORK,
    NOT_ACCELERATION,
    UNHEARD,
    estimated_force,
    with_force,
)
from reconcile.machine.force import Heard
from reconcile.report.strict import plain
from reconcile.verdict import EstimatedForce, LineChange, PlaceWeight, Report, Where
from sim.core.response import Channel

RESPONSE = 1e-4
HZ = np.array([60.0, 62.0, 690.0, 1380.0])


def reached(force: np.ndarray, before: float = 0.0) -> Reached:
    """One channel that hears these forces along y, N rms, at lines of which the first two share a lobe; `before` in
    power."""
    test = (force**2 * RESPONSE + before)[None]
    known = np.full((len(ways()), 1, HZ.size), RESPONSE)
    there = np.full((1, HZ.size), before)
    heard = Heard(
        test=test, before=there, deviation=0.1 * there + 1e-9, response=known, spread_db=np.zeros((1, HZ.size))
    )
    return Reached(hz=HZ, heard=heard, along=np.array([[False] * HZ.size, [True] * HZ.size]))


def setting_of(*speeds: float) -> SimpleNamespace:
    test = SimpleNamespace(resolution_hz=1.5)
    data = tuple(
        SimpleNamespace(
            point=SimpleNamespace(speed_hz=s, torque_ratio=1.0),
            test=test,
            baseline=test,
            lines_hz=HZ,
            spectra=(SimpleNamespace(speed_hz=s), SimpleNamespace(speed_hz=s)),
        )
        for s in speeds
    )
    return SimpleNamespace(data=data, banks=(), plan=None)


@pytest.fixture
def by_point(monkeypatch: pytest.MonkeyPatch) -> dict[int, Reached | None]:
    """What is reached at each operating point, instead of a machine."""
    found: dict[int, Reached | None] = {}
    monkeypatch.setattr(estimated, "machines_like", lambda _setting: ())
    monkeypatch.setattr(estimated, "reached", lambda _setting, k, *_rest, **_named: found[k])
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
    assert set(found.samples["low_n"]) == {0.0} and set(found.samples["force_n"]) == {0.0}
    assert min(found.samples["high_n"]) > 0.0
    (point,) = found.points
    assert (point.lines, point.force_n, point.low_n) == (0, 0.0, 0.0) and point.high_n >= max(found.samples["high_n"])
    assert NO_RISE in found.remarks and HIDDEN not in found.remarks and MIXED_LINES not in found.remarks
    assert "NaN" not in json.dumps(plain(found.samples), allow_nan=False)


def test_a_line_that_rose_beside_stronger_ones_is_not_called_unchanged(by_point: dict[int, Reached | None]) -> None:
    one = reached(np.array([0.0, 0.0, 4.0, 0.0]))
    one.heard.test[0, 3] = one.heard.before[0, 3] = 100.0
    one.heard.deviation[0, 3] = 10.0
    by_point[0] = one
    found = estimated_force(setting_of(30.0), "bearing2")  # type: ignore[arg-type]
    assert HIDDEN in found.remarks and NO_RISE not in found.remarks and set(found.samples["low_n"]) == {0.0}


def test_without_a_baseline_or_a_channel_that_hears_it_none_is_told(by_point: dict[int, Reached | None]) -> None:
    bare = setting_of(30.0)
    bare.data[0].baseline = None
    found = estimated_force(bare, "bearing2")  # type: ignore[arg-type]
    assert found.samples == {} and found.remarks == (NO_BASELINE, NO_WORK)
    by_point[0] = None
    assert estimated_force(setting_of(30.0), "bearing2").remarks == (UNHEARD, NO_WORK)  # type: ignore[arg-type]
    deaf = reached(np.ones(4))
    deaf.heard.response[:] = np.nan
    by_point[0] = replace(deaf, along=np.zeros((2, HZ.size), dtype=bool))
    assert estimated_force(setting_of(30.0), "bearing2").remarks == (UNHEARD, NO_WORK)  # type: ignore[arg-type]


def test_the_list_is_bounded(by_point: dict[int, Reached | None]) -> None:
    speeds = [10.0 + k for k in range(30)]
    by_point |= {k: reached(np.array([3.0, 0.0, 4.0, 5.0])) for k in range(30)}
    found = estimated_force(setting_of(*speeds), "bearing2")  # type: ignore[arg-type]
    assert len(found.samples["order"]) == estimated.MOST_LINES and min(found.samples["low_n"]) > 0.0


def test_lines_told_beside_the_watched_ones_are_asked_too() -> None:
    data = setting_of(30.0, 40.0).data
    lines = [LineChange(label="", frequency_hz=f, change_db=d, speed_hz=s)
             for f, d, s in ((591.0, 20.0, 30.0), (592.0, 20.0, 30.0), (689.0, 9.0, 30.0), (400.0, -9.0, 30.0),
                             (791.0, 20.0, 40.0))]  # fmt: skip
    assert estimated.beside(data, 0, lines) == [591.0] and estimated.beside(data, 1, lines) == [791.0]


def test_a_line_told_at_the_measured_speed_belongs_to_the_nearest_point() -> None:
    """Stated 30 and 30 at half the torque, turned 29.9 and 29.7."""
    setting = setting_of(30.0, 30.0)
    for one, turned, torque in zip(setting.data, (29.9, 29.7), (1.0, 0.5), strict=True):
        one.spectra[0].speed_hz, one.point.torque_ratio = turned, torque
    lines = [LineChange(label="", frequency_hz=10.1 * s, change_db=20.0, speed_hz=s) for s in (29.9, 29.7, 35.0)]
    lines.append(LineChange(label="", frequency_hz=50.0, change_db=20.0, speed_hz=30.0, torque_ratio=0.5))
    lines.append(LineChange(label="", frequency_hz=50.0, change_db=20.0))
    lines.append(LineChange(label="", frequency_hz=12.0 * 29.88, change_db=20.0, speed_hz=29.88))
    assert estimated.beside(setting.data, 0, lines) == pytest.approx([303.0, 12.0 * 29.88 * 30.0 / 29.9])
    assert estimated.beside(setting.data, 1, lines) == pytest.approx([303.0, 50.0 * 30.0 / 29.7])


CHANNELS = (Channel(name="a", quantity="acceleration", unit="m/s^2", location="bearing1"),)


def test_nothing_but_the_force_of_an_unknown_physics_without_a_law_changes(by_point: dict[int, Reached | None]) -> None:
    by_point[0] = reached(np.array([3.0, 0.0, 4.0, 0.0]))
    setting = setting_of(30.0)
    plain_report = Report(verdict="unknown_physics", sentence="x", level="machine")
    found = with_force(plain_report, setting, ("bearing3", "bearing1"), CHANNELS)  # type: ignore[arg-type]
    assert found.force is not None and found.force.site == "bearing3" and found.force.points
    assert replace(found, force=None) == plain_report
    placed = replace(plain_report, force=EstimatedForce(site="bearing1", samples={}, law=None))
    again = with_force(placed, setting, ("bearing3",), CHANNELS)  # type: ignore[arg-type]
    assert again.force is not None and again.force.site == "bearing1"
    law = replace(plain_report, force=EstimatedForce(site="bearing1", samples={}, law="z^3"))
    for kept in (law, replace(plain_report, verdict="explained")):
        assert with_force(kept, setting, ("bearing3",), CHANNELS) is kept  # type: ignore[arg-type]
    assert with_force(plain_report, setting, (), CHANNELS) is plain_report  # type: ignore[arg-type]
    setting.data[0].baseline = None
    bare = with_force(plain_report, setting, ("bearing3",), CHANNELS).force  # type: ignore[arg-type]
    assert bare is not None and bare.site == "bearing3" and bare.samples == {} and NO_BASELINE in bare.remarks


def test_a_place_that_was_not_found_is_called_assumed(by_point: dict[int, Reached | None]) -> None:
    by_point[0] = reached(np.array([3.0, 0.0, 4.0, 0.0]))
    report = Report(verdict="unknown_physics", sentence="x", level="machine")
    assumed = ASSUMED.format(site="bearing3")
    for sites, told in ((("input", "output"), True), ((), True), (("bearing3",), False)):
        weights = tuple(PlaceWeight(site=s, weight=0.5) for s in sites)
        placed = replace(report, where=Where(sites=weights))
        found = with_force(placed, setting_of(30.0), ("bearing3",), CHANNELS).force  # type: ignore[arg-type]
        assert found is not None and (assumed in found.remarks) == told


def test_sensors_of_another_quantity_are_not_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[object] = []

    def told(_setting: object, _k: int, *_rest: object, told_by: object, **_named: object) -> Reached:
        asked.append(told_by)
        return reached(np.array([3.0, 0.0, 4.0, 0.0]))

    monkeypatch.setattr(estimated, "machines_like", lambda _setting: ())
    monkeypatch.setattr(estimated, "reached", told)
    report = Report(verdict="unknown_physics", sentence="x", level="machine")
    speed = replace(CHANNELS[0], name="b", quantity="velocity", unit="m/s")
    found = with_force(report, setting_of(30.0), ("bearing3",), (*CHANNELS, speed)).force  # type: ignore[arg-type]
    assert asked == [[True, False]] and found is not None and NOT_ACCELERATION in found.remarks
    found = with_force(report, setting_of(30.0), ("bearing3",), CHANNELS).force  # type: ignore[arg-type]
    assert found is not None and NOT_ACCELERATION not in found.remarks
