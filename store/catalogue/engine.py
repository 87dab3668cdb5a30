"""Connecting to the catalogue's database: SQLite in WAL mode by default, PostgreSQL by URL."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager

from sqlalchemy import Connection, Engine, create_engine, event
from sqlalchemy.exc import DBAPIError, IntegrityError, OperationalError, SQLAlchemyError
from sqlalchemy.pool import ConnectionPoolEntry, NullPool

from jobs.errors import StoreAway, StoreFull

BUSY_TIMEOUT_S = 15
_FULL = ("disk is full", "No space left", "disk full")


def connect(url: str, *, pooled: bool = True) -> Engine:
    """An engine for the URL; `pooled` False keeps no connection open, as a process that forks must.

    For SQLite: WAL, full synchronisation (a reply must survive a power cut), no waiting for ever."""
    if not url.startswith("sqlite"):
        if not pooled:
            return create_engine(url, poolclass=NullPool)
        return create_engine(url, pool_pre_ping=True, pool_size=10, max_overflow=20)
    pool = None if pooled else NullPool
    engine = create_engine(url, poolclass=pool, connect_args={"timeout": BUSY_TIMEOUT_S, "check_same_thread": False})
    event.listen(engine, "connect", _configure_sqlite)
    event.listen(engine, "begin", _begin_sqlite)
    return engine


def _configure_sqlite(connection: sqlite3.Connection, _: ConnectionPoolEntry) -> None:
    # The driver's own implicit BEGIN would start a deferred transaction; ours is begun below.
    connection.isolation_level = None
    cursor = connection.cursor()
    cursor.execute("PRAGMA journal_mode=WAL")
    cursor.execute("PRAGMA synchronous=FULL")
    cursor.execute(f"PRAGMA busy_timeout={BUSY_TIMEOUT_S * 1000}")
    cursor.close()


def _begin_sqlite(connection: Connection) -> None:
    # A deferred transaction that reads and then writes fails at once when another writer came between.
    read_only = connection.get_execution_options().get("read_only", False)
    connection.exec_driver_sql("BEGIN" if read_only else "BEGIN IMMEDIATE")


@contextmanager
def translated() -> Iterator[None]:
    """Database errors as the job layer's own."""
    try:
        yield
    except IntegrityError:
        raise
    except OperationalError as error:
        text = str(error.orig)
        if any(phrase in text for phrase in _FULL):
            raise StoreFull("the disk of the catalogue is full") from error
        raise StoreAway(f"the catalogue does not answer: {text.splitlines()[0]}") from error
    except DBAPIError as error:
        raise StoreAway(f"the catalogue refused: {type(error.orig).__name__}") from error
    except SQLAlchemyError as error:
        raise StoreAway(f"the catalogue cannot be used: {type(error).__name__}") from error
