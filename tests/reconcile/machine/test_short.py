"""A short recording is told, and of an open answer a longer one is the next experiment."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.gate.findings import Finding
from reconcile.machine.short import LEAST_TURNS, with_short
from reconcile.machine.turned import COMPARED
from reconcile.verdict import NextExperiment, Report, Where

RATE_HZ = 1000.0
MORE = NextExperiment(sentence="A recording at one more speed or load would tell them apart.")


def found(recording: str, severity: float) -> Finding:
    detail = f"0.3 s hold {20 * (1 - severity):.3g} turns of order 0.398; 20 are needed, 2 s"
    return Finding(kind="too_short", channel="", recording=recording, detail=detail, severity=severity)


def point(turns: float, speed_hz: float = 25.0) -> SimpleNamespace:
    samples = np.zeros((1, round(turns / speed_hz * RATE_HZ)))
    return SimpleNamespace(spectra=(SimpleNamespace(samples=samples, rate_hz=RATE_HZ, speed_hz=speed_hz), None))


def report(verdict: str) -> Report:
    return Report(
        verdict=verdict,
        sentence="",
        level="machine",
        where=Where(limits=("known",)),
        next_experiment=MORE,  # type: ignore[arg-type]
    )


def test_the_shortest_is_among_the_limits_and_the_answer_asks_for_more() -> None:
    seen = [found("baseline 1", 0.2), found("test 1", 0.85)]
    told = with_short(report("ambiguous"), [point(40.0), point(7.5)], seen)  # type: ignore[arg-type]
    assert told.where.limits[0] == "known" and told.where.limits[1].startswith("test 1 is short: 0.3 s hold 3 turns")
    assert told.undecidable == ("0.3 s hold 7.5 turns of the driven shaft only",)
    assert told.next_experiment is not None and "at least 0.48 s" in told.next_experiment.sentence


@pytest.mark.parametrize(
    ("verdict", "turns"), [("ambiguous", LEAST_TURNS), ("explained", 5.0), ("nothing_missing", 5.0)]
)
def test_longer_ones_and_answers_that_are_not_open_keep_their_advice(verdict: str, turns: float) -> None:
    told = with_short(report(verdict), [point(turns)], [found("test 1", 0.5)])  # type: ignore[arg-type]
    assert told.next_experiment is MORE and len(told.where.limits) == 2 and not told.undecidable


def test_long_recordings_are_not_mentioned() -> None:
    before = report("ambiguous")
    assert with_short(before, [point(5.0)], []) is before  # type: ignore[arg-type]


def test_a_test_that_is_compared_at_another_speed_than_it_states_is_among_the_limits() -> None:
    detail = f"31.5 Hz are stated, its lines show 30.1 Hz, as those of the baseline stated as 30 Hz do: {COMPARED}"
    moved = Finding(kind="speed_mismatch", channel="", recording="test 2", detail=detail, severity=0.0)
    told = with_short(report("explained"), [point(40.0)], [moved])  # type: ignore[arg-type]
    assert told.where.limits == ("known", f"test 2: {detail}")
