"""What several small cases have in common is moved once: the machine before the effect."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field

import numpy as np

from proof.machine import Arrays, FloatArray
from proof.run_up import RATE_HZ, Speed, accelerations


@dataclass(frozen=True)
class Moved:
    """The proof's own motion of a machine: the same arrays at the same speeds are marched once."""

    kept: dict[str, FloatArray] = field(default_factory=dict)

    def __call__(
        self, machine: Arrays, speed: Speed, *, duration_s: float, start_rad: float, dofs: tuple[int, ...]
    ) -> FloatArray:
        """As `proof.run_up.accelerations`."""
        key = hashlib.sha256(repr((duration_s, start_rad, dofs)).encode())
        angles = speed.angle(np.arange(round(duration_s * RATE_HZ)) / RATE_HZ)
        for values in (*machine.all(), angles):
            key.update(np.ascontiguousarray(values).tobytes())
        name = key.hexdigest()
        if name not in self.kept:
            self.kept[name] = accelerations(machine, speed, duration_s=duration_s, start_rad=start_rad, dofs=dofs)
            self.kept[name].flags.writeable = False
        return self.kept[name]
