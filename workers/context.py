"""What a worker process holds while it lives. It is set before the worker forks, so every job inherits warm kernels."""

from __future__ import annotations

import time
from dataclasses import dataclass

from rq.timeouts import JobTimeoutException

from jobs.accept import Desk
from jobs.limits import Limits
from jobs.ports import Analyser, Engine
from jobs.run import Bench
from store.atlas import AtlasFolder
from store.settings import StoreSettings
from store.stores import Stores, open_stores
from store.worker_settings import WorkerSettings


@dataclass(frozen=True, kw_only=True)
class Context:
    """The stores, the physics and the analysis of this process."""

    name: str
    stores: Stores
    store_settings: StoreSettings
    settings: WorkerSettings
    engine: Engine
    analyse: Analyser

    def bench(self) -> Bench:
        """For running a job."""
        return Bench(
            catalogue=self.stores.catalogue,
            artefacts=self.stores.artefacts,
            engine=self.engine,
            analyse=self.analyse,
            clock=time.time,
            lease_s=self.settings.lease_s,
            max_losses=self.settings.max_losses,
            keep_s=self.settings.keep_s,
            timeouts=(JobTimeoutException,),
            keeper=AtlasFolder(self.store_settings.atlas_folder),
            desk=self.desk(),
        )

    def desk(self) -> Desk:
        """For handing work over again."""
        return Desk(
            catalogue=self.stores.catalogue,
            queue=self.stores.queue,
            artefacts=self.stores.artefacts,
            engine=self.engine,
            limits=Limits(),
            clock=time.time,
        )


def open_context(
    name: str, store_settings: StoreSettings, settings: WorkerSettings, engine: Engine, analyse: Analyser
) -> Context:
    """Connect. No database connection stays open between calls: none may be carried through a fork."""
    return Context(
        name=name,
        stores=open_stores(store_settings, pooled=False),
        store_settings=store_settings,
        settings=settings,
        engine=engine,
        analyse=analyse,
    )


_installed: list[Context] = []


def install(context: Context) -> None:
    """Make the context the one of this process."""
    _installed[:] = [context]


def installed() -> Context:
    """The context of this process."""
    if not _installed:
        raise RuntimeError("no worker context in this process; start workers with `python -m workers`")
    return _installed[0]
