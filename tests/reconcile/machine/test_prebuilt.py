"""The small atlases beside the tests of whole reconciliations are what the simulator gives today."""

from __future__ import annotations

import pytest

from tests.reconcile import prebuilt
from tests.reconcile.machine import test_joint_fit as joint
from tests.reconcile.machine import test_reconcile_machine as spall

EVERY = (spall.wanted(), *joint.wanted())


@pytest.mark.slow
@pytest.mark.parametrize("now", EVERY, ids=[now.bank.stem for now in EVERY])
def test_the_small_atlases_are_what_the_simulator_gives_today(now: prebuilt.Wanted) -> None:
    why = prebuilt.stale(now)
    if why is not None:
        pytest.fail(why, pytrace=False)
    found = prebuilt.deviation_db(now, -1)
    assert max(found.values()) < prebuilt.SAME_DB, f"the physics changed (dB: {found}): {prebuilt.REMAKE}"
