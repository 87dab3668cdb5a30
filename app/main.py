"""The FastAPI application."""

from __future__ import annotations

import contextlib
import threading
import time
from collections.abc import AsyncIterator
from functools import partial

from fastapi import Depends, FastAPI
from starlette.staticfiles import StaticFiles

from app import handlers
from app.document import describe
from app.guards.access import AccessGuard
from app.guards.body import BodyGuard
from app.guards.head import HeadAsGet
from app.guards.headers import ReplyHeaders
from app.guards.upload import UploadGuard
from app.instruments import Instruments, Measured
from app.query import only_known_query
from app.recovery import RecoveryThread
from app.routes import (
    dataset_files,
    datasets,
    docs,
    estimate,
    events,
    health,
    indicators,
    jobs,
    machines,
    plots,
    reconciliations,
    recordings,
    reference,
    results,
    simulations,
    terms,
)
from app.settings import Settings
from app.state import AppState
from jobs.ports import Engine
from jobs.slices import Encoder
from store.stores import Stores, open_stores

_MODULES = (
    simulations,
    estimate,
    jobs,
    events,
    results,
    indicators,
    plots,
    recordings,
    reconciliations,
    datasets,
    dataset_files,
    machines,
    terms,
    reference,
    health,
    docs,
)
ROUTERS = tuple(module.router for module in _MODULES)


def create_app(settings: Settings, *, engine: Engine, encode: Encoder, stores: Stores | None = None) -> FastAPI:
    """An application on these stores (opened from the settings when none are given)."""
    settings.check()
    state = AppState(
        settings=settings,
        stores=stores or open_stores(settings.stores),
        engine=engine,
        encode=encode,
        instruments=Instruments(),
        started_at=time.time(),
    )

    @contextlib.asynccontextmanager
    async def lifespan(_: FastAPI) -> AsyncIterator[None]:
        recovery = RecoveryThread(state)
        recovery.start()
        yield
        recovery.stop()
        state.stores.close()

    app = FastAPI(
        lifespan=lifespan,
        dependencies=[Depends(only_known_query)],
        docs_url=None,
        redoc_url=None,
        redirect_slashes=False,
    )
    app.state.sideband = state
    app.state.streams = set()
    app.state.stopping = threading.Event()
    app.state.routes = tuple(route for router in ROUTERS for route in router.routes)
    for router in ROUTERS:
        app.include_router(router)
    if settings.static_folder.is_dir():
        app.mount("/", StaticFiles(directory=settings.static_folder, html=True), name="dashboard")
    handlers.install(app)
    describe(app)
    _guard(app, state)
    return app


def _guard(app: FastAPI, state: AppState) -> None:
    """Guards, the innermost first."""
    settings = state.settings
    app.add_middleware(HeadAsGet)
    app.add_middleware(
        UploadGuard,
        max_bytes=settings.max_upload_bytes,
        piece_timeout_s=settings.body_timeout_s,
        timeout_s=settings.upload_timeout_s,
        other=partial(
            BodyGuard,
            max_bytes=settings.max_body_bytes,
            max_depth=settings.max_json_depth,
            timeout_s=settings.body_timeout_s,
        ),
    )
    app.add_middleware(AccessGuard, settings=settings)
    app.add_middleware(Measured, instruments=state.instruments)
    app.add_middleware(ReplyHeaders)
