"""The analogue-to-digital converter."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np
from pydantic import Field

from signals.series import FloatArray
from sim.core.spec import SpecModel


class Converter(SpecModel):
    """A uniform quantiser with 2^bits codes from -range to range less one step."""

    bits: Annotated[int, Field(ge=2, le=32)] = 24
    range_v: Annotated[float, Field(gt=0, le=1e6)] = 10.0
    """Full scale either way."""
    offset_v: Annotated[float, Field(ge=-1e6, le=1e6)] = 0.0
    """Offset error: added before conversion and left in."""


@dataclass(frozen=True, kw_only=True)
class Converted:
    """Volts (n,) on the converter's grid, how many samples were beyond its range, and its step."""

    volts: FloatArray
    clipped: int
    step_v: float


def converted(volts: FloatArray, spec: Converter) -> Converted:
    """Rounded to the nearest code, ends held. The error of a busy signal has variance step^2 / 12.

    W. R. Bennett, "Spectra of quantized signals", Bell Syst. Tech. J. 27 (1948), 446-472.
    """
    step = 2.0 * spec.range_v / 2.0**spec.bits
    half = 2.0 ** (spec.bits - 1)
    codes = np.rint((volts + spec.offset_v) / step)
    held = np.clip(codes, -half, half - 1.0)
    return Converted(volts=held * step, clipped=int(np.count_nonzero(held != codes)), step_v=step)
