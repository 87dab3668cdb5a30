"""What a recording's description says of its machine's bearings."""

from __future__ import annotations

from typing import Any

import pytest

from reconcile.kinematics import described_kinematics
from reconcile.kinematics.families import ties
from signals.ingest import read_description
from sim.core.errors import SpecError

ABOUT: dict[str, Any] = {
    "sampling_rate_hz": 1e4,
    "channels": [{"name": "a", "unit": "g"}],
    "operating": {"shaft": "motor", "speed_hz": 30.0},
}
ORDERS = {"bpfo": 3.5848, "bpfi": 5.4152}
SIZES = {"balls": 9, "ball_diameter_m": 0.00794, "pitch_diameter_m": 0.03904}


@pytest.mark.parametrize("bearing", ["6205", {"catalogue": "6205"}, {"orders": ORDERS}, SIZES])
def test_one_bearing_on_the_shaft_whose_speed_is_told(bearing: object) -> None:
    spec = described_kinematics(read_description({**ABOUT, "bearing": bearing}))
    assert spec is not None and [s.name for s in spec.shafts] == ["motor"]
    found = {f.kind: f.order for f in ties(spec, "motor").families if f.site == "bearing"}
    assert found["outer"] == pytest.approx(ORDERS["bpfo"], rel=1e-3)
    assert found["inner"] == pytest.approx(ORDERS["bpfi"], rel=1e-3)


def test_the_tachos_shaft_where_no_speed_is_told() -> None:
    about = {k: v for k, v in ABOUT.items() if k != "operating"}
    tacho = {"shaft": "input", "pulse_times_s": [0.0, 0.1, 0.2]}
    spec = described_kinematics(read_description({**about, "tacho": tacho, "bearing": "6205"}))
    assert spec is not None and spec.bearings[0].shaft == "input"


def test_a_whole_drawing_says_the_same_and_nothing_says_nothing() -> None:
    drawing = {
        "shafts": [{"name": "motor"}],
        "bearings": [{"name": "bearing", "shaft": "motor", "catalogue": "6205"}],
    }
    short = described_kinematics(read_description({**ABOUT, "bearing": "6205"}))
    assert described_kinematics(read_description({**ABOUT, "kinematics": drawing})) == short
    assert described_kinematics(read_description(ABOUT)) is None


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"bearing": {"balls": 9}}, "bearing"),
        ({"bearing": {"catalog": "6205"}}, "bearing.catalog"),
        ({"bearing": {"orders": {"bpfo": -1, "bpfi": 5}}}, "bearing.orders.bpfo"),
        ({"bearing": "6205", "kinematics": {"shafts": [{"name": "motor"}]}}, "bearing"),
    ],
)
def test_what_is_wrong_is_told_at_the_field_that_was_written(changes: dict[str, Any], field: str) -> None:
    with pytest.raises(SpecError) as caught:
        described_kinematics(read_description({**ABOUT, **changes}))
    assert [p.field for p in caught.value.problems] == [field]


def test_a_bearing_that_is_neither_text_nor_object_is_refused() -> None:
    with pytest.raises(SpecError) as caught:
        read_description({**ABOUT, "bearing": 7})
    assert {p.field for p in caught.value.problems} == {"bearing"}
