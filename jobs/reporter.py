"""Progress of a running attempt, told at most five times a second; every report also asks whether to stop."""

from __future__ import annotations

import logging
from collections.abc import Callable

from jobs import transitions
from jobs.errors import StaleAttempt, StoreAway
from jobs.ports import Clock, JobCatalogue
from jobs.record import JobRecord, Progress
from sim.core.errors import Cancelled

log = logging.getLogger(__name__)

MIN_INTERVAL_S = 0.2
LOOK_INTERVAL_S = 0.25
"""Longer than between reports, so that a solver that reports need not ask as well."""
SELDOM_S = 2.0
"""Between two looks or reports of a part of something large: a thousand workers ask one catalogue."""
SIMULATION_SHARE = 0.85
"""Part of the whole that the simulation takes; analysis and storing share the rest."""


class Reporter:
    """Writes progress and the lease into the catalogue and remembers whether the work is still wanted."""

    def __init__(
        self, catalogue: JobCatalogue, clock: Clock, *, job_id: str, attempt: int, lease_s: float, seldom: bool = False
    ) -> None:
        self._catalogue, self._clock = catalogue, clock
        self._job_id, self._attempt, self._lease_s = job_id, attempt, lease_s
        self._started = self._told = self._looked = clock()
        self._report_s, self._look_s = (SELDOM_S, SELDOM_S) if seldom else (MIN_INTERVAL_S, LOOK_INTERVAL_S)
        self._stop = False
        self._stale: StaleAttempt | None = None

    def simulating(self, fraction: float) -> None:
        """Called by the solver with its own fraction 0..1."""
        now = self._clock()
        if now - self._told < self._report_s:
            return
        done = min(max(fraction, 0.0), 1.0) * SIMULATION_SHARE
        eta = (now - self._started) * (1 - done) / done if done > 0.01 else None
        self._tell(Progress(fraction=done, stage="simulating", eta_s=eta), now)

    def cancelled(self) -> bool:
        """Whether to stop; called by the solver. Asks the catalogue at most five times a second."""
        now = self._clock()
        if not self._stop and now - self._looked >= self._look_s:
            self._look(lambda: self._catalogue.get(self._job_id))
        return self._stop

    def stage(self, name: str, fraction: float, eta_s: float | None = None) -> None:
        """Enter a stage, with the time left in s where it is known; raises Cancelled when the work is not wanted."""
        self._tell(Progress(fraction=fraction, stage=name, eta_s=eta_s), self._clock())
        self.raise_if_stale()
        if self._stop:
            raise Cancelled("cancelled")

    def raise_if_stale(self) -> None:
        """Raise StaleAttempt when another attempt took over."""
        if self._stale is not None:
            raise self._stale

    def _tell(self, progress: Progress, now: float) -> None:
        self._told = now
        self._look(
            lambda: self._catalogue.change(
                self._job_id,
                lambda r: transitions.advance(
                    r, attempt=self._attempt, progress=progress, lease_s=self._lease_s, now=now
                ),
            )
        )

    def _look(self, ask: Callable[[], JobRecord]) -> None:
        self._looked = self._clock()
        try:
            record = ask()
        except StaleAttempt as error:
            self._stale, self._stop = error, True
        except StoreAway as error:
            # A report that is lost does no harm; the work goes on and the next one is tried.
            log.warning("progress of %s not written: %s", self._job_id, error)
        else:
            self._stop = record.cancel_requested_at is not None or record.attempt != self._attempt
