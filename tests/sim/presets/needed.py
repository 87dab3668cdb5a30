"""The least that a parameter file must hold, and a flat mesh table."""

from __future__ import annotations

from typing import Any

import numpy as np

NEEDED: dict[str, Any] = {
    "If1": 0.0021, "Ip": 4.365e-4, "Ig": 8.362e-3, "If2": 0.0105, "mp_": 0.96, "mg": 2.88, "kf": 4.4e4, "cf": 5.0,
    "ks": 6.56e7, "cs": 1800.0, "kp": 6.56e7, "cp": 1800.0, "kr": 2.5e8, "cr": 1800.0, "ms": 0.4, "mo": 0.1, "mr": 0.5,
    "kre": 8e9, "fr1": 30.0, "T": 25.0, "z1": 23, "z2": 81, "m": 0.002, "W": 0.024, "al": 20.0,
    "nb1": 7, "g1": 0.2647, "nb2": 7, "g2": 0.2648,
}  # fmt: skip
GRID = np.linspace(-2e-4, 2e-4, 9)
ROWS = np.full((9, 400), 3.7e8)
