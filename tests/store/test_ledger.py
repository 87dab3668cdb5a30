"""What holders were charged: kept for a day, for all processes, one after the other."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from sqlalchemy import Engine, text

from jobs.budget import WINDOW_S, Charge
from jobs.errors import BudgetSpent, BudgetTooSmall
from store.catalogue import engine, schema
from store.catalogue import ledger as module
from store.catalogue.ledger import SqlLedger

NOW = 1e9


@pytest.fixture(params=["sqlite", pytest.param("postgresql", marks=pytest.mark.slow)])
def database(tmp_path: Path, request: pytest.FixtureRequest) -> Iterator[Engine]:
    url = f"sqlite:///{tmp_path / 'c.sqlite'}"
    if request.param == "postgresql":
        url = request.getfixturevalue("postgresql_url")
    opened = engine.connect(url)
    schema.metadata.drop_all(opened)
    schema.create_schema(opened)
    yield opened
    opened.dispose()


def charge(core_seconds: float, *, holder: str = "ann", at: float = NOW) -> Charge:
    return Charge(holder=holder, job_id="j", core_seconds=core_seconds, time=at)


def test_beyond_the_limit_says_what_was_used_and_when_to_come_back(database: Engine) -> None:
    ledger = SqlLedger(database)
    ledger.charge(charge(60), 100)
    ledger.charge(charge(30, at=NOW + 100), 100)
    with pytest.raises(BudgetSpent) as caught:
        SqlLedger(database).charge(charge(20, at=NOW + 200), 100)
    error = caught.value
    assert (error.limit, error.used, error.asked) == (100, 90, 20)
    assert error.retry_after_s == WINDOW_S - 200
    ledger.charge(charge(20, at=NOW + WINDOW_S), 100)
    assert ledger.used("ann", NOW + WINDOW_S) == 50


def test_holders_do_not_meet_and_one_without_limit_is_counted(database: Engine) -> None:
    ledger = SqlLedger(database)
    ledger.charge(charge(1e6), None)
    ledger.charge(charge(100, holder="ben"), 100)
    assert ledger.used("ann", NOW) == 1e6 and ledger.used("ben", NOW) == 100 and ledger.used("eve", NOW) == 0
    with pytest.raises(BudgetSpent):
        ledger.charge(charge(1), 100)


def test_more_than_a_whole_day_never_fits(database: Engine) -> None:
    with pytest.raises(BudgetTooSmall, match="101"):
        SqlLedger(database).charge(charge(101), 100)


def test_a_refund_makes_room(database: Engine) -> None:
    ledger = SqlLedger(database)
    ledger.refund(ledger.charge(charge(100), 100))
    ledger.charge(charge(100), 100)


@pytest.mark.slow
def test_of_many_at_once_only_as_many_as_fit(database: Engine, monkeypatch: pytest.MonkeyPatch) -> None:
    refused, check = [], module._check

    def slow(*asked: Any) -> None:
        check(*asked)
        time.sleep(0.03)  # Between the look and the charge: whoever may look meanwhile sees too little.

    monkeypatch.setattr(module, "_check", slow)

    def ask() -> None:
        try:
            SqlLedger(database).charge(charge(10), 50)
        except BudgetSpent as error:
            refused.append(error)

    threads = [threading.Thread(target=ask) for _ in range(12)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(refused) == 7 and SqlLedger(database).used("ann", NOW) == 50


def test_a_catalogue_from_before_gets_the_table(database: Engine) -> None:
    with database.begin() as connection:
        connection.execute(text("DROP TABLE charges"))
    schema.create_schema(database)
    SqlLedger(database).charge(charge(1), 1)
