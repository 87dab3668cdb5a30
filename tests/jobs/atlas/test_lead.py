"""A round is made whoever helps, dies, hangs or forgets: the numbers are those of one worker alone."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, BinaryIO

import pytest

from jobs import transitions
from jobs.atlas import lead, pieces
from jobs.atlas.document import made_by
from jobs.errors import StaleAttempt, StoreFull
from jobs.ports import Lane
from jobs.record import Failure
from jobs.status import Status
from reconcile.observe.statistics import Statistics
from tests.jobs.atlas.rounds import LEASE_S, House, pretended, same, todo

pytestmark = pytest.mark.slow  # writes of a catalogue that wait for the disk

DRAWS = sum(len(task.draws) for task in todo())


@pytest.fixture
def house(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> House:
    made = House(tmp_path, monkeypatch)
    made.reconciliation()
    return made


def alone() -> list[list[Statistics | None]]:
    return [pretended(task) for task in todo()]


class Once:
    """Called at every look of the leading worker: acts at the first where `when` tasks are done."""

    def __init__(self, act: Any, when: int = 1) -> None:
        self.act, self.when, self.told = act, when, []

    def __call__(self, done: int) -> None:
        self.told.append(done)
        if done >= self.when and self.act is not None:
            act, self.act = self.act, None
            act()


def test_one_worker_makes_all_and_takes_its_tickets_back(house: House) -> None:
    heard = Once(None)
    assert same(house.led(heard), alone()) and house.simulated == DRAWS
    assert house.makers() == {"w1": len(house.pieces())} and len(house.pieces()) > 4
    assert house.round().status is Status.SUCCESSFUL and house.queue.held == []
    assert heard.told == sorted(heard.told) and heard.told[-1] < len(todo())
    assert house.catalogue.waiting() == 0


def test_others_make_pieces_too(house: House) -> None:
    def helped() -> None:
        assert {ticket.lane for ticket in house.queue.held} == {Lane.HELP}
        for _ in range(3):
            made = house.help_out()
            assert made is not None and made.status is Status.SUCCESSFUL

    assert same(house.led(Once(helped)), alone())
    assert house.makers() == {"w1": len(house.pieces()) - 3, "w2": 3} and house.simulated == DRAWS


def test_seconds_are_those_that_others_spent_for_this_run(house: House) -> None:
    heard = Once(lambda: [house.help_out() for _ in range(3)])
    shared = house.lead().shared(todo(), heard)
    assert shared is not None and sum(seconds > 0.0 for seconds, _ in shared) == 3
    assert [found for seconds, found in house.lead().shared(todo(), heard) or [] if seconds > 0.0] == []


def test_a_piece_whose_maker_died_is_made_again(house: House) -> None:
    waits: list[float] = []

    def wait(seconds: float) -> None:
        waits.append(seconds)
        house.now += LEASE_S / 3

    assert same(house.led(Once(lambda: house.take(house.pieces()[0])), wait=wait), alone())
    assert 3 <= len(waits) <= 5 and house.pieces()[0].attempt == 2
    assert house.makers() == {"w1": len(house.pieces())}


def test_a_maker_that_lives_but_does_not_get_on_is_not_waited_for(house: House) -> None:
    def wait(seconds: float) -> None:
        house.now += 1.0
        held = house.pieces()[0]
        house.catalogue.change(
            held.id, lambda r: transitions.renew(r, attempt=r.attempt, lease_s=LEASE_S, now=house.now)
        )

    begin = house.now
    assert same(house.led(Once(lambda: house.take(house.pieces()[0])), wait=wait), alone())
    assert house.now - begin < pieces.LEASES * LEASE_S + 10.0
    left = house.round()
    assert left.status is Status.RUNNING and left.cancel_requested_at is not None and left.submitters == ()
    assert house.pieces()[0].cancel_requested_at is not None, "the other worker hears that nobody waits for it"


def test_a_piece_that_failed_elsewhere_is_made_here(house: House) -> None:
    def fails() -> None:
        first = house.pieces()[0]
        house.take(first)
        house.catalogue.change(
            first.id,
            lambda r: transitions.fail(r, attempt=1, failure=Failure(code="not-makeable", message="no"), now=1.0),
        )

    assert same(house.led(Once(fails)), alone())


@pytest.mark.parametrize("changed", ["physics", "atlas"])
def test_a_worker_of_other_versions_refuses_and_does_no_harm(
    changed: str, house: House, monkeypatch: pytest.MonkeyPatch
) -> None:
    def helped() -> None:
        with monkeypatch.context() as other:
            other.setattr("jobs.atlas.piece.made_by", lambda: {**made_by(), changed: "another"})
            made = house.help_out()
        assert made is not None and made.failure is not None and made.failure.code == "not-makeable"

    assert same(house.led(Once(helped)), alone())


def test_damaged_numbers_are_made_again(house: House) -> None:
    def helped() -> None:
        made = house.help_out()
        assert made is not None
        with house.artefacts.write(f"{made.id}/1/found.npz") as stream:
            stream.write(b"other")

    assert same(house.led(Once(helped)), alone()) and house.simulated > DRAWS
    assert same(house.led(), alone()) and {record.gone for record in house.pieces()} == {None}
    made = house.simulated
    assert same(house.led(), alone()) and house.simulated == made, "the damaged piece was replaced"


def test_without_a_broker_or_a_store_that_takes_anything(house: House, monkeypatch: pytest.MonkeyPatch) -> None:
    house.queue.away = True
    assert same(house.led(), alone())
    assert house.queue.asked < 4 + len(house.pieces()), "a broker that is away is not asked each time"

    @contextmanager
    def full(key: str) -> Iterator[BinaryIO]:
        raise StoreFull("full")
        yield

    house.now += 2 * 86_400
    monkeypatch.setattr(house.artefacts, "write", full)
    assert house.lead().shared(todo()[:-1], lambda done: None) is None, "the reconciliation goes on alone"


def test_a_store_that_fills_up_midway(house: House, monkeypatch: pytest.MonkeyPatch) -> None:
    def fill() -> None:
        @contextmanager
        def full(key: str) -> Iterator[BinaryIO]:
            raise StoreFull("full")
            yield

        monkeypatch.setattr(house.artefacts, "write", full)

    assert same(house.led(Once(fill, when=3)), alone())
    assert house.round().status is Status.DISMISSED and house.pieces(Status.ACCEPTED, Status.RUNNING) == []


def test_little_work_and_too_large_a_document_stay_here(house: House, monkeypatch: pytest.MonkeyPatch) -> None:
    assert house.lead().shared(todo()[:1], lambda done: None) is None
    monkeypatch.setattr(lead, "MOST_DOCUMENT_BYTES", 100)
    assert house.lead().shared(todo(), lambda done: None) is None


def test_another_attempt_of_the_reconciliation_keeps_the_round(house: House) -> None:
    def taken_over() -> None:
        raise StaleAttempt("another attempt")

    with pytest.raises(StaleAttempt):
        house.led(Once(taken_over, when=4))
    assert house.round().status is Status.RUNNING and house.pieces(Status.ACCEPTED)
    made = house.simulated
    assert same(house.led(worker="w3"), alone())
    assert house.simulated < DRAWS + made and house.makers().keys() == {"w1", "w3"}, "finished pieces are used again"


def test_an_error_of_the_engine_ends_the_round(house: House) -> None:
    def broken() -> None:
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        house.led(Once(broken, when=2))
    assert house.round().status is Status.DISMISSED
    statuses: set[Status] = {record.status for record in house.pieces()}
    assert statuses == {Status.DISMISSED, Status.SUCCESSFUL}
