"""What an effect adds: the machine with it less the same machine without it, row by row as recorded."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.atlas.plan import AtlasPlan, Draw, Point, with_tooth_pairs
from reconcile.atlas.run import RATE_HZ, SETTLE_S, SPAN_S, run_members
from reconcile.calibrate.uncertain import Offsets
from reconcile.machine.added import Place, place_at
from sim.core.response import Response
from sim.core.spec import TermSpec
from sim.presets import preset

POINT = Point(speed_hz=30.0)
HEARD = ("bearing2.outer.y.acceleration", "bearing1.outer.y.acceleration", "bearing2.outer.y.acceleration")


def place() -> Place:
    rest = tuple(Offsets(values=np.zeros(0)) for _ in range(2))
    machine = with_tooth_pairs(preset("paper"))
    plan = AtlasPlan(machine=machine, numbers=(), offsets=rest, twins=rest, draws=(), seed=3)
    data = (SimpleNamespace(point=POINT),)
    return place_at(SimpleNamespace(machine=machine, plan=plan, data=data, simulated=HEARD), 0)  # type: ignore[arg-type]


def pit(width: float) -> TermSpec:
    return TermSpec(term="inner_spall", site="bearing1", parameters={"width": width})


def test_rows_are_those_of_the_recording_and_channels_are_simulated_once() -> None:
    at = place()
    assert at.channels == ("bearing1.outer.y.acceleration", "bearing2.outer.y.acceleration")
    assert at.rows == (1, 0, 1) and at.point.speed_hz == POINT.speed_hz


@pytest.mark.slow
def test_motion_with_the_effect_less_that_without() -> None:
    at = place()
    small, large, nothing = at.added([pit(8e-4), pit(2e-3), pit(0.0)])
    assert small is not None and large is not None and nothing is None
    assert small.shape == (3, round(SPAN_S * RATE_HZ)) and np.array_equal(small[0], small[2])
    assert np.std(large[1]) > 2.0 * np.std(small[1]) > 0.0, "the larger pit strikes harder"
    members = [at.plan.member(Draw(pair=0, term=t), POINT) for t in (None, pit(8e-4))]
    without, struck = run_members(members, at.channels)
    assert isinstance(without, Response) and isinstance(struck, Response)
    own = (struck.signals - without.signals)[:, round(SETTLE_S * RATE_HZ) :]
    assert np.std(small[1] - own[0]) < 0.05 * np.std(own[0])


@pytest.mark.slow
def test_effects_share_the_machines_without_them() -> None:
    at = place()
    one, other = at.added_by([[pit(8e-4)], [pit(2e-3)]])
    alone = at.added([pit(2e-3)])
    assert one[0] is not None and other[0] is not None and alone[0] is not None
    assert np.array_equal(other[0], alone[0]) and not np.array_equal(one[0], other[0])
    assert at.added_by([]) == []
