"""The analogue filter before the sampler."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from signals.sensors.linear import butterworth, butterworth_settle_s, filtered
from signals.series import FloatArray
from sim.core.spec import SpecModel


class AntiAlias(SpecModel):
    """Butterworth low-pass. A low order leaves what lies above half the sampling rate to fold back: as in life."""

    cutoff_hz: Annotated[float, Field(ge=1, le=1_000_000)]
    """-3 dB."""
    order: Annotated[int, Field(ge=1, le=12)] = 4


def through_filter(samples: FloatArray, rate_hz: float, spec: AntiAlias) -> FloatArray:
    """Filtered samples (n,); before the record its first value stood at the input."""
    tail_s = butterworth_settle_s(spec.cutoff_hz, spec.order)
    return filtered(samples, rate_hz, lambda f: butterworth(f, spec.cutoff_hz, spec.order), tail_s, held=True)
