"""Time stamps that came with the samples: regular but for their printed digits, or refused with the place."""

from __future__ import annotations

import math

import numpy as np

from signals.series import FloatArray
from signals.timebase import TimeBase, irregular, read_time_base
from signals.units import UNITS, find_unit, unit_of
from sim.core.errors import Problem, SpecError

TIME_NAMES = frozenset({"time", "time_s", "t", "t_s", "timestamp", "timestamps", "timestamp_s"})
"""Columns of these names are looked at even when the description does not mention them."""
RATE_TOLERANCE = 1e-3
LEAST_WHOLE_HZ = 8.0
MOST_DIGITS = 12
COARSE_STEPS = 50
"""Stamps rounded to more than this many steps say nothing about their regularity."""
TIMES = {text: unit.factor for text, unit in UNITS.items() if unit.quantity == "time"}
"""Units of time and what they are in s."""
UNASKED_TOLERANCE = 0.01
"""Of the rate, by which stamps in no stated unit may miss it: clocks drift less, and rates mistaken differ by more."""


def is_time(unit: str) -> bool:
    """Whether the text is a unit of time."""
    found = find_unit(unit) if unit else None
    return found is not None and found.quantity == "time"


def seconds(stamps: FloatArray, unit: str, field: str) -> FloatArray:
    """Stamps in s."""
    if not is_time(unit):
        raise SpecError(Problem(field=field, message="is no unit of time", given=unit, allowed=", ".join(TIMES)))
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


def check_unasked(stamps: FloatArray, name: str, rate_hz: float | None) -> None:
    """Stamps (n,) of a column whose unit nobody states, held against the rate, Hz, if one is known.

    SpecError where they are irregular, or where their steps are those of the rate in no unit of time. A column that
    steps by 1 may count samples.
    """
    rounded = resolution(stamps)
    per_unit = check_regular(stamps, rounded).sampling_rate_hz
    tolerance = max(UNASKED_TOLERANCE, 2 * rounded / float(stamps[-1] - stamps[0]))
    if rate_hz is None or abs(per_unit - 1.0) <= tolerance:
        return
    found = {unit: per_unit / factor for unit, factor in TIMES.items()}
    if any(abs(rate_hz / hz - 1.0) <= tolerance for hz in found.values()):
        return
    unit, nearest = min(found.items(), key=lambda one: abs(math.log(one[1] / rate_hz)))
    message = (
        f"does not agree with the column {name!r}, whose steps of {1 / per_unit:.6g} are those of this rate in none of "
        f"{', '.join(TIMES)}: correct the rate, or state `time` with its column and unit instead; a column that is not "
        "the time needs another name in the file"
    )
    allowed = f"{nearest:.6g} Hz if {name!r} is in {unit}"
    raise SpecError(Problem(field="sampling_rate_hz", message=message, given=f"{rate_hz:.9g} Hz", allowed=allowed))


def agree(stated_hz: float, found_hz: float, field: str, source: str, tolerance: float = RATE_TOLERANCE) -> None:
    """Refuse two rates that contradict each other."""
    # a file that holds whole rates only is off by up to half a hertz
    rounding = 0.5 if found_hz >= LEAST_WHOLE_HZ and float(found_hz).is_integer() else 0.0
    if abs(stated_hz - found_hz) > max(tolerance * found_hz, rounding):
        message = f"does not agree with {source}"
        raise SpecError(Problem(field=field, message=message, given=stated_hz, allowed=f"{found_hz:.9g}", unit="Hz"))
