"""What holders of API keys may have computed in a day: estimated core-seconds of work that was accepted for them.

The day is the last 24 hours, not a date. What was charged is kept in a ledger of its own and not read off the jobs: a
job that is cancelled, made anew or forgotten has used its time all the same.
"""

from __future__ import annotations

import contextlib
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Protocol

from jobs.errors import JobError

WINDOW_S = 86400.0


@dataclass(frozen=True, kw_only=True)
class Charge:
    """Work accepted for a holder: estimated core-seconds, at a time in seconds since the epoch, UTC."""

    holder: str
    job_id: str
    core_seconds: float
    time: float


class Ledger(Protocol):
    """Charges of the last day, for all processes that serve. Raises StoreAway or StoreFull when it cannot answer."""

    def charge(self, charge: Charge, limit: float | None) -> int:
        """Keep a charge and return its number; raises BudgetSpent, BudgetTooSmall when it goes beyond the limit."""

    def refund(self, number: int) -> None:
        """Forget a charge: nothing came of it."""


@dataclass(frozen=True, kw_only=True)
class Budget:
    """Whose work it is and how much of it a day, core-seconds; None: no bound, but counted."""

    holder: str
    core_seconds_per_day: float | None
    ledger: Ledger

    @contextlib.contextmanager
    def charged(self, job_id: str, core_seconds: float, now: float) -> Iterator[None]:
        """Charge the work that is accepted inside; an error in there gives it back."""
        charge = Charge(holder=self.holder, job_id=job_id, core_seconds=core_seconds, time=now)
        number = self.ledger.charge(charge, self.core_seconds_per_day)
        try:
            yield
        except BaseException:
            with contextlib.suppress(JobError):
                self.ledger.refund(number)
            raise


def wait_s(charges: Sequence[tuple[float, float]], asked: float, limit: float, now: float) -> int:
    """Whole seconds until `asked` fits, of charges (time, core-seconds), the oldest first; asked <= limit."""
    until = now
    left = [seconds for _, seconds in charges]
    for i, (time, _) in enumerate(charges):
        if math.fsum(left[i:]) + asked <= limit:
            break
        until = time + WINDOW_S
    return max(1, math.ceil(until - now))
