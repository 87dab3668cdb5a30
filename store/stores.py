"""All the stores of one process."""

from __future__ import annotations

from dataclasses import dataclass

from redis import Redis

from jobs.ports import ArtefactStore
from store.artefacts.choose import open_artefacts
from store.catalogue import engine, schema
from store.catalogue.catalogue import SqlCatalogue
from store.catalogue.ledger import SqlLedger
from store.queue import rq_queue
from store.settings import StoreSettings


@dataclass(frozen=True, kw_only=True)
class Stores:
    """The catalogue, the artefacts and the queue."""

    catalogue: SqlCatalogue
    artefacts: ArtefactStore
    queue: rq_queue.RqQueue

    @property
    def ledger(self) -> SqlLedger:
        """What was charged to holders of API keys."""
        return SqlLedger(self.catalogue.engine)

    def close(self) -> None:
        """Give back connections."""
        self.catalogue.engine.dispose()
        self.queue.connection.close()


def open_stores(settings: StoreSettings, *, connection: Redis | None = None, pooled: bool = True) -> Stores:
    """Connect and create the schema where it is missing. The broker is not asked: it may be away."""
    settings.data_dir.mkdir(parents=True, exist_ok=True)
    database = engine.connect(settings.catalogue_url, pooled=pooled)
    with engine.translated():
        schema.create_schema(database)
    return Stores(
        catalogue=SqlCatalogue(database),
        artefacts=open_artefacts(settings),
        queue=rq_queue.RqQueue(connection or rq_queue.connect(settings.redis_url)),
    )
