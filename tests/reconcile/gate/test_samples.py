"""Samples that are no finite numbers: told and filled where they are few, infinite ones like NaN; warnings are errors
here, so none of NumPy's gets through."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reconcile.gate.bridge import MOST_SAMPLES
from reconcile.gate.findings import Gate
from reconcile.gate.samples import away, repaired, sample_findings
from reconcile.gate.spoiled import GONE, doubts, without_spoiled
from signals.checks import defects, held
from signals.recording import Recording
from tests.strategies.impulses import recorded

N = 100_000
VALUES = [np.nan, np.inf, -np.inf, (np.inf, -np.inf)]


def row(seed: int = 1) -> np.ndarray:
    return np.random.default_rng(seed).standard_normal(N)


def holed(value: object, *places: slice) -> Recording:
    """Two channels, the first with holes of this value (or values in turn)."""
    x = row()
    for place in places:
        x[place] = np.resize(np.atleast_1d(value), x[place].size)
    return recorded(np.array([x, row(2)]))


@pytest.mark.parametrize("value", VALUES)
def test_ten_samples_of_many_are_filled_and_told_and_cost_no_channel(value: object) -> None:
    one = holed(value, slice(5000, 5010))
    (found,) = sample_findings(one, "test 1")
    assert (found.kind, found.channel, found.fault) == ("not_finite", one.names[0], False)
    assert found.detail.startswith("10 samples are not finite, the first at ") and "filled" in found.detail
    mended, lost = repaired(one)
    assert lost == () and np.all(np.isfinite(mended.samples))
    kept = np.delete(np.arange(N), np.s_[5000:5010])
    assert np.array_equal(mended.samples[0, kept], one.samples[0, kept])
    gate = Gate(findings=(found,), baselines=(), tests=(mended,), fault=None, usable=True)
    assert without_spoiled(gate, GONE).tests[0].names == one.names
    (told,) = doubts(gate)
    assert told.startswith(f"{one.names[0]} of test 1: not finite, 10 samples") and "left out" not in told


@pytest.mark.parametrize("value", VALUES)
@pytest.mark.parametrize(
    "places", [[slice(5000, 5000 + MOST_SAMPLES + 1)], [slice(k, k + 10) for k in range(0, N, 30_000)]]
)
def test_longer_holes_and_many_are_a_fault(value: object, places: list[slice]) -> None:
    (found,) = sample_findings(holed(value, *places), "test 1")
    assert found.kind == "not_finite" and found.fault


@pytest.mark.parametrize("value", VALUES)
def test_other_faults_are_seen_behind_a_short_hole(value: object) -> None:
    one = holed(value, slice(50, 53))
    x = one.samples.copy()
    x[0] = np.clip(x[0], -1.0, 1.0) + 1e-3 * np.sin(np.arange(N))
    x[0, 50:53] = one.samples[0, 50:53]
    assert {f.kind for f in sample_findings(replace(one, samples=x), "test 1")} == {"not_finite", "clipped"}


@pytest.mark.parametrize("value", VALUES)
def test_infinite_samples_are_nowhere_taken_for_a_held_signal(value: object) -> None:
    x = holed(value, slice(5000, 5100)).samples[0]
    assert [kind for kind, _, _ in defects(x)] == ["not_finite"]
    assert not np.any(held(x)) and not np.any(away(x, 1000.0))
    nothing = holed(value, slice(0, N))
    assert [(f.kind, f.fault) for f in sample_findings(nothing, "test 1")] == [("not_finite", True)]
    assert repaired(nothing)[1] == nothing.names[:1]


def test_shares_and_stretches_are_said_as_the_reports_say_them() -> None:
    held = row()
    held[200:900] = held[200]
    found = sample_findings(recorded(np.array([np.full(N, 3.3), held, row(2)])), "test 1")
    assert [(f.kind, f.detail.split(": ")[-1]) for f in found] == [
        ("stuck", "100 % of the samples"),
        ("stuck", "0.7 % of the samples"),
    ]
    assert all(f.where.startswith("one stretch, ") for f in found)
    held[5000:5900] = held[5000]
    (two,) = sample_findings(recorded(np.array([held, row(2)])), "test 1")
    assert two.where.startswith("2 stretches, the first at ") and two.detail.endswith(": 1.6 % of the samples")
