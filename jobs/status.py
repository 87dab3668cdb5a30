"""The five words a job's state is told in."""

from __future__ import annotations

from enum import StrEnum


class Status(StrEnum):
    """Where a job stands. The words follow OGC API Processes 1.0 (OGC 18-062r2)."""

    ACCEPTED = "accepted"
    RUNNING = "running"
    SUCCESSFUL = "successful"
    FAILED = "failed"
    DISMISSED = "dismissed"

    @property
    def active(self) -> bool:
        """Whether work is still to come."""
        return self in (Status.ACCEPTED, Status.RUNNING)
