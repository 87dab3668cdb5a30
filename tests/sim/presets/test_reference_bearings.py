"""Bearings of a reference file: places by name, refusals by field."""

from __future__ import annotations

import pytest

from sim.core.errors import SpecError
from sim.presets.reference.bearings import entries


def test_named_places_decide_the_order():
    named = [{"name": f"bearing{i}", "balls": 6 + i, "ratio": 0.2 + 0.01 * i} for i in (4, 1, 3, 2)]
    found = entries(named)
    assert found is not None
    assert [e.geometry.balls for e in found] == [7, 8, 9, 10]
    as_object = entries({item["name"]: {k: v for k, v in item.items() if k != "name"} for item in named})
    assert as_object == found


def test_places_that_are_missing_are_named():
    wrong = {f"bearing{i}": {"balls": 7, "ratio": 0.26} for i in (1, 2, 3, 10)}
    with pytest.raises(SpecError, match="bearing4"):
        entries(wrong)


def test_names_that_are_no_places_are_labels():
    found = entries([{"name": n, "balls": b, "ratio": 0.25} for n, b in (("left", 7), ("right", 9))])
    assert found is not None
    assert [e.geometry.balls for e in found] == [7, 7, 9, 9]


def test_a_steep_contact_is_refused_by_name():
    with pytest.raises(SpecError, match="contact_angle_deg"):
        entries([{"balls": 8, "ratio": 0.25, "contact_angle_deg": 80}])
