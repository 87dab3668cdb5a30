"""What a second effect must add by sums to be simulated, and by how much it must lead."""

from __future__ import annotations

import pytest

from reconcile.machine.asked import (
    LEAD,
    LEAD_BESIDE_PLAY,
    PROMISING,
    PROMISING_BESIDE_PLAY,
    least_lead,
    promising,
)

UNBALANCE, PLAY, PIT = "unbalance@gear", "radial_clearance@bearing4", "outer_spall@bearing1"


@pytest.mark.parametrize(
    ("first", "second", "least"),
    [
        (UNBALANCE, PLAY, PROMISING),
        (PLAY, UNBALANCE, PROMISING_BESIDE_PLAY),
        (PLAY, PIT, PROMISING),  # whose impacts count too
    ],
)
def test_beside_a_play_only_what_adds_more_by_sums_is_simulated(first: str, second: str, least: float) -> None:
    assert promising(first, second) == least and PROMISING < PROMISING_BESIDE_PLAY


def test_beside_a_play_a_second_leads_by_more() -> None:
    assert (least_lead(UNBALANCE), least_lead(PLAY)) == (LEAD, LEAD_BESIDE_PLAY) and LEAD < LEAD_BESIDE_PLAY
