"""Proximity probe: gap to a turning surface, with the run-out of that surface and the probe's linear range."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, Self

import numpy as np
from pydantic import Field, model_validator

from signals.series import FloatArray
from sim.core.spec import Name, SpecModel


class RunOut(SpecModel):
    """One harmonic of the mechanical and electrical run-out: it repeats with the shaft and is no vibration."""

    order: Annotated[int, Field(ge=1, le=1000)] = 1
    amplitude_m: Annotated[float, Field(ge=0, le=1e-2)]
    phase_deg: Annotated[float, Field(ge=-360, le=360)] = 0.0


class Probe(SpecModel):
    """Where the probe stands and what it can see."""

    gap_m: Annotated[float, Field(ge=0, le=0.1)] = 0.0
    """Distance at rest; a shaft that moves along the probe's direction, away from it, widens it."""
    range_low_m: Annotated[float, Field(ge=-0.1, le=0.1)] | None = None
    range_high_m: Annotated[float, Field(ge=-0.1, le=0.1)] | None = None
    """Ends of the linear range: gaps beyond read as the end. None: no end."""
    shaft: Name | None = None
    """Shaft whose angle the run-out follows; needed with `run_out`."""
    run_out: Annotated[list[RunOut], Field(max_length=64, default_factory=list)]

    @model_validator(mode="after")
    def _whole(self) -> Self:
        if self.run_out and self.shaft is None:
            raise ValueError("`run_out` repeats with a shaft: say which in `shaft`")
        low = -math.inf if self.range_low_m is None else self.range_low_m
        high = math.inf if self.range_high_m is None else self.range_high_m
        if not low <= self.gap_m <= high or low >= high:
            raise ValueError("the gap at rest must lie within range_low_m < range_high_m")
        return self


@dataclass(frozen=True, kw_only=True)
class Seen:
    """Gap as the probe reads it, m, shape (n,), and how many samples were beyond its range."""

    gap_m: FloatArray
    beyond: int


def run_out_m(probe: Probe, angle_rad: FloatArray) -> FloatArray:
    """Run-out at shaft angles (n,), m: sum of amplitude cos(order angle + phase)."""
    total = np.zeros(angle_rad.shape)
    for item in probe.run_out:
        total += item.amplitude_m * np.cos(item.order * angle_rad + math.radians(item.phase_deg))
    return total


def seen(motion_m: FloatArray, probe: Probe, angle_rad: FloatArray | None) -> Seen:
    """What the probe sees of the motion (n,), m, along its direction."""
    gap = probe.gap_m + motion_m
    if angle_rad is not None:
        gap = gap + run_out_m(probe, angle_rad)
    low = -math.inf if probe.range_low_m is None else probe.range_low_m
    high = math.inf if probe.range_high_m is None else probe.range_high_m
    held = np.clip(gap, low, high)
    return Seen(gap_m=held, beyond=int(np.count_nonzero(held != gap)))
