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
FIRST_SHARE = 0.125
"""Of a run, whose iterations are allowed from its beginning on: a start from rest may strike more often."""

PIECE = 256
"""Base steps after which a run with a bound is asked whether it keeps it: one stuck step may take 500 iterations."""


def pieces(count: int, most: float | None) -> list[tuple[int, int]]:
    """Beginning and number of steps of what is run at once, of `count`: all, where nothing bounds the iterations."""
    size = count if most is None else PIECE
    return [(at, min(size, count - at)) for at in range(0, count, max(size, 1))]


@dataclass(frozen=True, kw_only=True)
class Settings:
    """`rtol`: corrector tolerance relative to the largest contact force. `steps_per_output`: None is automatic.
    `most_iterations`: of the corrector a base step, on the whole, beyond which a run is given up (TooStiff); None is
    without bound."""

    rtol: float = 3e-4
    steps_per_output: int | None = None
    anti_alias: bool = True
    estimate_error: bool = True
    most_iterations: float | None = None
