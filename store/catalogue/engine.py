"""Connecting to the catalogue's database: SQLite in WAL mode by default, PostgreSQL by URL."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager

from sqlalchemy import URL, Connection, Engine, create_engine, event, make_url
from sqlalchemy.exc import ArgumentError, DBAPIError, IntegrityError, OperationalError, SQLAlchemyError
from sqlalchemy.pool import ConnectionPoolEntry, NullPool

from jobs.errors import StoreAway, StoreFull
from sim.core.errors import Problem, SpecError

BUSY_TIMEOUT_S = 15
SILENCE_S = 30
"""Longest silence of a database server; longer than a statement may take, so that the server ends that itself."""
_FULL = ("disk is full", "No space left", "disk full")
_FULL_STATE = "53100"
"""`disk_full` (PostgreSQL documentation, appendix A, error codes)."""
_DRIVER = "postgresql+pg8000"
_POSTGRESQL = {"postgresql": _DRIVER, "postgres": _DRIVER}


def connect(url: str, *, pooled: bool = True) -> Engine:
    """An engine for the URL; `pooled` False keeps no connection open, as a process that forks must.

    For SQLite: WAL, full synchronisation (a reply must survive a power cut), no waiting for ever."""
    if not url.startswith("sqlite"):
        return _server(url, pooled)
    pool = None if pooled else NullPool
    engine = create_engine(url, poolclass=pool, connect_args={"timeout": BUSY_TIMEOUT_S, "check_same_thread": False})
    event.listen(engine, "connect", _configure_sqlite)
    event.listen(engine, "begin", _begin_sqlite)
    return engine


def _server(text: str, pooled: bool) -> Engine:
    """A database server; PostgreSQL by the driver of the `postgres` extra unless the URL names another."""
    try:
        url = make_url(text)
    except ArgumentError as error:
        raise _refused("is not a database URL") from error
    url = url.set(drivername=_POSTGRESQL.get(url.drivername, url.drivername))
    arguments: dict[str, object] = {}
    if url.drivername == _DRIVER:
        arguments = {"timeout": SILENCE_S, "startup_params": {"statement_timeout": str(BUSY_TIMEOUT_S * 1000)}}
    try:
        if not pooled:
            return create_engine(url, poolclass=NullPool, connect_args=arguments)
        return create_engine(url, pool_pre_ping=True, pool_size=10, max_overflow=20, connect_args=arguments)
    except (ModuleNotFoundError, ArgumentError) as error:
        extra = "; install the extra `postgres`" if url.drivername == _DRIVER else ""
        raise _refused(f"needs a database driver that is not installed{extra}", url) from error


def _refused(message: str, url: URL | None = None) -> SpecError:
    # A URL that cannot be read is not repeated: a password may be in it.
    given = None if url is None else url.render_as_string(hide_password=True)
    allowed = "sqlite:///FILE or postgresql://USER:PASSWORD@HOST/DATABASE"
    return SpecError(Problem(field="DATABASE_URL", message=message, given=given, allowed=allowed))


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
        if _state(error) == _FULL_STATE:
            raise StoreFull("the disk of the catalogue is full") from error
        raise StoreAway(f"the catalogue refused: {type(error.orig).__name__} {_state(error)}".rstrip()) from error
    except SQLAlchemyError as error:
        raise StoreAway(f"the catalogue cannot be used: {type(error).__name__}") from error


def _state(error: DBAPIError) -> str:
    """PostgreSQL's five-character code, empty when the driver gives none."""
    told = error.orig.args[0] if error.orig is not None and error.orig.args else None
    return str(told.get("C", "")) if isinstance(told, dict) else str(getattr(error.orig, "sqlstate", None) or "")
