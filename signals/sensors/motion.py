"""What a chain measures: the motion of a machine, with the angles of its shafts."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from signals.recording import Recording, from_response
from signals.sensors.shafts import shaft_named
from signals.series import FloatArray
from sim.core.response import Response
from sim.core.spec import MachineSpec
from sim.core.speed import CONSTANT, warped_times


@dataclass(frozen=True, kw_only=True)
class Motion:
    """Channels before any sensor. Without a machine (a recording of another origin) nothing is known of shafts.

    `bases_hz` are the kinematic base frequencies, `speed` the table of the speed over time (`sim.core.speed`).
    """

    recording: Recording
    machine: MachineSpec | None = None
    bases_hz: Mapping[str, float] = field(default_factory=dict)
    speed: FloatArray = field(default_factory=CONSTANT.copy)

    def time_s(self) -> FloatArray:
        """Time since the start of the simulation, shape (n,), s."""
        return self.recording.time_s()

    def angle_rad(self, shaft: str) -> FloatArray:
        """Angle of a shaft by its speed profile, shape (n,), rad: 2 pi times the turns since t = 0."""
        index, _ = shaft_named(self.machine, shaft, "shaft")
        assert self.machine is not None and self.machine.operating is not None
        operating = self.machine.operating
        driven, _ = shaft_named(self.machine, operating.shaft, "shaft")
        ratio = self.bases_hz[f"f_r{index}"] / self.bases_hz[f"f_r{driven}"]
        turns = operating.speed_hz * warped_times(self.speed, self.time_s())[0]
        angle: FloatArray = 2.0 * math.pi * ratio * np.asarray(turns)
        return angle


def motion_of(response: Response) -> Motion:
    """The motion that a simulation found."""
    return Motion(
        recording=from_response(response), machine=response.machine, bases_hz=response.bases_hz, speed=response.speed
    )
