"""What the card says of a background and of recordings left out."""

from __future__ import annotations

from sideband_datasets.folder.added import added
from tests.sideband_datasets.beside import siblings
from tests.sideband_datasets.small import tiny


def test_a_recipe_without_any_of_it_says_nothing():
    assert added(tiny()) == ""


def test_ranges_sources_and_choice_are_told():
    text = added(siblings(background={"rolling": {"outer": 0.25}, "knocks": {"share": 0.5}}, shown_db=-5.0))
    assert "Antoni & Randall 2003" in text and "outer 0.25" in text
    assert "knocks, in a share of 0.5 of the machines" in text
    assert "neighbours" not in text
    assert "adds -5 dB" in text and "differ by the fault alone" in text
