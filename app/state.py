"""What the routes work with, and how they get at it."""

from __future__ import annotations

import time
from dataclasses import dataclass, field
from typing import Annotated, cast

from fastapi import Depends, Request

from app.instruments import Instruments
from app.key_file import Key
from app.settings import Settings
from jobs.accept import Desk
from jobs.budget import Budget
from jobs.health.watch import Watch
from jobs.kept import Kept
from jobs.ports import Engine
from jobs.slices import Encoder
from store.stores import Stores


@dataclass(frozen=True, kw_only=True)
class AppState:
    """One per application."""

    settings: Settings
    stores: Stores
    engine: Engine
    encode: Encoder
    instruments: Instruments
    started_at: float
    labels: Kept = field(default_factory=Kept)
    """Labels of channels that are not stored with their result."""
    watch: Watch = field(default_factory=Watch)
    """Machines as their recordings show them."""

    def desk(self, budget: Budget | None = None) -> Desk:
        """For accepting and recovering; `budget`: of whoever asks."""
        return Desk(
            catalogue=self.stores.catalogue,
            queue=self.stores.queue,
            artefacts=self.stores.artefacts,
            engine=self.engine,
            limits=self.settings.limits,
            clock=time.time,
            budget=budget,
        )


def state_of(request: Request) -> AppState:
    """The application's state."""
    return cast(AppState, request.app.state.sideband)


def _key_of(request: Request) -> Key | None:
    return cast(Key | None, request.scope.get("state", {}).get("key"))


def principal_of(request: Request) -> str:
    """Holder of the API key; empty without keys."""
    key = _key_of(request)
    return "" if key is None else key.name


def budget_of(request: Request) -> Budget | None:
    """What the holder of the API key may have computed; None without keys."""
    key = _key_of(request)
    if key is None:
        return None
    ledger = state_of(request).stores.ledger
    return Budget(holder=key.name, core_seconds_per_day=key.core_seconds_per_day, ledger=ledger)


State = Annotated[AppState, Depends(state_of)]
Principal = Annotated[str, Depends(principal_of)]
HolderBudget = Annotated[Budget | None, Depends(budget_of)]
