"""One channel of samples at a uniform rate: what every analysis works on."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sim.core.errors import Problem, SpecError

FloatArray = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
BoolArray = NDArray[np.bool_]
IntArray = NDArray[np.int64]
MIN_SAMPLES = 8
"""Below this no window, floor or moment means anything."""


@dataclass(frozen=True, kw_only=True)
class Series:
    """Finite samples of one channel; sample j is at t = start_s + j / sampling_rate_hz.

    `samples` has shape (n,), float64, in `unit`.
    """

    samples: FloatArray
    sampling_rate_hz: float
    unit: str
    name: str = ""
    quantity: str = ""
    start_s: float = 0.0

    def __post_init__(self) -> None:
        rate = checked_rate(self.sampling_rate_hz)
        samples = np.asarray(self.samples, dtype=np.float64)
        if samples.ndim != 1 or samples.size < MIN_SAMPLES:
            raise SpecError(
                Problem(
                    field=f"{self.name or 'series'}.samples",
                    message="must be one row of samples",
                    given=f"shape {samples.shape}",
                    allowed=f"at least {MIN_SAMPLES} samples",
                )
            )
        bad = np.flatnonzero(~np.isfinite(samples))
        if bad.size:
            place = f"sample {bad[0]} (t = {self.start_s + bad[0] / rate:.6g} s)"
            raise SpecError(
                Problem(
                    field=f"{self.name or 'series'}.samples",
                    message=f"{bad.size} samples are not finite, the first at {place}",
                    allowed="finite numbers; cut the bad stretch out first",
                    unit=self.unit,
                )
            )
        object.__setattr__(self, "samples", read_only(samples))
        object.__setattr__(self, "sampling_rate_hz", rate)

    @property
    def duration_s(self) -> float:
        """Length n / sampling_rate_hz, s."""
        return self.samples.size / self.sampling_rate_hz


def checked_rate(sampling_rate_hz: object) -> float:
    """Return the sampling rate as a float, or refuse it: a rate is never guessed."""
    numeric = isinstance(sampling_rate_hz, int | float | np.floating | np.integer)
    rate = float(sampling_rate_hz) if numeric and not isinstance(sampling_rate_hz, bool) else math.nan  # type: ignore[arg-type]
    if not (math.isfinite(rate) and rate > 0):
        raise SpecError(
            Problem(
                field="sampling_rate_hz",
                message="must be known and positive; it is never guessed",
                given=sampling_rate_hz,
                allowed="above 0",
                unit="Hz",
            )
        )
    return rate


def read_only(values: FloatArray) -> FloatArray:
    """A view of `values` that cannot be written through, so that frozen really is frozen."""
    view = values.view()
    view.setflags(write=False)
    return view
