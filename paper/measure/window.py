"""The settled part of one run, cut to whole revolutions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Window:
    """Signals of shape (samples,) over whole revolutions, `per_mesh` samples a mesh period.

    `signals` by short name: `k` N/m, `a` (centre-distance error) m, `theta` rad, `y` (resonator) m,
    `acc` m/s^2, `ring_x`, `ring_y` (inner ring of bearing 1) m.
    """

    signals: Mapping[str, FloatArray]
    per_mesh: int
    teeth: int
    f_r1_hz: float
    f_o1_hz: float

    @property
    def f_m_hz(self) -> float:
        """Mesh frequency, Hz."""
        return self.teeth * self.f_r1_hz

    @property
    def rate_hz(self) -> float:
        """Sampling rate, Hz."""
        return self.per_mesh * self.f_m_hz

    @property
    def per_revolution(self) -> int:
        """Samples a revolution."""
        return self.per_mesh * self.teeth

    def by_mesh(self, name: str) -> FloatArray:
        """A signal cut into mesh periods, shape (periods, per_mesh)."""
        return self.signals[name].reshape(-1, self.per_mesh)
