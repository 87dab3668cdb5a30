"""Channels with other names are the same channels where place, axis, quantity and unit agree."""

from __future__ import annotations

import numpy as np
import pytest

from reconcile.entry import reconcile_recordings
from reconcile.kinematics import read_kinematic_spec
from reconcile.one_names import by_one_name
from signals.recording import Operating, Recording
from sim.core.response import Channel

RATE_HZ, N = 12_800.0, 25_600
KINEMATICS = {"kinematics": {"shafts": [{"name": "shaft"}]}}


def recording(names: tuple[str, ...], seed: int = 1, locations: tuple[str, ...] = ("", "")) -> Recording:
    time_s = np.arange(N) / RATE_HZ
    rng = np.random.default_rng(seed)
    rows = [np.sin(2 * np.pi * 29.5 * k * time_s) + 0.2 * rng.standard_normal(N) for k in (1, 2)]
    channels = tuple(
        Channel(name=n, quantity="acceleration", unit="m/s^2", location=where, axis="y")
        for n, where in zip(names, locations, strict=True)
    )
    operating = Operating(shaft="shaft", speed_hz=29.5)
    return Recording(sampling_rate_hz=RATE_HZ, channels=channels, samples=np.stack(rows), operating=operating)


def test_names_of_the_first_test_hold_for_all() -> None:
    test, other = recording(("de", "fe")), recording(("ch1", "fe"), 2)
    (tests, baselines), told = by_one_name([test], [other])
    assert tests == [test] and baselines[0].names == ("de", "fe")
    assert np.array_equal(baselines[0].samples, other.samples)
    (said,) = told
    assert "have other names (ch1, fe) than those of" in said and said.endswith("(de, fe): matched by their order")


def test_the_same_names_in_another_order_tell_which_is_which() -> None:
    other = recording(("fe", "de"), 2)
    (_, (turned,)), (said,) = by_one_name([recording(("de", "fe"))], [other])
    assert turned.names == ("de", "fe") and np.array_equal(turned.samples, other.samples[::-1])
    assert "matched by their names" in said


def test_a_place_goes_before_a_name() -> None:
    places = ("drive_end", "fan_end")
    first, other = recording(("a", "b"), locations=places), recording(("b", "a"), 2, locations=places)
    (_, (named,)), _ = by_one_name([first], [other])
    assert named.names == ("a", "b") and np.array_equal(named.samples, other.samples)


def test_nothing_is_said_where_names_agree() -> None:
    first, other = recording(("de", "fe")), recording(("de", "fe"), 2)
    assert by_one_name([first, other], []) == (([first, other], []), ())


@pytest.mark.slow
@pytest.mark.parametrize("names", [("ch1", "fe"), ("x", "y")])
def test_recordings_with_other_names_are_reconciled(names: tuple[str, str]) -> None:
    spec = read_kinematic_spec(KINEMATICS)
    report = reconcile_recordings(spec, [recording(names)], [recording(("de", "fe"), 2)])
    assert report.verdict == "nothing_missing"
    assert any("other names (de, fe)" in limit for limit in report.where.limits)
    alone = reconcile_recordings(spec, [recording(("de", "fe")), recording(names, 2)])
    assert alone.verdict in ("nothing_missing", "not_decidable")


def test_the_same_channels_with_their_places_in_another_order_are_matched() -> None:
    places = ("drive_end", "fan_end")
    first, other = recording(("de", "fe"), locations=places), recording(("fe", "de"), 2, locations=places[::-1])
    (_, (turned,)), (said,) = by_one_name([first], [other])
    assert turned.channels == first.channels and np.array_equal(turned.samples, other.samples[::-1])
    assert "matched by their names" in said
