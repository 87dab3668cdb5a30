"""Mounting resonance: the sensor's mass on the stiffness of its fastening and of its own element."""

from __future__ import annotations

from typing import Annotated, Self

from pydantic import Field, model_validator

from signals.sensors.linear import MAX_SETTLE_S, filtered, resonance, settle_s
from signals.series import FloatArray
from sim.core.spec import SpecModel


class Mounting(SpecModel):
    """A second-order resonance, 1 / (1 - r^2 + 2 i zeta r): what a seismic sensor shows of its foot's acceleration.

    C. M. Harris, A. G. Piersol (eds.), Harris' Shock and Vibration Handbook, 5th ed. (2002), ch. 12: accelerometers
    below their resonance. Stud, glue, magnet and hand-held probe differ in the frequency.
    """

    frequency_hz: Annotated[float, Field(ge=10, le=250_000)]
    damping_ratio: Annotated[float, Field(ge=1e-3, le=10)] = 0.03

    @model_validator(mode="after")
    def _dies_out(self) -> Self:
        if settle_s(self.frequency_hz, self.damping_ratio) > MAX_SETTLE_S:
            raise ValueError(f"rings for more than {MAX_SETTLE_S:g} s; damping_ratio * frequency_hz must be larger")
        return self


def through_mounting(samples: FloatArray, rate_hz: float, mounting: Mounting) -> FloatArray:
    """Motion as the sensor's element feels it (n,), from rest."""
    f_n, zeta = mounting.frequency_hz, mounting.damping_ratio
    return filtered(samples, rate_hz, lambda f: resonance(f, f_n, zeta), settle_s(f_n, zeta))
