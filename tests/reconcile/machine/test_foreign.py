"""Impacts at an order that no part of the machine file has are told, with the nearest part's; others are not."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.machine.direct import NOTHING, Direct
from reconcile.machine.foreign import with_foreign
from reconcile.observe.observation import observe
from reconcile.observe.watch import bases_at, watch_list
from reconcile.report.action import to_do
from reconcile.verdict import NextExperiment, Report, Word
from sim.presets import preset
from tests.reconcile.machine.test_direct import CHANNELS, SPEED_HZ, recording, sound, struck

MACHINE = preset("paper-lightly-damped")
ORDER = 3.66
"""Of the outer race of a bearing with other numbers: 27 % beyond that of this machine's."""


def told(
    hit: np.ndarray,
    *,
    verdict: Word = "unknown_physics",
    advice: NextExperiment | None = None,
    direct: Direct = NOTHING,
    based: bool = True,
) -> Report:
    rested = [recording(sound(1))] if based else []
    data = observe(MACHINE, watch_list(MACHINE), [recording(hit)], rested)
    setting = SimpleNamespace(machine=MACHINE, data=data, direct=direct, seed=0)
    report = Report(verdict=verdict, sentence="None fits.", level="machine", next_experiment=advice)
    return with_foreign(report, setting, CHANNELS)  # type: ignore[arg-type]


@pytest.mark.slow
def test_an_order_of_no_part_is_told_with_the_nearest() -> None:
    hit = sound(2) + 20 * struck(ORDER * SPEED_HZ)
    report = told(hit, advice=NextExperiment(sentence="Add a sensor."))
    assert report.verdict == "unknown_physics"
    assert "impacts come 3.6" in report.sentence and "nearest: balls of bearing1, 3.513" in report.sentence
    assert "another bearing" in report.undecidable[0]
    assert "Check the numbers of the bearings" in to_do(report) and "Add a sensor." in to_do(report)
    assert "Check the numbers" in to_do(told(hit))
    assert told(hit, verdict="nothing_missing").sentence == "None fits."
    assert told(hit, direct=Direct(evidence={"outer_spall@bearing1": 9.0}, p=1e-4, told=())).sentence == "None fits."
    faint = Direct(evidence={"outer_spall@bearing1": 1.0}, p=0.3, told=())
    assert "impacts come 3.6" in told(hit, direct=faint).sentence
    assert told(hit, based=False).sentence == "None fits."


@pytest.mark.slow
def test_a_part_s_own_order_and_none_at_all_are_not() -> None:
    own = bases_at(MACHINE, SPEED_HZ)["f_o1"]
    assert told(sound(2) + 20 * struck(own * 1.01)).sentence == "None fits."
    assert told(sound(2)).sentence == "None fits."
