"""Numbers that characterise a mesh, and what its least known inputs change."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import lru_cache

import numpy as np

from sim.core.errors import SpecError
from sim.parts.gear.geometry import GearGeometry
from sim.parts.gear.pair import GearPair, pair_stiffness_n_per_m
from sim.parts.gear.total_table import total_row_n_per_m

_STEP = 1e-4
"""Step of the central difference in modules: d(mean)/da is converged to 1e-6 at this step."""
_NODES = 48


@lru_cache(maxsize=256)
def mean_stiffness_n_per_m(pair: GearPair, centre_distance_error_m: float = 0.0) -> float:
    """Mean total stiffness over a mesh cycle: the integral of one pair's stiffness over its engagement, N/m."""
    helix, ratio = pair.helix, pair.contact(centre_distance_error_m).contact_ratio
    if helix.overlap_ratio > 0.0:
        # spreading a pair's stiffness over its overlap keeps the integral
        straight = replace(pair, pinion=replace(pair.pinion, helix_rad=0.0), gear=replace(pair.gear, helix_rad=0.0))
        return math.cos(helix.base_angle_rad) * mean_stiffness_n_per_m(straight, centre_distance_error_m)
    x, w = np.polynomial.legendre.leggauss(_NODES)
    curve = pair_stiffness_n_per_m(pair, 0.5 * ratio * (x + 1), centre_distance_error_m)
    return float(0.5 * ratio * np.dot(w, curve))


def extreme_stiffness_n_per_m(pair: GearPair) -> tuple[float, float]:
    """Least and largest total stiffness over a mesh cycle, with both sides of every jump, N/m."""
    jump = pair.engagement() % 1.0
    # A pair enters at phase 0 and leaves at `jump`: the intervals are sampled up to just before the next event.
    phases = np.concatenate([np.linspace(0, jump, 401)[:-1], np.linspace(jump, 1, 401)[:-1], [jump, 1.0]])
    nudged = np.clip(np.concatenate([phases, phases - 1e-9, phases + 1e-9]), 0.0, 1.0 - 1e-9)
    total = total_row_n_per_m(pair, nudged)
    return float(total.min()), float(total.max())


def _with_bore(pair: GearPair, share: float) -> GearPair:
    def bored(gear: GearGeometry) -> GearGeometry:
        return replace(gear, bore_radius_m=share * gear.pitch_radius_m)

    return replace(pair, pinion=bored(pair.pinion), gear=bored(pair.gear))


def mesh_summary(pair: GearPair) -> dict[str, object]:
    """Contact ratio, mean, least and largest stiffness, its slope over the centre distance, and two sensitivities.

    `bore_0.5r_over_0.3r` and `true_root_over_clamped_at_base` are ratios of mean stiffness (None where a bore of
    0.5 r would cut the teeth); `warnings` lists undercut and extrapolation.
    """
    step_m = _STEP * pair.pinion.module_m
    slope = (mean_stiffness_n_per_m(pair, step_m) - mean_stiffness_n_per_m(pair, -step_m)) / (2 * step_m)
    least, largest = extreme_stiffness_n_per_m(pair)
    rooted = [mean_stiffness_n_per_m(replace(pair, root_model=m)) for m in ("true_root", "clamped_at_base")]
    try:
        bored = [mean_stiffness_n_per_m(_with_bore(pair, share)) for share in (0.5, 0.3)]
    except SpecError:
        bored = []
    contact = pair.contact()
    return {
        "contact_ratio": contact.contact_ratio,
        "overlap_ratio": pair.helix.overlap_ratio,
        "centre_distance_m": contact.centre_distance_m,
        "working_angle_rad": contact.working_angle_rad,
        "mean_n_per_m": mean_stiffness_n_per_m(pair),
        "min_n_per_m": least,
        "max_n_per_m": largest,
        "d_mean_d_centre_distance": slope,
        "root_model": pair.root_model,
        "bore_0.5r_over_0.3r": bored[0] / bored[1] if bored else None,
        "true_root_over_clamped_at_base": rooted[0] / rooted[1],
        "warnings": list(pair.warnings),
    }
