"""Rounds are shared by the reconciliations that want them, and end with the last of these."""

from __future__ import annotations

from pathlib import Path

import pytest

from jobs import recover, transitions
from jobs.atlas.words import KEPT_S
from jobs.control import Caller, cancel, delete, expire_results
from jobs.errors import IllegalTransition, UnknownArtefact
from jobs.status import Status
from sim.core.errors import Cancelled
from tests.jobs.atlas.rounds import House, pretended, same, todo
from tests.jobs.atlas.test_lead import DRAWS, Once

pytestmark = pytest.mark.slow  # writes of a catalogue that wait for the disk


@pytest.fixture
def house(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> House:
    made = House(tmp_path, monkeypatch)
    made.reconciliation()
    return made


def interrupted() -> None:
    raise Cancelled("cancelled")


def killed() -> None:
    raise KilledOutright


class KilledOutright(BaseException):
    """Ends the leading worker without a word: nothing of its clean-up runs."""


@pytest.fixture
def silent(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("jobs.atlas.lead.Lead._leave", lambda *_: None)
    monkeypatch.setattr("jobs.atlas.pieces.transitions.release", lambda r, **_: r)


def test_a_cancel_drops_what_waits_and_is_heard_by_those_who_help(house: House) -> None:
    def cancelled() -> None:
        house.take(house.pieces()[0])
        interrupted()

    with pytest.raises(Cancelled):
        house.led(Once(cancelled, when=3))
    first, *rest = house.pieces()
    assert first.status is Status.RUNNING and first.cancel_requested_at is not None
    assert {record.status for record in rest} == {Status.SUCCESSFUL, Status.DISMISSED}
    house.catalogue.change(first.id, lambda r: transitions.dismiss(r, attempt=1, now=house.now))
    recover.tick(house.desk, max_losses=2)
    assert house.round().status is Status.DISMISSED
    with pytest.raises(UnknownArtefact):
        house.artefacts.size(f"{house.round().id}/0/plan.json")


def test_a_ticket_of_a_dropped_piece_does_nothing(house: House) -> None:
    with pytest.raises(Cancelled):
        house.led(Once(interrupted, when=3))
    made = house.simulated
    assert house.queue.held and all(house.help_out() is None for _ in list(house.queue.held))
    assert house.simulated == made


@pytest.mark.usefixtures("silent")
def test_a_leader_that_died_leaves_its_round_as_long_as_the_reconciliation_lives(house: House) -> None:
    with pytest.raises(KilledOutright):
        house.led(Once(killed, when=3))
    recover.tick(house.desk, max_losses=2)
    assert house.round().status is Status.RUNNING
    made = house.help_out()
    assert made is not None and made.status is Status.SUCCESSFUL, "others go on meanwhile"
    house.catalogue.change("r1", lambda r: transitions.dismiss(r, attempt=1, now=house.now))
    recover.tick(house.desk, max_losses=2)
    assert house.pieces(Status.ACCEPTED) == []


def test_two_at_once_make_it_once(house: House) -> None:
    house.reconciliation("r2")
    second: list[bool] = []

    def joins() -> None:
        second.append(
            same(house.led(name="r2", worker="w2", wait=lambda _: setattr(house, "now", house.now + 9)), want)
        )

    want = [pretended(task) for task in todo()]
    heard = Once(joins, when=0)
    assert same(house.led(heard), want) and second == [True]
    assert house.simulated == DRAWS and house.round().status is Status.SUCCESSFUL


def test_one_of_two_that_leaves_does_not_stop_the_other(house: House) -> None:
    house.reconciliation("r2")

    def second_leaves() -> None:
        with pytest.raises(Cancelled):
            house.led(Once(interrupted, when=2), name="r2", worker="w2")

    assert same(house.led(Once(second_leaves)), [pretended(task) for task in todo()])
    assert house.round().status is Status.SUCCESSFUL and house.simulated == DRAWS


def test_found_again_for_a_day_then_made_anew(house: House) -> None:
    want = house.led()
    assert same(house.led(name="r1"), want) and house.simulated == DRAWS, "kept pieces serve the next run"
    house.now += KEPT_S + 60
    expire_results(house.catalogue, house.artefacts, house.clock)
    assert house.round().gone == "expired" and {record.gone for record in house.pieces()} == {"expired"}
    assert not [*house.artefacts_left()]
    assert same(house.led(), want) and house.simulated == 2 * DRAWS


def test_nobody_else_decides_over_rounds_and_pieces(house: House) -> None:
    house.led()
    for record in (house.round(), house.pieces()[0]):
        with pytest.raises(IllegalTransition, match="reconciliations"):
            cancel(house.catalogue, house.queue, house.clock, record.id, Caller())
        with pytest.raises(IllegalTransition, match="reconciliations"):
            delete(house.catalogue, house.artefacts, house.clock, record.id)
