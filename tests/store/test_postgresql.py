"""What only a database server does: starting together, going away, filling up, refusing."""

from __future__ import annotations

import threading

import pytest
from sqlalchemy import Engine, text
from sqlalchemy.exc import ProgrammingError

from jobs.errors import StoreAway, StoreFull
from jobs.ports import Remembered
from sim.core.errors import SpecError
from store.catalogue import engine, keys, schema
from store.catalogue.catalogue import SqlCatalogue
from tests.service import postgresql
from tests.service.parts import eventually


@pytest.mark.slow
def test_processes_that_start_together_create_one_schema(postgresql_url: str) -> None:
    engines = [engine.connect(postgresql_url, pooled=False) for _ in range(6)]
    schema.metadata.drop_all(engines[0])
    faults: list[BaseException] = []

    def create(database: object) -> None:
        try:
            schema.create_schema(database)  # type: ignore[arg-type]
        except BaseException as error:
            faults.append(error)

    threads = [threading.Thread(target=create, args=(database,)) for database in engines]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not faults and schema.tables_present(engines[0])


@pytest.mark.slow
def test_second_request_with_a_key_finds_the_first_though_both_looked_before(postgresql_url: str) -> None:
    database = engine.connect(postgresql_url)
    schema.metadata.drop_all(database)
    schema.create_schema(database)
    found: list[object] = []

    def ask() -> None:
        found.append(SqlCatalogue(database).remember("s", "k", "h2", "j2", 1.0))

    second = threading.Thread(target=ask)
    with database.begin() as first:
        keys.remember(first, "s", "k", "h1", "j1", 1.0)
        second.start()
        _until_blocked(database)
    second.join()
    assert found == [Remembered(body_sha256="h1", job_id="j1")]
    database.dispose()


def _until_blocked(database: Engine) -> None:
    waiting = text("select count(*) from pg_stat_activity where wait_event_type = 'Lock'")

    def blocked() -> bool:
        with database.connect() as look:
            return bool(look.execute(waiting).scalar())

    eventually(blocked)


@pytest.mark.slow
def test_statement_that_takes_too_long_is_ended(postgresql_url: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(engine, "BUSY_TIMEOUT_S", 1)
    database = engine.connect(postgresql_url, pooled=False)
    with pytest.raises(StoreAway, match="57014"), engine.translated(), database.connect() as connection:
        connection.execute(text("select pg_sleep(20)"))


def test_full_disk_is_told() -> None:
    full = ProgrammingError("insert", {}, RuntimeError({"C": "53100", "M": "could not extend file"}))
    with pytest.raises(StoreFull), engine.translated():
        raise full


@pytest.mark.slow
def test_server_that_leaves_is_away_and_its_pool_comes_back(request: pytest.FixtureRequest) -> None:
    reason = postgresql.missing()
    if reason:
        pytest.skip(reason)
    with postgresql.cluster() as url:
        database = engine.connect(url)
        schema.create_schema(database)
        catalogue = SqlCatalogue(database)
        assert catalogue.waiting() == 0
        with database.connect() as admin:
            victim = text("select pg_terminate_backend(pid) from pg_stat_activity where pid <> pg_backend_pid()")
            admin.execute(victim)
        assert catalogue.waiting() == 0, "a connection the server closed is replaced"
    with pytest.raises(StoreAway):
        catalogue.waiting()
    database.dispose()


@pytest.mark.parametrize(
    ("url", "says"),
    [
        ("nonsense", "is not a database URL"),
        ("postgresql+asyncpg2://u:secret@h/d", "not installed"),
        ("mysql://u:secret@h/d", "not installed"),
    ],
)
def test_urls_that_cannot_be_used_are_told_without_their_password(url: str, says: str) -> None:
    with pytest.raises(SpecError) as caught:
        engine.connect(url)
    assert caught.value.problems[0].field == "DATABASE_URL"
    assert says in str(caught.value) and "secret" not in str(caught.value)
