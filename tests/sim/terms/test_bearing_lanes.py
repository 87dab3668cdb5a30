"""Eight machines side by side with effects at their bearings equal the single solver, each with its own values."""

from __future__ import annotations

import numpy as np
import pytest

from sim.solve.api import simulate
from sim.solve.ensemble import Member, simulate_many
from sim.solve.settings import Settings
from tests.strategies.bearings import bearing_with

RUN = {"duration_s": 0.03, "output_rate_hz": 20_000.0}
QUICK = Settings(estimate_error=False)
SETS = {
    "balls and races": lambda i: (
        ("outer_spall", {"width": 1e-3 + 1e-4 * i}),
        ("inner_waviness", {"amplitude": 1e-6 * (1 + i), "order": 8.0 + i}),
        ("ball_spall", {"width": 2e-3 - 1e-4 * i, "angle": 0.3 * i}),
        ("ring_creep", {"ratio": 0.01 * (1 + i)}),
        ("radial_clearance", {"change": -1e-6 * (1 + i)}),
    ),
    "support": lambda i: (
        ("bearing_stiffness", {"hardening": 0.5 + i}),
        ("squeeze_film", {"damping": 1e3 * (1 + i), "film": 5e-5 + 1e-5 * i}),
    ),
}


@pytest.mark.slow
@pytest.mark.parametrize("terms", SETS.values(), ids=SETS)
def test_a_lane_equals_the_single_solver(terms):
    machines = [bearing_with(*terms(i)) for i in range(5)]
    many = list(simulate_many([Member(machine=m) for m in machines], settings=QUICK, **RUN))
    for machine, lane in zip(machines, many, strict=True):
        alone = simulate(machine, settings=QUICK, **RUN)
        assert lane.quality.steps == alone.quality.steps
        largest = np.max(np.abs(alone.signals))
        assert lane.signals == pytest.approx(alone.signals, abs=1e-9 * largest)
