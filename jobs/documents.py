"""What the analysis of a response yields, ready to be stored."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
SpectrumKind = Literal["amplitude", "psd", "envelope", "order"]
SPECTRUM_KINDS: tuple[SpectrumKind, ...] = ("amplitude", "psd", "envelope", "order")
Json = Mapping[str, object]


@dataclass(frozen=True, kw_only=True)
class SpectrumDocument:
    """One spectrum of one channel. `axis` and `values` have shape (lines,).

    `axis_unit` is `Hz` or `order`; `unit` that of the values; `meta` says peak or RMS, window, scaling, resolution.
    """

    channel: str
    kind: SpectrumKind
    axis: FloatArray
    axis_unit: str
    values: FloatArray
    unit: str
    meta: Json


@dataclass(frozen=True, kw_only=True)
class ResultDocuments:
    """Everything that is kept of a simulation beside its signals.

    `summary` holds features, quality, derived values and warnings; `peaks` holds `frequencies` and `peaks`; `extras`
    further documents by name (`causes`, `impacts`).
    """

    summary: Json
    peaks: Json
    spectra: tuple[SpectrumDocument, ...]
    extras: Mapping[str, Json] = field(default_factory=dict)
