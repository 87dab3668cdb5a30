"""Siblings, and what contradicts them."""

from __future__ import annotations

import numpy as np
import pytest

from sideband_datasets import make_plan
from sideband_datasets.plan import drawing
from sim.core.errors import SpecError
from tests.sideband_datasets.beside import siblings

CHAIN = {"name": "probe", "chain": {"channels": [{"kind": "proximity", "name": "p", "place": {"location": "disc"}}]}}


def test_every_machine_is_recorded_once_in_every_class_and_stays_in_one_split():
    plan = make_plan(siblings())
    for m in range(len(plan.machines)):
        assert list(plan.kind[plan.machine == m]) == [0, 1, 2]
    assert {plan.split(number) for number in range(12)} == {"train", "test"}


def test_siblings_differ_by_the_fault_alone():
    plan = make_plan(siblings())
    sound, outer = drawing(plan, 0), drawing(plan, 1)
    assert (sound.noise_seed, sound.shift, sound.chain, sound.sound) == (
        outer.noise_seed,
        outer.shift,
        outer.chain,
        outer.sound,
    )
    assert sound.spec == sound.sound != outer.spec
    assert drawing(plan, 3).noise_seed != sound.noise_seed


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"count": 13}, "count"),
        ({"speeds_hz": {"low": 20, "high": 30}}, "speeds_hz"),
        ({"torques_nm": 3.0}, "torques_nm"),
        ({"conditions": {"gravity_m_per_s2": 9.0}}, "conditions"),
        ({"healthy_share": 0.5}, "healthy_share"),
        ({"background": {"chain_in_levels": True}, "measurement": []}, "background.chain_in_levels"),
        ({"background": {"chain_in_levels": True}, "measurement": [CHAIN]}, "measurement.0.chain.channels.0.kind"),
    ],
)
def test_what_contradicts_is_named(changes, field):
    with pytest.raises(SpecError) as told:
        make_plan(siblings(**changes))
    assert field in {problem.field for problem in told.value.problems}


def test_the_recordings_of_a_family_lie_together():
    plan = make_plan(siblings())
    assert np.all(np.diff(np.flatnonzero(plan.machine == plan.machine[0])) == 1)
