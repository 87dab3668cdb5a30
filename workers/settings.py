"""How a worker behaves; the defaults are the promised ones, tests shorten them."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class WorkerSettings:
    """Times in seconds."""

    lease_s: float = 30.0
    """A running job whose worker is silent for so long is given to another."""
    renew_s: float = 5.0
    cancel_grace_s: float = 5.0
    """Time a cancelled job has to stop by itself."""
    shutdown_grace_s: float = 5.0
    """Time a running job has to end when the worker is asked to leave; then it is handed back."""
    maintenance_s: int = 30
    max_losses: int = 2
    keep_s: float | None = 30 * 86400.0
    """How long results are kept."""

    @classmethod
    def from_environment(cls, environment: Mapping[str, str] | None = None) -> WorkerSettings:
        """`SIDEBAND_LEASE_S`, `SIDEBAND_CANCEL_GRACE_S`, `SIDEBAND_SHUTDOWN_GRACE_S`, `SIDEBAND_KEEP_DAYS` (0: ever)"""
        env = os.environ if environment is None else environment
        lease = float(env.get("SIDEBAND_LEASE_S", cls.lease_s))
        days = float(env.get("SIDEBAND_KEEP_DAYS", 30))
        return cls(
            lease_s=lease,
            renew_s=min(cls.renew_s, lease / 4),
            cancel_grace_s=float(env.get("SIDEBAND_CANCEL_GRACE_S", cls.cancel_grace_s)),
            shutdown_grace_s=float(env.get("SIDEBAND_SHUTDOWN_GRACE_S", cls.shutdown_grace_s)),
            keep_s=days * 86400.0 if days > 0 else None,
        )
