"""Time stamps that came with the samples: regular but for their printed digits, or refused with the place."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from signals.readers.times import named_time, of_time
from signals.rounded import MOST_DRIFT, drifting_grid, first_off_grid, regular_grid, resolution, roundings
from signals.series import FloatArray
from signals.timebase import JITTER_SHARE, irregular, read_time_base
from signals.units import UNITS, find_unit, unit_of
from sim.core.errors import Problem, SpecError

RATES_HZ = (1e-3, 1e9)
"""Sampling rates that a recording may have, wherever they are stated."""
RATE_TOLERANCE = 1e-3
LEAST_WHOLE_HZ = 8.0
LEAST_SPAN_S, MOST_STAMP = 1e-100, 1e30
"""Of all stamps, and of one as stored: with others nothing can be reckoned."""
TIMES = {text: unit.factor for text, unit in UNITS.items() if unit.quantity == "time"}
"""Units of time and what they are in s."""
UNASKED_TOLERANCE = 0.01
"""Of the rate, by which stamps in no stated unit may miss it: clocks drift less, and rates mistaken differ by more."""


@dataclass(frozen=True, kw_only=True)
class Stamps:
    """What regular stamps say: the first, s, what they span, s, their rate and what they were rounded to, s.

    `said` is how they are written where that makes their steps scatter: the rate is then that of the grid fitted
    through all of them.
    """

    first_s: float
    span_s: float
    sampling_rate_hz: float
    rounded_s: float
    said: str
    drifts: bool = False
    """Whether the clock is even over a thousand samples only, and the rate the mean one."""

    @property
    def remarks(self) -> tuple[str, ...]:
        """What a person should know of rounded stamps."""
        if not self.said:
            return ()
        if self.drifts:
            return (
                (
                    f"time: stamps are rounded ({self.said}) and their clock drifts by less than {MOST_DRIFT:g} of its "
                    f"rate: the mean one is taken, {self.sampling_rate_hz:.9g} Hz"
                ),
            )
        return (
            (
                f"time: stamps are rounded ({self.said}, {self.rounded_s:.2g} s at most), so single steps scatter: "
                f"they lie on a regular grid of {self.sampling_rate_hz:.9g} Hz, fitted through all of them"
            ),
        )


def seconds(stamps: FloatArray, unit: str, field: str) -> FloatArray:
    """Stamps in s."""
    if not of_time(unit):
        raise SpecError(Problem(field=field, message="is no unit of time", given=unit, allowed=", ".join(TIMES)))
    return stamps * unit_of(unit, field).factor


def in_seconds(raw: FloatArray, unit: str, samples: int, field: str) -> Stamps:
    """Stamps in s, on a regular grid; there must be one a sample."""
    if raw.size != samples:
        message = "has another length than the channels"
        raise SpecError(Problem(field="time", message=message, given=raw.size, allowed=str(samples), unit="samples"))
    factor = float(seconds(np.array([1.0]), unit, field)[0])
    return check_regular(raw, factor)


def check_regular(raw: FloatArray, factor: float = 1.0) -> Stamps:
    """Stamps `factor` times `raw` that lie on a regular grid but for how `raw` is written; else SpecError."""
    _check_size(raw, factor)
    base = read_time_base(raw * factor)
    grid = regular_grid(raw)
    if grid is not None:
        found = Stamps(
            first_s=float(raw[0]) * factor,
            span_s=float(raw[-1] - raw[0]) * factor,
            sampling_rate_hz=1 / (grid.step * factor),
            rounded_s=grid.rounding * factor,
            said=grid.said,
        )
        if grid.rounding * factor > JITTER_SHARE * base.median_step_s:
            return found
        return replace(found, sampling_rate_hz=base.sampling_rate_hz, said="")
    drifting = None if base.uniform else drifting_grid(raw)
    if drifting is not None:
        return Stamps(
            first_s=float(raw[0]) * factor,
            span_s=float(raw[-1] - raw[0]) * factor,
            sampling_rate_hz=base.sampling_rate_hz,
            rounded_s=drifting.rounding * factor,
            said=drifting.said,
            drifts=True,
        )
    if base.uniform:
        return Stamps(
            first_s=float(raw[0]) * factor,
            span_s=float(raw[-1] - raw[0]) * factor,
            sampling_rate_hz=base.sampling_rate_hz,
            rounded_s=resolution(raw) * factor,
            said="",
        )
    fine = all(np.max(way.steps) * factor <= JITTER_SHARE * base.median_step_s for way in roundings(raw))
    place = None if fine else first_off_grid(raw)
    raise irregular(base if place is None else replace(base, first_place=place))


def _check_size(raw: FloatArray, factor: float) -> None:
    largest = float(np.max(np.abs(raw), initial=0.0))
    if math.isfinite(largest) and largest > MOST_STAMP:
        message = "stamps are beyond any clock"
        raise SpecError(Problem(field="time", message=message, given=f"{largest:g}", allowed=f"<= {MOST_STAMP:g}"))
    span = float(raw[-1]) - float(raw[0]) if raw.size else 0.0
    if 0.0 < span * factor < LEAST_SPAN_S:
        message = "stamps are all alike: the last is next to nothing after the first"
        raise SpecError(Problem(field="time", message=message, given=f"{span:g}"))


def unmentioned(raw: FloatArray, name: str, unit: str, rate_hz: float | None) -> tuple[Stamps | None, str]:
    """Stamps of a column (n,) that the description does not mention, if it is a time in a known unit, and what is to be
    said of it; `unit`: as the file states it. One that is a time by its name must be regular.

    A column that is none by its name is taken for one if its unit is of time and it rises throughout; without a unit
    it is only told of.
    """
    named = named_time(name)
    if of_time(unit) or (named is not None and not unit and named.unit):
        if named is None and not _rises(raw):
            return None, ""
        return in_seconds(raw, unit or (named.unit if named else ""), raw.size, name), ""
    if named is not None:
        if unit and find_unit(unit) is not None:
            return None, ""  # temperatures, say
        check_unasked(raw, name, rate_hz)
    elif not unit and _rises(raw) and not _regular(raw):
        return None, (
            f"{name}: rises throughout as a time does, in steps that differ, and was not looked at; if it is the "
            "time, state `time` with its column and unit"
        )
    return None, ""


def _rises(raw: FloatArray) -> bool:
    return raw.size > 1 and bool(np.all(raw[1:] >= raw[:-1]) and raw[-1] > raw[0])


def _regular(raw: FloatArray) -> bool:
    try:
        check_regular(raw)
    except SpecError:
        return False
    return True


def check_unasked(stamps: FloatArray, name: str, rate_hz: float | None) -> None:
    """Stamps (n,) of a column whose unit nobody states, held against the rate, Hz, if one is known.

    SpecError where they are irregular, or where their steps are those of the rate in no unit of time. A column that
    steps by 1 may count samples.
    """
    found_at = check_regular(stamps)
    per_unit = found_at.sampling_rate_hz
    tolerance = max(UNASKED_TOLERANCE, 2 * found_at.rounded_s / found_at.span_s)
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


def check_rate(rate_hz: float, field: str, whose: str) -> None:
    """Refuse a rate that no recording of vibrations has, nor any arithmetic survives; `whose` begins the message."""
    low, high = RATES_HZ
    if not low <= rate_hz <= high:
        message = f"{whose} no sampling rate of a vibration"
        allowed = f"{low:g} to {high:g}"
        raise SpecError(Problem(field=field, message=message, given=f"{rate_hz:.9g}", allowed=allowed, unit="Hz"))
