"""The mean turn on the page: both curves over the angle, the window above, and what their angles count from."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest

from reconcile.report.figures.mean_turn import mean_turn, turn_words
from reconcile.report.page import page
from reconcile.verdict import AngleWindow, Report, Where

ANGLES = [float(k) + 0.5 for k in range(360)]
PICTURE = {
    "gear": "pinion", "shaft": "in", "speed_hz": 30.0, "turns": 59, "window_deg": 18.8,
    "start": "the first sample of test 1", "same_start": False, "angle_deg": ANGLES,
    "test_db": [12.0 if 100 <= a < 110 else 0.0 for a in ANGLES], "baseline_db": [0.5] * 360,
}  # fmt: skip
WINDOW = AngleWindow(shaft="in", centre_deg=105.0, low_deg=100.0, high_deg=110.0)
REPORT = Report(
    verdict="ambiguous",
    sentence="A local tooth fault.",
    level="kinematics",
    where=Where(sites=(), angle_window=WINDOW),
    pictures={"mean_turn": PICTURE},
)


def test_both_curves_and_the_window_are_drawn() -> None:
    drawn = mean_turn(PICTURE, WINDOW)
    assert drawn.count('class="curve') == 2 and drawn.count('class="window"') == 1
    bar = re.search(r'<rect x="([\d.]+)" y="[\d.]+" width="([\d.]+)"', drawn)
    assert bar is not None
    left, width = map(float, bar.groups())
    assert (left - 62.0) / 644.0 == pytest.approx(100 / 360, abs=0.01) and width / 644.0 == pytest.approx(
        10 / 360, abs=0.01
    )
    assert 'class="window"' not in mean_turn(PICTURE, replace(WINDOW, shaft="out")), "another shaft's"
    assert 'class="window"' not in mean_turn(PICTURE, None)


def test_the_test_stands_high_where_its_burst_is_and_the_baseline_nowhere() -> None:
    found = dict(re.findall(r'<path d="([^"]+)" class="curve (\w+)"', mean_turn(PICTURE, None)))
    curves = {css: [tuple(map(float, point.split())) for point in re.split("[ML]", d)[1:]] for d, css in found.items()}
    assert set(curves) == {"observed", "before"}
    across = 720.0 - 62.0 - 14.0
    high = [x for x, y in curves["observed"] if y < 0.5 * max(y for _, y in curves["observed"])]
    assert 62.0 + across * 100 / 360 <= min(high) <= max(high) <= 62.0 + across * 110 / 360
    assert len({y for _, y in curves["before"]}) == 1


def test_without_a_curve_nothing_is_drawn() -> None:
    assert mean_turn({k: v for k, v in PICTURE.items() if k != "test_db"}, None) == ""
    assert "Over the turn of a gear" not in page(replace(REPORT, pictures={"mean_turn": {"gear": "pinion"}}))


def test_what_the_angles_count_from_is_said() -> None:
    assert "59 turns" in turn_words(PICTURE) and "windows of 19 degrees" in turn_words(PICTURE)
    assert turn_words(PICTURE).endswith("from its own: only how far it stands out is to be compared.")
    for same in ({**PICTURE, "same_start": True}, {k: v for k, v in PICTURE.items() if k != "baseline_db"}):
        assert turn_words(same).endswith("from the first sample of test 1.")


def test_the_page_has_it_with_a_key() -> None:
    made = page(REPORT)
    assert "Over the turn of a gear" in made and "baseline</span>" in made
    alone = page(replace(REPORT, pictures={"mean_turn": {k: v for k, v in PICTURE.items() if k != "baseline_db"}}))
    assert "Over the turn of a gear" in alone and "baseline</span>" not in alone
