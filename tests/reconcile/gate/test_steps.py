"""The step of a converter tells whose channel it is, together with what the channel hears."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reconcile.gate import inspect_measurement
from reconcile.gate.steps import exchanged_steps, same_step, step_of
from signals.recording import Operating, Recording
from signals.series import FloatArray
from sim.core.response import Channel

RATE_HZ, N = 16_384.0, 32_768
STEPS = (0.002046, 0.002015)


def noise(seed: int, size: float = 0.3) -> FloatArray:
    return np.asarray(size * np.random.default_rng(seed).standard_normal(N))


@pytest.mark.parametrize("kind", [np.float32, np.float64])
def test_the_step_is_found_also_with_samples_that_were_filled(kind: type) -> None:
    x = (np.round(noise(1) / STEPS[0]) * STEPS[0]).astype(kind).astype(np.float64)
    x[::5000] += 0.0007
    assert step_of(x) == pytest.approx(STEPS[0], rel=1e-3)


def test_what_was_not_rounded_or_hardly_moves_has_none() -> None:
    assert step_of(noise(1)) == 0.0
    assert step_of(np.zeros(N)) == 0.0
    assert step_of(np.round(noise(1, 1.0))) == 0.0  # five values are no converter's


def test_another_range_keeps_the_channel() -> None:
    assert same_step(STEPS[0], 2 * STEPS[0])
    assert not same_step(*STEPS)
    assert exchanged_steps(STEPS, (STEPS[0], 2 * STEPS[1])) is False
    assert exchanged_steps(STEPS[::-1], (STEPS[0], 2 * STEPS[1])) is True
    assert exchanged_steps((STEPS[0], STEPS[0]), STEPS) is None
    assert exchanged_steps((1.0, 1.0), (1.0, 1.0)) is None


def heard(seed: int, steps: tuple[float, float], *, apart: float, swap: bool = False, pit: float = 0.0) -> Recording:
    """Two sensors, of which the second is louder above by `apart` dB; a pit at the first raises all bands."""
    rows = []
    for k, step in enumerate(steps):
        x = noise(seed + 100 * k, 0.3) * 10 ** (apart * k / 20)
        blows = np.zeros(N)
        blows[::61] = 1.0 if k == 0 else 0.3
        x = x + pit * np.convolve(blows, np.random.default_rng(5 + k).standard_normal(64), "full")[:N]
        rows.append(np.round(x / step) * step)
    channels = tuple(
        Channel(name=name, quantity="acceleration", unit="m/s^2", location=name, axis="y") for name in ("a0", "a1")
    )
    return Recording(
        sampling_rate_hz=RATE_HZ,
        channels=channels,
        samples=np.stack(rows[::-1] if swap else rows),
        operating=Operating(shaft="shaft", speed_hz=25.0),
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    ("steps", "swap", "told"),
    [(STEPS, False, False), (STEPS, True, True), ((STEPS[0], STEPS[0]), True, False)],
    ids=["right", "exchanged", "exchanged, steps alike"],
)
def test_beside_a_pit_that_raises_all_bands_steps_tell(steps: tuple[float, float], swap: bool, told: bool) -> None:
    base, test = heard(1, steps, apart=2.0), heard(2, steps, apart=2.0, swap=swap, pit=3.0)
    gate = inspect_measurement([base], [test])
    assert [f.channel for f in gate.findings if f.kind == "swapped_channels"] == (["a0", "a1"] if told else [])


@pytest.mark.slow
def test_cables_put_elsewhere_are_no_exchange() -> None:
    base, test = heard(1, STEPS, apart=2.0), heard(2, STEPS[::-1], apart=2.0, pit=0.02)
    assert step_of(test.samples[0]) == pytest.approx(STEPS[1], rel=1e-3)
    gate = inspect_measurement([base], [replace(test)])
    assert not [f for f in gate.findings if f.kind == "swapped_channels"]
