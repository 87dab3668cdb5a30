"""What is seen of a recording at one speed, whatever model answers: stretches, their spectra and features."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from learn import features, unknown, whole
from learn.bank import MIN_TURNS, Bank, bank
from learn.features import Found
from learn.orders import FaultOrders
from signals.series import FloatArray
from sim.core.errors import Problem, SpecError

LONGEST_TURNS = 20.0
"""Longer recordings are read in equal stretches. Over many turns even the faint lines of a sound machine become
certain; over few only deep ones do. They show where lines are; longer recordings are answered by the whole."""
MOST_STRETCHES = 12
Row = tuple[FloatArray, dict[str, float], dict[str, Found]]
"""Features, the one comb (geometry unknown), the families (known)."""


@dataclass(frozen=True, kw_only=True)
class Looked:
    """A recording as it was looked at. `orders` None: geometry unknown."""

    channels: tuple[FloatArray, ...]
    rate_hz: float
    speed_hz: float
    orders: FaultOrders | None
    doubt: float

    @cached_property
    def shown(self) -> tuple[Bank, ...]:
        """Spectra of the stretches."""
        parts = stretches(self.channels, self.rate_hz, self.speed_hz)
        return tuple(bank(part, self.rate_hz, self.speed_hz) for part in parts)

    @cached_property
    def rows(self) -> tuple[Row, ...]:
        """Of each stretch."""
        return tuple(row_of(one, self.orders, self.doubt) for one in self.shown)

    @cached_property
    def table(self) -> FloatArray:
        """Features of the stretches, (stretches, features)."""
        return np.stack([row for row, _, _ in self.rows])

    @cached_property
    def long(self) -> tuple[Bank, ...]:
        """Spectra of the recording in as few parts as may be."""
        parts = stretches(self.channels, self.rate_hz, self.speed_hz, whole.TURNS)
        return tuple(bank(part, self.rate_hz, self.speed_hz) for part in parts)

    @cached_property
    def long_table(self) -> FloatArray:
        """Features of the whole at the geometry that is known, (parts, features)."""
        if self.orders is None:
            raise ValueError("without orders a recording has no features of a known geometry")
        return np.stack([whole.vector(one, self.orders, self.doubt)[0] for one in self.long])


def row_of(spectra: Bank, orders: FaultOrders | None, doubt: float) -> Row:
    """Features of one stretch."""
    if orders is None:
        row, comb = unknown.vector(spectra)
        return row, comb, {}
    row, found = features.vector(spectra, orders, doubt)
    return row, {}, found


def stretches(
    channels: Sequence[FloatArray], rate_hz: float, speed_hz: float, longest: float = LONGEST_TURNS
) -> list[list[FloatArray]]:
    """Equal stretches of all channels, none longer than `longest` turns."""
    samples = min(c.size for c in channels)
    turns = samples / rate_hz * speed_hz
    if turns < MIN_TURNS:
        allowed = f"at least {MIN_TURNS / speed_hz:.3g}"
        raise SpecError(
            Problem(field="samples", message="are too few turns", given=samples / rate_hz, allowed=allowed, unit="s")
        )
    count = min(max(1, int(np.ceil(turns / longest))), MOST_STRETCHES)
    length = min(samples // count, int(longest * rate_hz / speed_hz))
    return [[np.asarray(c[i * length : (i + 1) * length], dtype=np.float64) for c in channels] for i in range(count)]
