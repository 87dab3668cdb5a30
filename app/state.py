"""What the routes work with, and how they get at it."""

from __future__ import annotations

import time
from dataclasses import dataclass, field
from typing import Annotated, cast

from fastapi import Depends, Request

from app.instruments import Instruments
from app.settings import Settings
from jobs.accept import Desk
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

    def desk(self) -> Desk:
        """For accepting and recovering."""
        return Desk(
            catalogue=self.stores.catalogue,
            queue=self.stores.queue,
            artefacts=self.stores.artefacts,
            engine=self.engine,
            limits=self.settings.limits,
            clock=time.time,
        )


def state_of(request: Request) -> AppState:
    """The application's state."""
    return cast(AppState, request.app.state.sideband)


def principal_of(request: Request) -> str:
    """Holder of the API key; empty without keys."""
    return str(request.scope.get("state", {}).get("principal", ""))


State = Annotated[AppState, Depends(state_of)]
Principal = Annotated[str, Depends(principal_of)]
