"""The page of real recordings says what reports say, and judges them as their truth demands."""

from __future__ import annotations

from typing import Any

import pytest

from proof.real import driven, page, told
from proof.real.call import Answer
from proof.real.rigs import judged, true_width_m
from proof.real.tables import Row, gains, misses, names, paths, sites, summary

HELD: dict[str, Any] = {"before": 8.0, "after": 4.0, "gain": 0.5, "gain_low": 0.4, "gain_high": 0.6}
FAMILY = {
    "family": "bearing.outer", "order": 3.587, "channel": "seat", "heard": {"seat": 20.0, "far": 7.0},
    "band_hz": [4000.0, 8000.0], "depth": 1.5, "growth_db": 24.0, "present": True, "risen": True,
}  # fmt: skip
GATE = "all tests seat: loose_sensor, its transfer changed by up to +12 dB around 3100 Hz, lines and noise alike; quiet"


def report(**changed: Any) -> dict[str, Any]:
    size = {"name": "width", "value": 3e-3, "unit": "m", "low": 2e-3, "high": 5e-3}
    cause = {
        "term": "outer_spall", "site": "bearing", "severity": size, "named": True, "values": {"slip": 0.001},
    }  # fmt: skip
    return {
        "verdict": "explained",
        "sentence": "A defect. The baseline has this defect too; it grew from 4.0 to 8.0 degrees.",
        "where": {"sites": [{"site": "bearing", "weight": 1.0}]},
        "causes": [cause],
        "fault": None,
        "held_out": HELD | {"retuned": 0.25, "black_box": 0.3, "placebo": None},
        "undecidable": ["where it sits", "not explained by the defect: 1 x shaft grew by 12 dB"],
        "stages": [{"name": "gate", "findings": [GATE]}, {"name": "families", "table": [FAMILY]}],
    } | changed


def row(found: dict[str, Any] | None, error: str | None = None) -> Row:
    test = {
        "file": "hit_sm_mfs/hit_mfs_OR8_1200.mat", "dataset": "hit_sm_mfs", "condition": "outer-race fault",
        "fs_hz": 51200, "shaft_speed_hz": 20.0,
    }  # fmt: skip
    baseline = test | {"file": "hit_sm_mfs/hit_mfs_Normal_1200.mat", "condition": "healthy"}
    return Row(baseline=baseline, test=test, answer=Answer(report=found, error=error, wall_s=1.0))


def test_place_size_path_and_rest_are_the_reports() -> None:
    found = report()
    assert told.places(found) == "bearing (1.00); seat 20, far 7"
    assert told.size(found) == "3.0 mm (2.0 to 5.0); grew from 4.0 to 8.0 degrees"
    assert told.path(found) == "4 to 8 kHz of seat, depth 1.50, +24 dB; seat +12 dB around 3.1 kHz"
    assert told.order(found) == "3.587 (+0.1%)"
    assert told.left(found) == "1 x shaft grew by 12 dB"
    assert "| 8.0 | 4.0 | 0.50 (0.40 to 0.60) | 6.0 | 5.6 |  |" in gains([row(found)])[-1]
    for lines in (names([row(found)]), sites([row(found)]), paths([row(found)])):
        assert len({line.count("|") for line in lines}) == 1
    assert misses([row(found)]) == ["- none"]


def test_an_upper_bound_is_said_as_one() -> None:
    cause = report()["causes"][0] | {"severity": None, "values": {"slip": 0.001, "width_below_m": 4e-3}}
    found = report(causes=[cause], sentence="A defect.")
    assert told.size(found) == "below 4.0 mm" and told.first_size(found) is None
    said = " ".join(summary([row(found)]))
    assert "0 are given a size" in said and "For 1 only an upper bound is given, no size: 1 of them" in said
    assert "1 are given a size" in " ".join(summary([row(report())]))


@pytest.mark.parametrize(
    ("rig", "condition", "verdict", "causes", "word"),
    [
        ("cwru", "outer-race fault", "explained", [("outer_spall", "drive_end")], "right"),
        ("cwru", "outer-race fault", "explained", [("outer_spall", "fan_end")], "wrong"),
        ("uestc", "ball fault", "ambiguous", [("inner_spall", "bearing"), ("ball_spall", "bearing")], "undecided"),
        ("uestc", "ball fault", "explained", [("inner_spall", "bearing")], "wrong"),
        ("ims_healthy", "healthy", "nothing_missing", [], "right"),
        ("ims_healthy", "healthy", "ambiguous", [("unbalance", "shaft")], "wrong"),
        ("openei_gear", "broken tooth", "measurement_fault", [], "wrong"),
    ],
)
def test_reports_are_judged_by_the_truth(
    rig: str, condition: str, verdict: str, causes: list[tuple[str, str]], word: str
) -> None:
    found = report(verdict=verdict, causes=[{"term": t, "site": s} for t, s in causes])
    assert judged(rig, condition, found, None) == word


def test_irregular_time_must_be_said() -> None:
    assert judged("motor_phone_accel", "unbalance (2 weights)", None, "error: time: stamps are irregular") == "refused"
    assert judged("motor_phone_accel", "unbalance (2 weights)", None, "error: no such file") == "wrong"


def test_seeded_lengths_lie_on_their_race() -> None:
    assert true_width_m("hit_mfs_OR8_1200") == pytest.approx(3.28e-3, rel=0.01)
    assert true_width_m("hit_mfs_IR8_1200") == pytest.approx(2.17e-3, rel=0.01)
    assert true_width_m("O_1000_1") == 0.55e-3
    assert true_width_m("h30hz50") is None


def test_measured_input_stands_on_the_page() -> None:
    validation = {
        "stage": "validate", "held": "first third", "fitted_on": "last third", "before": 0.26, "after": 0.0072,
        "retuned": 0.13, "black_box": 0.39, "placebo": 0.02,
    }  # fmt: skip
    said = (
        "What is missing at mass is cubic support, odd stiffness (z³); the exponent of the odd part left free is 2.96."
    )
    stages = [{"stage": "fit", "exponent_by_free_run": [2.96, 2.94, 2.97]}, validation]
    found = report(sentence=said, stages=stages)
    text = page.page([row(report())], [(driven.SYSTEMS[0], Answer(report=found, error=None, wall_s=2.0))], limit_s=60.0)
    assert "exponent 2.96 (2.94 to 2.97) | right |" in text
    assert "| 26 % | 0.72 % | 23 % | 16 % | 25 % | 0.44 % |" in text
    failed = driven.judged(driven.SYSTEMS[1], Answer(report=None, error="no answer", wall_s=9.0))
    assert failed == "wrong"
