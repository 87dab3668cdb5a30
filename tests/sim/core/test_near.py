"""Suggestions for names that nearly fit."""

from __future__ import annotations

import pytest

from sim.core.errors import UnknownName
from sim.core.near import did_you_mean, likest, near

SITES = ("bearing1", "bearing2", "bearing3", "bearing4", "pinion")


@pytest.mark.parametrize(
    ("given", "known", "hint"),
    [
        ("tooth_crak", ("tooth_crack", "tooth_friction", "rub"), " (did you mean tooth_crack?)"),
        ("papper", ("paper", "paper-demo", "rotor"), " (did you mean paper?)"),
        ("PAPER", ("paper", "rotor"), " (did you mean paper?)"),
        ("bearing9", SITES, " (did you mean bearing1, bearing2, bearing3 or bearing4?)"),
        ("zzz", SITES, ""),
        ("", SITES, ""),
        ("x", (), ""),
    ],
)
def test_the_likest_names_are_suggested(given, known, hint):
    assert did_you_mean(given, known) == hint


def test_several_that_are_less_like_follow():
    assert near("tooth_crak", ("tooth_friction", "tooth_crack"), like=0.5) == ["tooth_crack", "tooth_friction"]
    assert likest("tooth_crak", ("tooth_friction", "tooth_crack")) == ["tooth_crack"]


def test_an_unknown_name_says_what_was_meant():
    assert "(did you mean icp-magnet?)" in str(UnknownName("sensor", "icp-magnt", ("icp-magnet", "encoder-1024")))
