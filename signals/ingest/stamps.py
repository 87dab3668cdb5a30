"""Time stamps that came with the samples: regular but for their printed digits, or refused with the place."""

from __future__ import annotations

import numpy as np

from signals.series import FloatArray
from signals.timebase import TimeBase, irregular, read_time_base
from signals.units import find_unit, unit_of
from sim.core.errors import Problem, SpecError

TIME_NAMES = frozenset({"time", "time_s", "t", "t_s", "timestamp", "timestamps", "timestamp_s"})
"""Columns of these names are looked at even when the description does not mention them."""
RATE_TOLERANCE = 1e-3
LEAST_WHOLE_HZ = 8.0
MOST_DIGITS = 12
COARSE_STEPS = 50
"""Stamps rounded to more than this many steps say nothing about their regularity."""


def is_time(unit: str) -> bool:
    """Whether the text is a unit of time."""
    found = find_unit(unit) if unit else None
    return found is not None and found.quantity == "time"


def seconds(stamps: FloatArray, unit: str, field: str) -> FloatArray:
    """Stamps in s."""
    if not is_time(unit):
        raise SpecError(Problem(field=field, message="is no unit of time", given=unit, allowed="s, ms, us, ns"))
    return stamps * unit_of(unit, field).factor


def in_seconds(raw: FloatArray, unit: str, samples: int, field: str) -> tuple[FloatArray, float]:
    """Stamps in s and what they were rounded to, s; there must be one a sample."""
    if raw.size != samples:
        message = "has another length than the channels"
        raise SpecError(Problem(field="time", message=message, given=raw.size, allowed=str(samples), unit="samples"))
    return seconds(raw, unit, field), float(seconds(np.array([resolution(raw)]), unit, field)[0])


def check_regular(times_s: FloatArray, resolution_s: float) -> TimeBase:
    """The time base of stamps that lie on a uniform clock but for rounding to `resolution_s`; else SpecError."""
    base = read_time_base(times_s)
    step = 1 / base.sampling_rate_hz
    rounding = min(1.01 * resolution_s, COARSE_STEPS * step)
    if base.uniform or (base.backward == 0 and base.largest_jitter_s <= rounding):
        return base
    raise irregular(base)


def resolution(stamps: FloatArray) -> float:
    """The step to which stamps were rounded when they were printed, in their own unit; 0 when none is seen."""
    scale = float(np.max(np.abs(stamps), initial=0.0))
    for digits in range(MOST_DIGITS):
        if np.allclose(np.round(stamps, digits), stamps, rtol=0, atol=4 * np.finfo(np.float64).eps * scale):
            return float(10.0**-digits)
    return 0.0


def agree(stated_hz: float, found_hz: float, field: str, source: str, tolerance: float = RATE_TOLERANCE) -> None:
    """Refuse two rates that contradict each other."""
    # a file that holds whole rates only is off by up to half a hertz
    rounding = 0.5 if found_hz >= LEAST_WHOLE_HZ and float(found_hz).is_integer() else 0.0
    if abs(stated_hz - found_hz) > max(tolerance * found_hz, rounding):
        message = f"does not agree with {source}"
        raise SpecError(Problem(field=field, message=message, given=stated_hz, allowed=f"{found_hz:.9g}", unit="Hz"))
