"""The application as it is served: the simulation core and the encoders of `signals`."""

from __future__ import annotations

from fastapi import FastAPI

from app.main import create_app
from app.settings import Settings
from jobs.physics import PhysicsEngine
from signals.encode import encode
from sim.core.errors import SidebandError


def application(settings: Settings | None = None) -> FastAPI:
    """For uvicorn: `uvicorn --factory app.wiring:application`. What is wrong with the settings is told in one line."""
    try:
        return create_app(settings or Settings.from_environment(), engine=PhysicsEngine(), encode=encode)
    except SidebandError as error:
        raise SystemExit(f"sideband: {error}") from error
