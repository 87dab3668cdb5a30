"""Changed lines: at which operating point, one row a peak, parts by the names of the machine's file."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.atlas.plan import Point
from reconcile.machine.lines import by_name, line_changes
from reconcile.observe.features import Layout
from reconcile.verdict import LineChange
from sim.presets import preset

LAYOUT = Layout(lines=2, bands=4, shapes=1, modulations=1)
POINTS = (Point(speed_hz=22.5), Point(speed_hz=30.0, torque_ratio=0.5))
CHANNELS = ("a", "b")


def line(label: str, orders: dict[str, float], *, slips: bool) -> SimpleNamespace:
    return SimpleNamespace(label=label, orders=orders, slips=slips)


def point(at: Point, lines_hz: tuple[float, ...], turned: float = 1.0, peak_hz: float = 0.0) -> SimpleNamespace:
    """`peak_hz`: where the peak of all lines stands, that of each line without one."""
    heard = SimpleNamespace(speed_hz=turned * at.speed_hz, peak_hz=lambda _channel, hz, _reach: peak_hz or hz)
    return SimpleNamespace(point=at, lines_hz=np.array(lines_hz), spectra=(heard, None))


def two(
    lines_hz: tuple[float, float], change_db: tuple[float, float], *, slips: bool, peak_hz: float = 0.0
) -> list[str]:
    """What is told of two lines of one point, on the first of two channels."""
    one = point(POINTS[0], lines_hz, peak_hz=peak_hz)
    observed = np.zeros(2 * LAYOUT.size)
    observed[:2] = change_db
    null = np.random.default_rng(0).normal(size=(8, observed.size))
    starts = (0, observed.size)
    changes = SimpleNamespace(observed=observed, null=null, measured=np.ones(observed.size), starts=starts)
    watched = SimpleNamespace(
        lines=[line("2*f_i1", {"f_i1": 2}, slips=slips), line("3*f_o1", {"f_o1": 3}, slips=slips)]
    )
    found = line_changes([one], changes, LAYOUT, watched, CHANNELS)  # type: ignore[arg-type, list-item]
    assert len({(x.label, x.channel) for x in found}) == len(found)
    assert not peak_hz or {x.frequency_hz for x in found} == {peak_hz}
    return [f"{x.label}: {x.locked_to}" for x in by_name(found, preset("bearing-rig"))]


def test_a_changed_line_says_at_which_speed_and_torque() -> None:
    data = [point(p, (p.speed_hz, 2.0 * p.speed_hz), turned=1.002) for p in POINTS]
    observed = np.zeros(4 * LAYOUT.size)
    observed[0], observed[2 * LAYOUT.size + 1] = 9.0, -20.0
    starts = (0, 2 * LAYOUT.size, 4 * LAYOUT.size)
    null = np.random.default_rng(0).normal(size=(8, observed.size))
    changes = SimpleNamespace(observed=observed, null=null, measured=np.ones(observed.size), starts=starts)
    watched = SimpleNamespace(lines=[line(f"{k}*f_r1", {"f_r1": k}, slips=False) for k in (1, 2)])
    found = line_changes(data, changes, LAYOUT, watched, CHANNELS)  # type: ignore[arg-type]
    assert [(x.label, x.frequency_hz, x.speed_hz, x.torque_ratio) for x in found] == [
        ("2*f_r1", pytest.approx(60.12), 30.0, 0.5),
        ("1*f_r1", pytest.approx(22.545), 22.5, 1.0),
    ], "where they stand in the test, which turned a little faster than stated"


def test_parts_are_called_as_in_the_machine_file() -> None:
    machine = preset("bearing-rig")
    told = ("outer ring of bearing 2", "shaft 1", "mesh", "outer ring of bearing 7", "")
    lines = [LineChange(label="x", frequency_hz=1.0, change_db=3.0, channel="a", locked_to=text) for text in told]
    found = [x.locked_to for x in by_name(lines, machine)]
    both = "outer ring of drive_end or fan_end"  # of one size on one shaft: one line
    assert found == [both, "motor", "mesh", "outer ring of bearing 7", ""]
    other = machine.bearings[1].model_copy(update={"catalogue": "6310"})
    unlike = machine.model_copy(update={"bearings": [machine.bearings[0], other]})
    assert by_name(lines[:1], unlike)[0].locked_to == "outer ring of fan_end"


def test_a_peak_that_two_lines_may_be_is_told_once_with_both_names() -> None:
    both = "inner ring of drive_end or fan_end or outer ring of drive_end or fan_end"
    assert two((300.0, 303.0), (20.3, 20.0), slips=True) == [f"2*f_i1 or 3*f_o1: {both}"]


def test_the_nearest_name_comes_first_with_the_frequency_of_the_peak() -> None:
    told = two((300.0, 303.0), (20.3, 20.0), slips=True, peak_hz=302.4)
    assert told == ["3*f_o1 or 2*f_i1: outer ring of drive_end or fan_end or inner ring of drive_end or fan_end"]


def test_lines_apart_or_changed_otherwise_or_locked_to_shafts_stay_two() -> None:
    assert len(two((300.0, 309.0), (20.0, 20.0), slips=True)) == 2
    assert len(two((300.0, 303.0), (20.0, 14.0), slips=True)) == 2
    assert len(two((300.0, 303.0), (20.0, 20.0), slips=False)) == 2
