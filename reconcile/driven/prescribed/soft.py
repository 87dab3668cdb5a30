"""Play behind which friction may set in gradually: which widths of it the force allows.

A spring that starts softly counts as play where it is fitted as a stiff one. Here everything but the width is free:
friction that sets in over several stretches, and play that is passed without force (a slider hangs in it) or with the
force that there was (what moves the slider is held).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import nnls

from reconcile.driven.channels import FloatArray
from reconcile.driven.prescribed.resistance import Motion, path_force
from sim.core.compiled import jit

WIDTHS = tuple(k / 80.0 for k in range(61))
"""Widths tried, over the amplitude."""
STRETCHES = (0.02, 0.06, 0.15, 0.3, 0.6, 1.0)
"""Of the friction, over the amplitude."""
ALLOWED = 1.1
"""A width is allowed whose error's power is at most this over the least. Made friction behind 3 mm of play, that sets
in softly, is 2.9 to 3.1 mm so, where the law with a stiff start says 3.7; with 1.25 a measured brake is 1.3 to 4.1."""
MOST_SAMPLES = 4000


@dataclass(frozen=True, kw_only=True)
class Widths:
    """Play m that leaves least, with the narrowest and widest allowed."""

    best_m: float
    low_m: float
    high_m: float


@jit
def _dragged(x, half, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN202
    p = 0.0
    for i in range(x.size):
        p = min(max(p, x[i] - half), x[i] + half)
        out[i] = p


def _columns(motion: Motion, size: float, width: float, lean: float, *, held: bool) -> FloatArray:
    base = {"friction": 1.0, "asymmetry": lean, "backlash": 0.0 if held else width * size}
    moved = motion
    if held:
        out = np.empty(motion.displacement.size)
        _dragged(np.ascontiguousarray(motion.displacement), 0.5 * width * size, out)
        moved = Motion(displacement=out, velocity=motion.velocity, step_s=motion.step_s)
    return np.column_stack([path_force(base | {"elastic": 1.0 / (s * size)}, moved) for s in STRETCHES])


def allowed_widths(motion: Motion, force: FloatArray, skip: int, lean: float) -> Widths:
    """Widths of play under which springs, dampers and friction that sets in gradually leave little more than least.

    `lean`: asymmetry of the friction.
    """
    size = float(np.max(np.abs(motion.displacement))) or 1.0
    fastest = float(np.max(np.abs(motion.velocity))) or 1.0
    every = max((force.size - skip) // MOST_SAMPLES, 1)
    x, v = motion.displacement / size, motion.velocity / fastest
    plain = np.column_stack([np.ones(x.size), x, v])
    plain = np.column_stack([plain, -plain])[skip::every]
    wanted = force[skip::every]
    left = np.array(
        [
            min(
                nnls(np.column_stack([plain, _columns(motion, size, w, lean, held=held)[skip::every]]), wanted)[1]
                for held in (False, True)
            )
            for w in WIDTHS
        ]
    )
    near = np.array(WIDTHS)[left**2 <= ALLOWED * float(np.min(left**2))]
    step = WIDTHS[1] - WIDTHS[0]
    best = WIDTHS[int(np.argmin(left))]
    ends = (max(float(near[0]) - step, 0.0), float(near[-1]) + step)
    return Widths(best_m=best * size, low_m=ends[0] * size, high_m=ends[1] * size)
