"""Arrays with their units."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Channel:
    """An output: quantity (acceleration ...), SI unit, where and along which axis."""

    name: str
    quantity: str
    unit: str
    location: str
    axis: str


@dataclass(frozen=True, kw_only=True)
class Signals:
    """`values` has shape (channels, samples), in each channel's unit; sample j is at start_s + j / sampling_rate_hz."""

    sampling_rate_hz: float
    start_s: float
    channels: tuple[Channel, ...]
    values: FloatArray

    @property
    def t_s(self) -> FloatArray:
        """Times of the samples, shape (samples,), s."""
        return self.start_s + np.arange(self.values.shape[1]) / self.sampling_rate_hz

    def __getitem__(self, name: str) -> FloatArray:
        """Samples of one channel, shape (samples,)."""
        names = [channel.name for channel in self.channels]
        if name not in names:
            raise KeyError(f"no channel {name!r}; there are: {', '.join(names)}")
        row: FloatArray = self.values[names.index(name)]
        return row


@dataclass(frozen=True, kw_only=True)
class Spectrum:
    """`axis` (Hz or order) and `values` have shape (lines,); `meta` says peak or RMS, window, scaling."""

    channel: str
    kind: str
    axis: FloatArray
    axis_unit: str
    values: FloatArray
    unit: str
    meta: Mapping[str, Any]
