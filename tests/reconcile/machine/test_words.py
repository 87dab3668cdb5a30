"""What stands beside a named effect is said, in words, as far as it is known."""

from __future__ import annotations

from reconcile.machine.words import LISTED, more


def test_places_that_share_impacts_are_listed() -> None:
    said = more("impacts come from another part too", ("outer_spall@bearing4", "outer_spall@bearing3"))
    assert said == (
        " Impacts come from another part too: outer-race spall at bearing4, or outer-race spall at bearing3."
    )


def test_a_long_list_ends_with_how_many_there_are_more() -> None:
    names = [f"outer_spall@bearing{k}" for k in range(LISTED + 2)]
    assert more("impacts come from another part too", names).endswith("bearing3, or one of 2 more.")


def test_nothing_is_said_of_nothing() -> None:
    assert more("impacts come from another part too", ()) == ""
