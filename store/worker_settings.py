"""How a worker behaves; the defaults are the promised ones, tests shorten them."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass

from store.environment import Numbers

DAY_S = 86400.0
LONGEST_KEPT_DAYS = 36_500.0


@dataclass(frozen=True, kw_only=True)
class WorkerSettings:
    """Times in seconds."""

    lease_s: float = 30.0
    """A running job whose worker is silent for so long is given to another."""
    renew_s: float = 5.0
    cancel_grace_s: float = 5.0
    """Time a cancelled job has to stop by itself."""
    shutdown_grace_s: float = 5.0
    """Time a running job has to end when the worker is asked to leave; then it is stopped and waits to start again."""
    maintenance_s: int = 30
    max_losses: int = 2
    keep_s: float | None = 30 * DAY_S
    """How long results are kept."""

    @classmethod
    def from_environment(cls, environment: Mapping[str, str] | None = None) -> WorkerSettings:
        """`SIDEBAND_LEASE_S`, `SIDEBAND_CANCEL_GRACE_S`, `SIDEBAND_SHUTDOWN_GRACE_S`, `SIDEBAND_KEEP_DAYS` (0: ever).

        SpecError names every variable that cannot be used.
        """
        read = Numbers(os.environ if environment is None else environment)
        lease = read.number("SIDEBAND_LEASE_S", cls.lease_s, least=1.0, most=DAY_S, unit="s")
        cancel = read.number("SIDEBAND_CANCEL_GRACE_S", cls.cancel_grace_s, most=DAY_S, unit="s")
        shutdown = read.number("SIDEBAND_SHUTDOWN_GRACE_S", cls.shutdown_grace_s, most=DAY_S, unit="s")
        days = read.number("SIDEBAND_KEEP_DAYS", 30, most=LONGEST_KEPT_DAYS, unit="days")
        read.settle()
        return cls(
            lease_s=lease,
            renew_s=min(cls.renew_s, lease / 4),
            cancel_grace_s=cancel,
            shutdown_grace_s=shutdown,
            keep_s=days * DAY_S if days > 0 else None,
        )
