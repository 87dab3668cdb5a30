"""Tests whose channels were exchanged, or are in another unit, are told by how much better they fit put right."""

from __future__ import annotations

from dataclasses import dataclass, replace
from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.machine import mistaken
from reconcile.machine.beaten import BEATEN
from reconcile.machine.mistaken import Correction, Fit, corrections, with_mistaken
from reconcile.machine.proved import UNLIKE
from reconcile.observe.statistics import Statistics
from reconcile.report.action import to_do
from reconcile.verdict import Cause, HeldOut, Report
from sim.core.response import Channel

TRUE = np.array([1.0, 5.0])
"""What two sensors hear of the pit beside the first of them."""


def channel(name: str, unit: str = "m/s^2", quantity: str = "acceleration") -> Channel:
    return Channel(name=name, quantity=quantity, unit=unit, location=name, axis="y")  # type: ignore[arg-type]


CHANNELS = (channel("drive"), channel("free"))
CAUSE = Cause(term="outer_spall", site="fan_end", score=9.0, named=True)
UNKNOWN = Report(verdict="unknown_physics", sentence="Nothing known.", level="machine")
DOUBTED = replace(
    UNKNOWN, verdict="explained", sentence="A pit.", undecidable=(f"the name {BEATEN} others",), causes=(CAUSE,)
)


def statistics(level: np.ndarray) -> Statistics:
    one, two = np.repeat(level[:, None], 2, axis=1), np.zeros((2, 1, 1))
    return Statistics(
        line=one, floor=one, total=one, band=one, depth=two, turn=two, kurtosis=one, skewness=one,
        phase=np.array([[0.1], [0.2]]), resolution_hz=1.0, duration_s=1.0,
    )  # fmt: skip


class View:
    """Two effects, each a level of two sensors in dB; what is left grows with the distance from them."""

    overdispersion = 1.0

    def __init__(self, misfit: float = 0.2) -> None:
        self.misfit = misfit
        known = 10 * np.log10(np.stack([TRUE, TRUE[::-1] * 1.8]))
        self.paths = SimpleNamespace(
            names=("outer_spall@drive_end", "outer_spall@fan_end"),
            owner=np.arange(2),
            distances=lambda x: np.sum((known - x) ** 2, axis=1),
        )

    def place(self, observed: np.ndarray) -> np.ndarray:
        return observed


@pytest.fixture
def told(monkeypatch: pytest.MonkeyPatch):  # type: ignore[no-untyped-def]
    monkeypatch.setattr(mistaken, "observed_only", lambda data, *_: 10 * np.log10(data[0].test.line[:, 0]))
    monkeypatch.setattr(mistaken, "quantile_of_misfit", lambda view, left, _: view.misfit if left < 20.0 else 1.0)

    def ask(
        report: Report,
        level: np.ndarray,
        *,
        view: View | None = None,
        based: bool = True,
        heard: dict[str, float] | None = None,
    ) -> Report:
        @dataclass
        class Data:
            test: Statistics
            baseline: Statistics | None

        data = (Data(statistics(level), statistics(TRUE) if based else None),)
        setting = SimpleNamespace(data=data, seen_through=(), plan=None)
        return with_mistaken(report, setting, view or View(), CHANNELS, heard or {})  # type: ignore[arg-type]

    return ask


def test_a_unit_that_makes_the_tests_explainable_is_the_answer(told) -> None:  # type: ignore[no-untyped-def]
    found = told(UNKNOWN, TRUE / 9.80665**2)
    assert found.verdict == "measurement_fault" and found.causes == () and found.machine is None
    assert "g described as m/s^2: outer spall at drive_end then does" in found.sentence
    assert found.sentence.startswith("The mismatch may be in the measurement: ")
    assert found.fault is not None and found.fault.kind == "unit_mismatch" and found.fault.doubtful
    assert "nothing needs to be recorded anew" in to_do(found)
    other = told(UNKNOWN, TRUE * 9.80665**2)
    assert "m/s^2 described as g" in other.sentence


def test_a_doubted_name_that_fits_better_with_sensors_exchanged_is_none(told) -> None:  # type: ignore[no-untyped-def]
    found = told(DOUBTED, TRUE[::-1])
    assert found.verdict == "ambiguous" and not any(c.named for c in found.causes)
    assert "Either outer spall at fan_end, or drive and free exchanged in the tests" in found.sentence
    assert found.fault is not None and found.fault.channel == "drive and free"
    assert to_do(found).startswith("put the channels of the tests in their right order (here drive and free)")
    assert "inspect" not in to_do(found) and "Look which sensor is which channel" in to_do(found)


