"""Measures of the gear pair: stiffness, centre distance, offset angle."""

from __future__ import annotations

import numpy as np

from paper.measure.envelopes import Slow, slow, turning_points
from paper.measure.lines import line
from paper.measure.mean import PairLaw, mean_stiffness
from paper.measure.window import FloatArray, Window

LEAST_TURN = 1e-3
"""Share of the stiffness' range below which a wiggle is not counted as an extreme."""
NEAR = 0.04
"""Share of a mesh period around a jump that counts as its end."""
JUMPS = 2
EXTREME_PERIODS = 200
SINGLE_PHASES = (0.75, 0.97)
"""Mesh phases at which one pair carries alone at every centre distance met here (contact ratio 1.67 to 1.72).
Fixed, because a minimum taken at the sampled jump would move by 0.3 % when the jump crosses a sample."""


def slow_of(window: Window, curve: FloatArray) -> Slow:
    """`slow` with the frequencies of the window."""
    return slow(curve, f_m_hz=window.f_m_hz, f_r1_hz=window.f_r1_hz, f_o1_hz=window.f_o1_hz)


def slow_numbers(prefix: str, found: Slow, scale: float) -> dict[str, float]:
    """f_o1 line and largest line of a slow curve, and the range of its signal."""
    return {
        f"{prefix}_at_f_o1": found.at_f_o1,
        f"{prefix}_largest": found.largest,
        f"{prefix}_largest_hz": found.largest_hz,
        f"{prefix}_scale": scale,
    }


def motion_numbers(window: Window, name: str) -> dict[str, float]:
    """Peak, range, f_m phase and upper envelope of the centre-distance error `a` or the offset angle `theta`."""
    values = window.signals[name]
    found = slow_of(window, window.by_mesh(name).max(axis=1))
    numbers = slow_numbers(f"{name}_env", found, float(np.ptp(values)))
    first = line(values, window.rate_hz, window.f_m_hz)
    return numbers | {
        f"{name}_peak": float(np.max(np.abs(values))),
        f"{name}_range": float(np.ptp(values)),
        f"{name}_fm_phase_deg": float(np.degrees(np.angle(first))),
        f"{name}_fm": abs(first),
    }


def stiffness_numbers(window: Window, law: PairLaw | None) -> dict[str, float]:
    """Mean, single-tooth minimum, modulation and local extremes of the mesh stiffness.

    `law` None: the stiffness depends on more than the centre distance, and the sampled mean must do.
    """
    k = window.signals["k"]
    mean = float(k.mean()) if law is None else mean_stiffness(law, window.signals["a"], window.per_mesh)
    first, last = (round(p * window.per_mesh) for p in SINGLE_PHASES)
    single = window.by_mesh("k")[:, first:last]
    numbers = slow_numbers("k_single", slow_of(window, single.mean(axis=1)), mean)
    count, near = extremes(window)
    return numbers | {
        "k_mean": mean,
        "k_min": float(single.min()),
        "k_extremes": count,
        "k_extremes_near": near,
    }


def extremes(window: Window) -> tuple[float, float]:
    """Local extremes of the stiffness a mesh period, and the share of them within 4 % of a jump."""
    blocks = window.by_mesh("k")[:EXTREME_PERIODS]
    mean = blocks.mean(axis=0)
    steps = np.abs(np.roll(mean, -1) - mean)
    jumps = (np.argsort(steps)[-JUMPS:] + 0.5) / window.per_mesh
    points = turning_points(blocks.ravel(), LEAST_TURN * float(np.ptp(mean)))
    if points.size == 0:
        return 0.0, 0.0
    phase = (points / window.per_mesh) % 1.0
    apart = np.abs((phase[:, np.newaxis] - jumps + 0.5) % 1.0 - 0.5).min(axis=1)
    return float(points.size / blocks.shape[0]), float(np.mean(apart <= NEAR))
