"""Where to record next hangs on where the channels stand."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from reconcile.kinematics.record_at import record_at
from reconcile.verdict import PlaceWeight

OPEN = (PlaceWeight(site="drive_end", weight=0.5), PlaceWeight(site="fan_end", weight=0.5))
SURE = (PlaceWeight(site="gearbox", weight=0.9), PlaceWeight(site="drive_end", weight=0.1))


def told(*locations: str | None, weights: tuple[tuple[PlaceWeight, ...], ...] = (OPEN,)) -> str:
    channels = tuple(SimpleNamespace(location=place) for place in locations)
    test = SimpleNamespace(recording=SimpleNamespace(channels=channels))
    return record_at(weights, [test]).sentence  # type: ignore[list-item]


@pytest.mark.parametrize("locations", [(None,), (None, None), ("gearbox",)])
def test_where_no_channel_stands_at_one_of_them_the_description_must_say_where(locations: tuple[str | None]) -> None:
    assert "one sensor on each of the bearings" in told(*locations) and "(location)" in told(*locations)


def test_a_bearing_without_a_sensor_is_named() -> None:
    assert told("drive_end", None).endswith("none is said to stand at fan_end.")
    assert told("fan_end", "gearbox").endswith("none is said to stand at drive_end.")


def test_no_sensor_is_asked_for_that_is_there() -> None:
    assert "these do not decide" in told("drive_end", "fan_end")


def test_only_bearings_that_are_open_count() -> None:
    assert told("drive_end", "fan_end", weights=(SURE, OPEN)) == told("drive_end", "fan_end")