@pytest.mark.parametrize(("behind", "heard"), [(2.5, True), (3.5, False)])
def test_a_name_that_hardly_leads_its_twin_is_none_where_sensors_exchanged_fit_better(  # type: ignore[no-untyped-def]
    told, behind: float, heard: bool
) -> None:
    twin = Cause(term="outer_spall", site="drive_end", score=CAUSE.score - behind, named=False)
    other = Cause(term="unbalance", site="drive_end", score=CAUSE.score - 0.5, named=False)
    near = replace(UNKNOWN, verdict="explained", sentence="A pit.", causes=(CAUSE, other, twin))
    found = told(near, TRUE[::-1])
    assert (found.verdict, found.fault is not None) == (("ambiguous", True) if heard else ("explained", False))
    assert told(near, TRUE) is near, "as it is it fits"
    by_hearing = told(near, TRUE[::-1], heard={"outer_spall@drive_end": behind - 1.0})
    assert by_hearing.verdict == "ambiguous", "which sensor hears which band is exchanged with the sensors"
    assert told(replace(near, causes=(CAUSE, other)), TRUE[::-1]).verdict == "explained", "no twin is near"


@pytest.mark.parametrize(("low", "word"), [(-0.01, "ambiguous"), (0.02, "explained")])
def test_a_name_that_forecasts_nothing_is_asked_too(told, low: float, word: str) -> None:  # type: ignore[no-untyped-def]
    held = HeldOut(
        metric="level", unit="dB", before=3.9, after=3.8, gain=0.02, gain_low=low, gain_high=0.04, retuned=None,
        black_box=None, placebo=None,
    )  # fmt: skip
    name = replace(UNKNOWN, verdict="explained", sentence="A pit.", causes=(CAUSE,), held_out=held)
    assert told(name, TRUE[::-1]).verdict == word
    assert told(name, TRUE) is name, "as it is it fits"


def test_impacts_whose_machine_is_far_off_are_sensors_exchanged_where_that_fits(told) -> None:  # type: ignore[no-untyped-def]
    unlike = replace(UNKNOWN, verdict="not_decidable", undecidable=(UNLIKE,), causes=(replace(CAUSE, named=False),))
    found = told(unlike, TRUE[::-1])
    assert found.verdict == "measurement_fault" and found.fault is not None and found.fault.kind == "swapped_channels"
    assert "with drive and free exchanged in the tests: outer spall at drive_end then does" in found.sentence
    assert told(unlike, TRUE) is unlike
    assert told(replace(unlike, undecidable=("else",)), TRUE[::-1]).verdict == "not_decidable"


def test_what_is_nothing_once_put_right_is_a_sound_machine() -> None:
    known = {"name": "outer_spall@drive_end", "likelihood": -1.0, "misfit": 0.2}
    assert Fit(**known, evidence=1.0).text == "a sound machine"  # type: ignore[arg-type]
    assert Fit(**known, evidence=9.0).text == "outer spall at drive_end"  # type: ignore[arg-type]


def test_what_fits_as_it_is_stays(told) -> None:  # type: ignore[no-untyped-def]
    for report in (UNKNOWN, DOUBTED):
        assert told(report, TRUE) is report
        assert told(report, TRUE[::-1] * 1.8) is report
    assert told(DOUBTED, TRUE / 9.80665**2) is DOUBTED, "a pit beyond all that were simulated fits another unit too"
    for report in (UNKNOWN, DOUBTED):
        assert told(report, TRUE / 9.80665**2, based=False) is report
        assert told(report, TRUE / 9.80665**2, view=View(misfit=0.95)) is report
    for word in ("nothing_missing", "ambiguous", "explained"):
        sure = replace(UNKNOWN, verdict=word)  # type: ignore[arg-type]
        assert told(sure, TRUE / 9.80665**2) is sure
    assert told(UNKNOWN, TRUE[::-1] * 1.2) is UNKNOWN, "better put right by less than what is sure"


def test_only_like_channels_are_exchanged_and_a_unit_is_that_of_all() -> None:
    names = [c.order for c in corrections((*CHANNELS, channel("force", "N", "force")))]
    assert names == [(1, 0, 2)]
    units = {(c.unit, round(c.factor, 3)) for c in corrections(CHANNELS) if c.unit}
    assert ("g against m/s^2", 9.807) in units and ("g against m/s^2", 0.102) in units
    many = tuple(channel(f"a{k}") for k in range(7))
    assert all(c.order == tuple(range(7)) for c in corrections(many))


def test_a_correction_moves_levels_and_not_shapes() -> None:
    seen = statistics(TRUE)
    found = Correction(order=(1, 0), factor=2.0).put_right(seen)
    assert np.allclose(found.line[:, 0], 4.0 * TRUE[::-1]) and np.allclose(found.kurtosis[:, 0], TRUE[::-1])
    assert np.allclose(found.phase[:, 0], [0.2, 0.1]) and found.resolution_hz == seen.resolution_hz
