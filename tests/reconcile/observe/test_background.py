"""What impacts bring between the harmonics of the shafts is seen as what falls upon these; more of the same is not."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.observe.background import gained_between
from reconcile.observe.steady import Steady
from reconcile.observe.watch import Watched, WatchList
from signals.series import FloatArray

RATE_HZ, SPEED_HZ, TEETH = 10000.0, 30.0, (23, 81)
SLOW_HZ = SPEED_HZ * TEETH[0] / TEETH[1]
TIME = np.arange(12000) / RATE_HZ


def line(family: str, slips: bool = False, **orders: float) -> Watched:
    return Watched(label="x", orders=orders, family=family, slips=slips)


WATCHED = WatchList(
    lines=(
        line("shaft", f_r1=1.0),
        line("shaft", f_r1=2.0),
        line("shaft", f_r2=1.0),
        line("mesh", f_m1=1.0),
        line("sideband", f_m1=2.0, f_r1=1.0),
        line("outer", slips=True, f_o1=4.0),
    ),
    modulations=(),
)
LINES_HZ = WATCHED.line_hz({"f_r1": SPEED_HZ, "f_r2": SLOW_HZ, "f_m1": TEETH[0] * SPEED_HZ, "f_o1": 3.57 * SPEED_HZ})


def heard(seed: int, *, turning: float = 1.0, noise: float = 0.05, impacts: float = 0.0) -> Steady:
    """Harmonics of both shafts and noise; impacts at an order that is none of theirs, each a little off its time."""
    rng = np.random.default_rng(seed)
    orders = [SPEED_HZ * k for k in range(1, 100)] + [SLOW_HZ * k for k in range(1, 300)]
    samples = turning * sum(0.02 * np.cos(2 * np.pi * hz * TIME + rng.uniform(0, 6)) for hz in orders)
    samples = samples + noise * rng.standard_normal(TIME.size)
    times = np.arange(0, TIME[-1], 1 / (3.57 * SPEED_HZ)) * 1.004 + rng.normal(0, 1e-4, int(TIME[-1] * 3.57 * 30) + 1)
    spikes = np.zeros(TIME.size)
    spikes[np.minimum((times * RATE_HZ).astype(int), TIME.size - 1)] = impacts
    rings = np.exp(-np.arange(200) / 30) * np.sin(2 * np.pi * 0.15 * np.arange(200))
    samples = samples + np.convolve(spikes, rings)[: TIME.size]
    return Steady(samples=samples[None], rate_hz=RATE_HZ, speed_hz=SPEED_HZ, estimate=None)  # type: ignore[arg-type]


def gained(test: Steady, baseline: Steady | None) -> FloatArray:
    point = SimpleNamespace(
        spectra=(test, baseline),
        test=SimpleNamespace(line=np.zeros((1, LINES_HZ.size))),
        lines_hz=LINES_HZ,
        point=SimpleNamespace(speed_hz=SPEED_HZ),
    )
    return gained_between(point, WATCHED)  # type: ignore[arg-type]


def test_what_is_louder_at_the_turns_alone_is_none() -> None:
    leaked = gained(heard(1, turning=10.0), heard(2)) * 5 * RATE_HZ / TIME.size
    assert np.all(leaked < 1e-3 * 0.2**2 / 2), "what the window leaks moves no level of these lines"
    assert np.all(gained(heard(1), heard(2)) == 0.0)
    assert np.all(gained(heard(1, impacts=3.0), None) == 0.0)


@pytest.mark.parametrize("impacts", [1.0, 3.0])
def test_impacts_fall_upon_lines_of_shafts_and_teeth(impacts: float) -> None:
    found = gained(heard(1, impacts=impacts), heard(2))[0]
    assert np.all(found[3:5] > 0.0)
    assert found[5] == 0.0, "what slips itself is its own"
    # all power that is between the turns' lines, within the noise's own share of it
    base, now = heard(2).samples, heard(1, impacts=impacts).samples
    density = (np.var(now) - np.var(base)) / (0.5 * RATE_HZ)
    assert 0.2 * density < found[4] < 20 * density


def test_noise_that_rose_evenly_is_found_at_its_density() -> None:
    found = gained(heard(1, noise=0.5), heard(2))[0]
    expected = 0.25 / (0.5 * RATE_HZ) - 2 * 0.0025 / (0.5 * RATE_HZ)
    np.testing.assert_allclose(found[:5], expected, rtol=0.6)
    np.testing.assert_allclose(np.mean(found[:5]), expected, rtol=0.25)
