"""Why a loaded ball bearing has strong high multiples of its ball pass, odd and even by turns.

A ball that enters the load zone at t = 0 pushes with (t)^1.5, one that leaves it a zone later the same backwards: each
kink has harmonics falling as k^-2.5 only. Across the load the two point against each other, and with N the width of the
zone in ball spacings (the mean number of loaded balls) they add up to k^-2.5 |sin(pi (k N - 5/4))|. Nine balls and half
a turn make N a little more than 4.5, so that even and odd multiples take turns.
"""

from __future__ import annotations

import numpy as np
import pytest

from sim.presets import preset
from sim.solve.api import simulate
from sim.solve.settings import Settings

RATE_HZ = 20_000.0
MULTIPLES = np.arange(8, 32)
"""Above, the outer ring on its support (3.6 kHz) answers; below, the ring of balls is not short against its zone."""


@pytest.mark.slow
def test_entry_and_exit_of_the_load_zone_make_the_high_multiples() -> None:
    run = simulate(
        preset("rotor"),
        duration_s=2.0,
        output_rate_hz=RATE_HZ,
        channels=["bearing1.force_x", "bearing1.loaded_balls"],
        settings=Settings(estimate_error=False),
    )
    force, loaded = run.signals[:, run.signals.shape[1] // 2 :]
    assert np.mean(loaded) == pytest.approx(4.55, abs=0.02)
    angle = 2.0 * np.pi * run.bases_hz["f_o1"] * np.arange(force.size) / RATE_HZ
    window = np.hanning(force.size)
    found = np.array([abs(np.sum(window * force * np.exp(-1j * k * angle))) for k in MULTIPLES])
    law = MULTIPLES**-2.5 * np.abs(np.sin(np.pi * (MULTIPLES * np.mean(loaded) - 1.25)))
    ratio = found / law
    assert np.max(law * MULTIPLES**2.5) > 20 * np.min(law * MULTIPLES**2.5)  # some multiples nearly vanish
    assert np.max(ratio) < 2.2 * np.min(ratio)
    # even multiples stand out first, odd ones later
    by_order = dict(zip(MULTIPLES.tolist(), found * MULTIPLES**2.5, strict=True))
    assert min(by_order[k] for k in (8, 10, 12, 14)) > 2 * max(by_order[k] for k in (13, 15))
    assert min(by_order[k] for k in (21, 23, 25)) > 2 * max(by_order[k] for k in (22, 24, 26))
