"""Tables. Columns exist for what is searched, sorted or counted; the rest of a record is JSON text."""

from __future__ import annotations

from sqlalchemy import (
    BigInteger,
    Column,
    Engine,
    Float,
    Index,
    Integer,
    MetaData,
    String,
    Table,
    Text,
    func,
    inspect,
    select,
)

SCHEMA_VERSION = 1
_SCHEMA_LOCK = 0x51DEBA4D
"""Any number, the same in every process."""
_SEQUENCE = BigInteger().with_variant(Integer(), "sqlite")

metadata = MetaData()

meta = Table("sideband_meta", metadata, Column("name", String(40), primary_key=True), Column("value", String(200)))

jobs = Table(
    "jobs",
    metadata,
    Column("id", String(32), primary_key=True),
    Column("kind", String(40), nullable=False),
    Column("status", String(16), nullable=False),
    Column("gone", String(16)),
    Column("preset", String(80)),
    Column("attempt", Integer, nullable=False),
    Column("worker", String(120)),
    Column("failure_code", String(40)),
    Column("created_at", Float(53), nullable=False),
    Column("accepted_at", Float(53), nullable=False),
    Column("updated_at", Float(53), nullable=False),
    Column("enqueued_at", Float(53)),
    Column("not_before", Float(53)),
    Column("started_at", Float(53)),
    Column("finished_at", Float(53)),
    Column("lease_until", Float(53)),
    Column("expires_at", Float(53)),
    Column("record", Text, nullable=False),
    Column("request", Text, nullable=False),
    Index("jobs_by_status", "status", "accepted_at"),
    Index("jobs_by_created", "created_at", "id"),
    Index("jobs_by_updated", "updated_at", "id"),
)

parts = Table(
    "job_parts",
    metadata,
    Column("parent_id", String(32), primary_key=True),
    Column("number", Integer, primary_key=True, autoincrement=False),
    Column("part_id", String(32), nullable=False),
    Index("parts_by_part", "part_id"),
)

events = Table(
    "job_events",
    metadata,
    Column("sequence", _SEQUENCE, primary_key=True, autoincrement=True),
    Column("job_id", String(32), nullable=False),
    Column("time", Float(53), nullable=False),
    Column("kind", String(16), nullable=False),
    Column("data", Text, nullable=False),
    Index("events_by_job", "job_id", "sequence"),
    sqlite_autoincrement=True,
)

keys = Table(
    "idempotency_keys",
    metadata,
    Column("scope", String(120), primary_key=True),
    Column("key", String(255), primary_key=True),
    Column("body_sha256", String(64), nullable=False),
    Column("job_id", String(32), nullable=False),
    Column("created_at", Float(53), nullable=False),
)

charges = Table(
    "charges",
    metadata,
    Column("number", _SEQUENCE, primary_key=True, autoincrement=True),
    Column("holder", String(120), nullable=False),
    Column("job_id", String(32), nullable=False),
    Column("core_seconds", Float(53), nullable=False),
    Column("time", Float(53), nullable=False),
    Index("charges_by_holder", "holder", "time"),
    Index("charges_by_time", "time"),
)

workers = Table(
    "workers",
    metadata,
    Column("name", String(120), primary_key=True),
    Column("host", String(255), nullable=False),
    Column("pid", Integer, nullable=False),
    Column("state", String(16), nullable=False),
    Column("job_id", String(32)),
    Column("started_at", Float(53), nullable=False),
    Column("seen_at", Float(53), nullable=False),
)


def create_schema(engine: Engine) -> None:
    """Create what is missing and check the version; running it again, or in several processes at once, does no harm."""
    with engine.begin() as connection:
        if engine.dialect.name == "postgresql":
            # Two processes that start together would both find nothing and both create; SQLite's lock is taken already.
            connection.execute(select(func.pg_advisory_xact_lock(_SCHEMA_LOCK)))
        metadata.create_all(connection)
        row = connection.execute(meta.select().where(meta.c.name == "schema_version")).first()
        if row is None:
            connection.execute(meta.insert().values(name="schema_version", value=str(SCHEMA_VERSION)))
        elif row.value != str(SCHEMA_VERSION):
            raise RuntimeError(
                f"the catalogue has schema version {row.value}, this program needs {SCHEMA_VERSION}; "
                "use another data folder or database"
            )


def tables_present(engine: Engine) -> bool:
    """Whether the catalogue was created."""
    return bool(inspect(engine).has_table("jobs"))
