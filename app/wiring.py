"""The application as it is served: the simulation core and the encoders of `signals`."""

from __future__ import annotations

import sys

from fastapi import FastAPI

from app.main import create_app
from app.settings import Settings
from jobs.physics import PhysicsEngine
from signals.encode import encode
from sim.core.errors import SidebandError, SpecError

WRONG_SETTINGS = 2


def application(settings: Settings | None = None) -> FastAPI:
    """For uvicorn: `uvicorn --factory app.wiring:application`. Wrong settings are told in a line each."""
    try:
        return create_app(settings or Settings.from_environment(), engine=PhysicsEngine(), encode=encode)
    except SpecError as error:
        sys.stderr.writelines(f"sideband: {problem}\n" for problem in error.problems)
        raise SystemExit(WRONG_SETTINGS) from error
    except SidebandError as error:
        raise SystemExit(f"sideband: {error}") from error
