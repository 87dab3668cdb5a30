"""Two channels of one signal are told; sensors that hear one machine are two."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reconcile.gate import inspect_measurement
from reconcile.gate.copied import copies, copy_findings
from reconcile.gate.spoiled import doubts, remarks, without_spoiled
from signals.recording import Recording
from signals.series import FloatArray
from sim.core.response import Channel

RATE_HZ, N = 8192.0, 16_384
TIME = np.arange(N) / RATE_HZ


def sensor(seed: int, share: float, width: int) -> FloatArray:
    """A strong slow line that all hear alike, and the noise of a path of its own."""
    rng = np.random.default_rng(seed)
    noise = np.convolve(rng.standard_normal(N + width), np.hanning(width + 2), "full")[:N]
    return np.asarray(20.0 * np.sin(2 * np.pi * 25.0 * TIME) + share * noise)


def recording(*rows: FloatArray) -> Recording:
    channels = tuple(
        Channel(name=f"a{k}", quantity="acceleration", unit="m/s^2", location=f"b{k}", axis="y")
        for k in range(len(rows))
    )
    return Recording(sampling_rate_hz=RATE_HZ, channels=channels, samples=np.stack(rows))


def pair(seed: int) -> Recording:
    return recording(sensor(seed, 0.2, 1), sensor(seed + 50, 0.1, 7))


def test_sensors_that_mostly_hear_one_line_are_two() -> None:
    one = pair(1)
    assert np.corrcoef(one.samples)[0, 1] > 0.99
    assert copies(one) == ()


@pytest.mark.parametrize("factor", [1.0, -1.0, 9.81])
def test_a_copy_is_told_also_times_a_factor_and_rounded(factor: float) -> None:
    x = np.round(factor * sensor(1, 0.2, 1), 2) + 3.0
    assert copies(recording(sensor(1, 0.2, 1), sensor(2, 0.1, 7), x)) == (("a0", "a2"),)


def test_as_much_noise_of_its_own_makes_it_a_sensor() -> None:
    x = sensor(1, 0.2, 1)
    for size, alike in ((0.002, True), (0.1, False)):
        other = x + size * np.random.default_rng(9).standard_normal(N)
        assert bool(copies(recording(x, other))) is alike


@pytest.mark.slow
@pytest.mark.parametrize(("carried", "left_out"), [(0, "a1"), (1, "a0")])
def test_the_channel_whose_baseline_is_another_is_left_out(carried: int, left_out: str) -> None:
    base, test = pair(1), pair(3)
    test = replace(test, samples=np.stack([test.samples[carried]] * 2))
    gate = inspect_measurement([base], [test])
    (found,) = (f for f in gate.findings if f.kind == "copied")
    kept = f"a{carried}"
    assert (found.channel, found.fault) == (left_out, True)
    assert found.detail.startswith(f"{left_out} carries the signal of {kept}")
    assert gate.fault is not None
    assert gate.fault.kind == "copied"
    assert without_spoiled(gate).tests[0].names == (kept,)
    assert any("copied" in text for text in doubts(gate))


def ringing(seed: int, hz: float) -> FloatArray:
    """Noise, and noise of a resonance at `hz`, the place's own: few bands tell it from that of another place."""
    rng = np.random.default_rng(seed)
    ring = np.exp(-2 * np.pi * hz * 0.03 * TIME[:400]) * np.sin(2 * np.pi * hz * TIME[:400])
    coloured = np.convolve(rng.standard_normal(N), ring)[:N] / np.sqrt(np.sum(ring**2))
    return np.asarray(rng.standard_normal(N) + 0.6 * coloured)


@pytest.mark.slow
@pytest.mark.parametrize("hz", [(2000.0, 2600.0), (2600.0, 2000.0), (2000.0, 2000.0)])
def test_a_resonance_of_the_place_tells_whose_the_signal_is(hz: tuple[float, float]) -> None:
    base, row = recording(ringing(1, hz[0]), ringing(2, hz[1])), ringing(3, 2000.0)
    (found,) = copy_findings([recording(row, row)], [base], ["test 1"])
    assert ("the signal of" in found.detail) is (hz[0] != hz[1])
    assert found.channel == ("a0" if hz[0] > hz[1] else "a1")


@pytest.mark.slow
def test_what_the_baseline_has_too_is_a_remark() -> None:
    twice = [recording(row, row) for row in (sensor(1, 0.2, 1), sensor(3, 0.2, 1))]
    gate = inspect_measurement(twice[:1], twice[1:])
    assert gate.fault is None
    assert any("in a baseline as well" in text for text in remarks(gate))


def test_a_simulation_without_noise_may_have_two_alike() -> None:
    x = np.sin(2 * np.pi * 32.0 * TIME) + 0.1 * np.sin(2 * np.pi * 1000.0 * TIME)
    assert copy_findings([recording(x, x)], [], ["test 1"]) == ()
