"""Lost stretches of a record: a loose plug, a full buffer, a lost packet."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from signals.series import BoolArray, FloatArray
from sim.core.spec import SpecModel


class Gap(SpecModel):
    """A stretch that is lost for certain."""

    start_s: Annotated[float, Field(ge=0, le=3600)]
    duration_s: Annotated[float, Field(gt=0, le=3600)]


class Dropouts(SpecModel):
    """Gaps at random (Poisson, of exponential length), and gaps at given places."""

    rate_per_s: Annotated[float, Field(ge=0, le=1000)] = 0.0
    """Mean number of random gaps that begin in a second."""
    mean_duration_s: Annotated[float, Field(gt=0, le=100)] = 0.01
    gaps: Annotated[list[Gap], Field(max_length=1000, default_factory=list)]
    fill: Literal["hold", "zero", "nan"] = "hold"
    """What stands in a gap: the last value, zero, or a mark that no analysis takes for a number."""


def lost(spec: Dropouts, samples: int, rate_hz: float, rng: np.random.Generator) -> BoolArray:
    """Which samples are lost, shape (samples,). Random gaps cover the share 1 - exp(-rate duration) on average."""
    mask = np.zeros(samples, dtype=bool)
    duration_s = samples / rate_hz
    starts = [gap.start_s for gap in spec.gaps]
    lengths = [gap.duration_s for gap in spec.gaps]
    if spec.rate_per_s > 0:
        # Gaps that began before the record reach into it: drawn over a stretch that is long enough before.
        before_s = 20.0 * spec.mean_duration_s
        count = int(rng.poisson(spec.rate_per_s * (duration_s + before_s)))
        starts += list(rng.uniform(-before_s, duration_s, count))
        lengths += list(rng.exponential(spec.mean_duration_s, count))
    for start, length in zip(starts, lengths, strict=True):
        first, stop = np.ceil(start * rate_hz - 1e-9), np.ceil((start + length) * rate_hz - 1e-9)
        mask[int(np.clip(first, 0, samples)) : int(np.clip(stop, 0, samples))] = True
    return mask


def filled(samples: FloatArray, mask: BoolArray, fill: Literal["hold", "zero", "nan"]) -> FloatArray:
    """Samples (n,) with the lost ones replaced; a gap at the very beginning is held at zero."""
    if fill != "hold":
        return np.where(mask, 0.0 if fill == "zero" else np.nan, samples)
    last = np.maximum.accumulate(np.where(mask, -1, np.arange(samples.size)))
    held: FloatArray = np.where(last < 0, 0.0, samples[np.maximum(last, 0)])
    return held
