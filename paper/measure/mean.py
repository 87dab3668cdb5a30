"""Mean mesh stiffness over a run, free of the sampling of its jumps.

Sampled 90 times a mesh period the stiffness' jump is placed to 1 %, which is 0.5 % of the mean: more than clearance
changes it. The centre-distance error is smooth, so it is interpolated and the stiffness law evaluated on finer,
incommensurate instants.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from paper.measure.window import FloatArray

FINER = 8
GOLDEN = 0.6180339887498949
"""Shift of the instants by multiples of it fills the cell evenly (low-discrepancy sequence)."""


@dataclass(frozen=True, kw_only=True)
class PairLaw:
    """Stiffness of one tooth pair, N/m, shape (rows, points): rows over the centre-distance error `errors_m` (rows,),
    points over position / contact ratio from 0 to 1; `contact_ratio` (rows,). No tilt.
    """

    errors_m: FloatArray
    contact_ratio: FloatArray
    stiffness_n_per_m: FloatArray


def total_stiffness(law: PairLaw, phase: FloatArray, error_m: FloatArray) -> FloatArray:
    """Sum over the pairs in contact at mesh phases (cycles) and centre-distance errors of the same shape, N/m."""
    rows, points = law.stiffness_n_per_m.shape
    at = np.interp(error_m, law.errors_m, np.arange(rows))
    row = np.minimum(at.astype(np.int64), rows - 2)
    high = at - row
    ratio = np.interp(error_m, law.errors_m, law.contact_ratio)
    total = np.zeros_like(phase)
    for slot in range(int(np.ceil(law.contact_ratio.max()))):
        x = (phase % 1.0 + slot) / ratio
        place = np.minimum(x, 1.0) * (points - 1)
        cell = np.minimum(place.astype(np.int64), points - 2)
        share = place - cell
        k = law.stiffness_n_per_m
        low_row = k[row, cell] * (1 - share) + k[row, cell + 1] * share
        high_row = k[row + 1, cell] * (1 - share) + k[row + 1, cell + 1] * share
        total += np.where(x < 1.0, low_row * (1 - high) + high_row * high, 0.0)
    return total


def mean_stiffness(law: PairLaw, error_m: FloatArray, per_mesh: int) -> float:
    """Mean over a run whose centre-distance error is given at phase j / per_mesh, N/m."""
    count = (error_m.size - 1) * FINER
    index = np.arange(count)
    instants = (index + (index * GOLDEN) % 1.0) / FINER
    errors = np.interp(instants, np.arange(error_m.size), error_m)
    return float(total_stiffness(law, instants / per_mesh, errors).mean())
