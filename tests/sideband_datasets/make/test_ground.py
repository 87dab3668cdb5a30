"""What the rolling noise at a part follows."""

from __future__ import annotations

import numpy as np
import pytest

from sideband_datasets import make_plan, rows
from sideband_datasets.plan.ground import ground_of
from tests.sideband_datasets.beside import siblings

DEEP = {"level": 5.0, "shaft": 0.0, "twice_shaft": 0.0, "outer": 0.9, "inner": 0.0, "ball": 0.0, "cage": 0.0}


@pytest.mark.slow
def test_rolling_noise_follows_the_balls_of_the_bearing_where_the_sensor_sits():
    block = {"level": 30.0, "rolling": {**DEEP, "foreign": 0.0}}
    chain = [{"name": "ring", "chain": {"channels": [{"kind": "accelerometer", "name": "de", "place": {
        "location": "bearing1.outer"}}]}}]  # fmt: skip
    row = next(rows(siblings(background=block, measurement=chain, windows={}, duration_s=2.0), [0]))
    power = row.signal.astype(float) ** 2
    lines = np.abs(np.fft.rfft(power)) / np.abs(np.fft.rfft(power)[0]) * 2
    at = round(row.bpfo_hz * row.samples / row.sampling_rate_hz)
    assert lines[at - 1 : at + 2].max() == pytest.approx(0.9, abs=0.25)
    assert np.median(lines[20:1000]) < 0.1


def test_a_background_is_drawn_once_a_machine_and_ingredients_do_not_move_each_other():
    one, other = siblings(), siblings(background={"rolling": {}})
    plans = make_plan(one), make_plan(other)
    grounds = [ground_of(one, machine) for machine in plans[0].machines]
    assert grounds == [ground_of(one, machine) for machine in plans[0].machines]
    assert len({ground.level for ground in grounds}) == len(grounds)
    alone = [ground_of(other, machine) for machine in plans[1].machines]
    assert [(g.level, g.rolling) for g in grounds] == [(g.level, g.rolling) for g in alone]
    assert all(g.knocks is None and g.neighbours is None and g.axis is None for g in alone)


def test_a_share_of_the_machines_has_an_ingredient():
    recipe = siblings(background={"knocks": {"share": 0.0}, "neighbours": {"share": 1.0}})
    grounds = [ground_of(recipe, machine) for machine in make_plan(recipe).machines]
    assert all(g.knocks is None and g.neighbours is not None for g in grounds)
    assert {len(g.neighbours[1]) for g in grounds} <= {1, 2, 3}
