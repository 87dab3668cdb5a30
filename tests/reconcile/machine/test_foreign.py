"""Impacts at an order that no part of the machine file has are told, with the nearest part's; others are not."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from reconcile.machine.direct import NOTHING, Direct
from reconcile.machine.foreign import with_foreign
from reconcile.observe import steady
from reconcile.observe.observation import observe
from reconcile.observe.watch import bases_at, watch_list
from reconcile.report.action import NO_PART, to_do
from reconcile.speed.follow import followed_angle
from reconcile.verdict import NextExperiment, Report
from signals.recording import Operating
from sim.presets import preset
from tests.reconcile.machine.test_direct import CHANNELS, SPEED_HZ, recording, sound, struck

MACHINE = preset("paper-lightly-damped")
ORDER = 3.21
"""Of the outer race of a bearing with other numbers, a quarter beyond this machine's; 2 % from any multiple of a part's
line of its own."""


def strikes_at(order: float, seed: int = 2) -> np.ndarray:
    return sound(seed) + 20 * struck(order * SPEED_HZ)


FOREIGN = strikes_at(ORDER)
ANGLES: dict[tuple[bytes, float], np.ndarray | None] = {}


@pytest.fixture(autouse=True)
def angles_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each signal's angle is followed once, in however many tests and at whatever load it comes."""

    def followed(samples: np.ndarray, rate_hz: float, speed_hz: float, **about: Any) -> np.ndarray | None:
        key = samples.tobytes(), speed_hz
        if key not in ANGLES:
            ANGLES[key] = followed_angle(samples, rate_hz, speed_hz, **about)
        return ANGLES[key]

    monkeypatch.setattr(steady, "followed_angle", followed)


REPORT = Report(verdict="unknown_physics", sentence="None fits.", level="machine")


def asked(
    *hits: np.ndarray,
    report: Report = REPORT,
    direct: Direct = NOTHING,
    rested: np.ndarray | None = None,
    based: bool = True,
) -> Report:
    """What is said of tests at as many loads, against a sound baseline at each."""
    loads = [Operating(shaft="input", speed_hz=SPEED_HZ, torque_nm=25.0 - 5.0 * k) for k in range(len(hits))]
    before = sound(1) if rested is None else rested
    tests, baselines = (
        [replace(recording(x), operating=at) for x, at in zip(several, loads, strict=True)]
        for several in (hits, [before] * len(hits))
    )
    data = observe(MACHINE, watch_list(MACHINE), tests, baselines if based else [])
    assert len(data) == len(hits)
    setting = SimpleNamespace(machine=MACHINE, data=data, direct=direct, seed=0)
    return with_foreign(report, setting, CHANNELS)  # type: ignore[arg-type]


def said(report: Report) -> bool:
    return NO_PART in report.sentence


@pytest.mark.slow
def test_an_order_of_no_part_is_told_with_the_nearest() -> None:
    report = asked(FOREIGN, report=replace(REPORT, next_experiment=NextExperiment(sentence="Add a sensor.")))
    assert report.verdict == "unknown_physics"
    assert "impacts come 3.2" in report.sentence and "nearest: balls of bearing1, 3.513" in report.sentence
    assert "another bearing" in report.undecidable[0]
    assert "Check the numbers of the bearings" in to_do(report) and "Add a sensor." in to_do(report)
    assert "Check the numbers" in to_do(asked(FOREIGN))
    named = asked(FOREIGN, report=replace(REPORT, verdict="explained"))
    assert to_do(named).startswith("check the numbers of the bearings in the machine file and ask again")


@pytest.mark.slow
def test_no_one_looks_where_nothing_is_missing_or_a_part_is_heard() -> None:
    assert not said(asked(FOREIGN, report=replace(REPORT, verdict="nothing_missing")))
    assert not said(asked(FOREIGN, report=replace(REPORT, verdict="measurement_fault")))
    pit = {"outer_spall@bearing1": 9.0}
    assert not said(asked(FOREIGN, direct=Direct(evidence=pit, p=1e-4, told=())))
    assert not said(asked(FOREIGN, direct=Direct(evidence={}, p=1e-4, told=(), struck=(pit,))))
    assert said(asked(FOREIGN, direct=Direct(evidence={"outer_spall@bearing1": 1.0}, p=0.3, told=())))
    assert not said(asked(FOREIGN, based=False))


@pytest.mark.slow
@pytest.mark.parametrize("base", ["f_o1", "f_i1", "f_c1", "f_r1"])
def test_a_part_s_own_order_is_not_foreign_though_nothing_says_it_is_heard(base: str) -> None:
    hz = bases_at(MACHINE, SPEED_HZ)[base]
    assert not said(asked(sound(2) + 20 * struck(hz * (1.0 if base == "f_r1" else 1.005))))


@pytest.mark.slow
def test_what_only_grew_or_is_nothing_is_not() -> None:
    assert not said(asked(sound(2)))
    assert not said(asked(FOREIGN, rested=sound(1) + 19 * struck(ORDER * SPEED_HZ))), "the baseline has it too"


@pytest.mark.slow
def test_it_must_keep_to_its_order_in_most_tests() -> None:
    assert said(asked(*(strikes_at(ORDER, k) for k in (2, 3, 4))))
    assert said(asked(FOREIGN, strikes_at(ORDER, 3), sound(4)))
    assert not said(asked(FOREIGN, sound(3), sound(4))), "in one of three"
    assert not said(asked(*(strikes_at(order, 2) for order in (2.71, ORDER, 3.29)))), "three machines, or one in Hz"
