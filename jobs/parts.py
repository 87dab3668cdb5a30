"""What the job layer needs of the catalogue for jobs that are made in parts."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

from jobs.record import JobRecord
from jobs.status import Status

Transition = Callable[[JobRecord], JobRecord]


@dataclass(frozen=True, kw_only=True)
class Part:
    """A job that is part of another, with its request."""

    record: JobRecord
    request: Mapping[str, object]


@dataclass(frozen=True, kw_only=True)
class Tally:
    """How the parts of a job stand."""

    counts: Mapping[tuple[str, Status], int]
    """Parts whose result is not gone, by kind and status."""
    gone: int
    """Parts that succeeded, but whose result is not kept any more."""
    kept: int
    """Parts that had succeeded before a given time."""

    def of(self, kind: str, *statuses: Status) -> int:
        """Number of parts of a kind in these states."""
        return sum(self.counts.get((kind, status), 0) for status in statuses)


class PartCatalogue(Protocol):
    """Jobs that are made in parts. Every method is one transaction."""

    def put(self, parent: Part, again: Transition, parts: Sequence[Part], revive: Transition) -> tuple[JobRecord, bool]:
        """Insert the parent with its parts, or change the present one with `again`; True when inserted.

        When that begins a new attempt, `revive` is applied to every part.
        """

    def of(self, parent_id: str, *statuses: Status) -> list[JobRecord]:
        """The parts in their order, all or those in these states."""

    def tally(self, parent_id: str, before: float) -> Tally:
        """How many stand where; `before`: up to when finished parts count as kept."""

    def change(self, parent_id: str, transition: Transition) -> list[JobRecord]:
        """Apply a transition to every part; returns those that it changed."""

    def parent_of(self, part_id: str) -> str | None:
        """The job that it is a part of."""

    def unfinished(self, kind: str) -> list[str]:
        """Ids of jobs of a kind that have not ended, oldest first."""
