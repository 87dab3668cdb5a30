"""A buffer written again and again is told; a machine that turns evenly repeats nothing exactly."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reconcile.gate import inspect_measurement
from reconcile.gate.loops import loop_findings, repeated
from reconcile.gate.spoiled import without_spoiled
from signals.series import FloatArray
from tests.strategies.impulses import RATE_HZ, N, recorded, sound


def looped(x: FloatArray, size: int = 1600) -> FloatArray:
    """The first `size` samples throughout, but for a rest at the end."""
    y = x.copy()
    count = x.size // size
    y[: count * size] = np.tile(x[:size], count)
    return y


def rounded(x: FloatArray, levels: float) -> FloatArray:
    step = float(np.ptp(x)) / levels
    return np.asarray(np.round(x / step) * step)


@pytest.mark.parametrize("size", [300, 1600, 16_001])
def test_the_period_is_told(size: int) -> None:
    x = sound(1)
    assert repeated(looped(x, size)) == size
    assert repeated(looped(rounded(x, 4000.0), size)) == size


def test_what_does_not_repeat_is_none() -> None:
    tone = np.sin(2 * np.pi * 50.0 * np.arange(N) / RATE_HZ)
    noise = np.random.default_rng(1).standard_normal(N)
    held = np.where(np.arange(N) % 1000 < 700, 0.0, sound(2))
    for x in (sound(1), tone + 1e-4 * noise, rounded(tone + 0.05 * noise, 255.0), rounded(sound(3), 3.0), held):
        assert repeated(x) == 0
    assert repeated(np.zeros(N)) == 0
    assert repeated(np.concatenate([sound(4)[: N // 2]] * 2)[: N - 1000] + 1e-9 * noise[: N - 1000]) == 0


@pytest.mark.slow
def test_one_such_channel_is_left_out_and_of_all_nothing_is_judged() -> None:
    base = recorded(np.stack([sound(1), sound(2)]))
    rows = np.stack([looped(sound(3)), sound(4)])
    gate = inspect_measurement([base], [recorded(rows)])
    (told,) = (f for f in gate.findings if f.kind == "repeated")
    assert (told.channel, told.recording) == ("a0", "test 1")
    assert "every 1600 (0.08 s)" in told.detail
    assert gate.usable
    assert without_spoiled(gate).tests[0].names == ("a1",)
    assert not [f for f in gate.findings if f.kind == "mains_hum"]
    both = replace(recorded(rows), samples=np.stack([looped(row) for row in rows]))
    gate = inspect_measurement([base], [both])
    assert not gate.usable
    assert gate.fault is not None
    assert gate.fault.kind == "repeated"
    assert not loop_findings(base, "baseline 1")
