"""Numerical settings and their defaults, each with the measurement behind it."""

from __future__ import annotations

from dataclasses import dataclass

BASE_RATE_HZ = 60_000.0
"""Least steps per second: relative error 1e-5 to 3e-4 on the reference machines (make bench)."""
POINTS_PER_PERIOD = 5.0
"""Steps per period of the highest linearised mode that is not overdamped."""
MESH_CELLS = 12.0
"""Least steps per mesh period."""
MAX_RATE_HZ = 2_000_000.0
ENERGY_LIMIT = 0.01
"""Largest acceptable energy residual over the energy that passed through the machine."""
PILOT_S = 0.06
"""Length of the stretch on which the step is compared with half of it."""
IRREGULAR = 0.2
"""Difference between a step and its half above which the motion is called irregular."""


@dataclass(frozen=True, kw_only=True)
class Settings:
    """`rtol`: corrector tolerance relative to the largest contact force. `steps_per_output`: None is automatic."""

    rtol: float = 3e-4
    steps_per_output: int | None = None
    anti_alias: bool = True
    estimate_error: bool = True
