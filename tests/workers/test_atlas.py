"""An atlas that two real workers make on a real broker: both have their part, the report is that of one alone."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import httpx
import numpy as np
import pytest

from app.main import create_app
from jobs.atlas.words import PIECE
from jobs.physics import PhysicsEngine
from jobs.ports import JobQuery
from jobs.record import JobRecord
from jobs.status import Status
from signals.encode import encode
from signals.recording import Operating, Recording
from sim.core.response import Channel
from sim.core.spec import TermSpec
from sim.presets import preset
from sim.solve.api import simulate
from store.catalogue import engine
from store.catalogue.catalogue import SqlCatalogue
from tests.app.test_reconciliations import send
from tests.service import few
from tests.service.parts import LiveServer, Parts, eventually, open_parts

pytestmark = [pytest.mark.slow, pytest.mark.long]

RATE_HZ = 20_480.0


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Callable[[], Parts]]:
    opened: list[Parts] = []

    def one_more() -> Parts:
        opened.append(open_parts(tmp_path_factory.mktemp("service")))
        return opened[-1]

    yield one_more
    for parts in opened:
        parts.close()


@pytest.fixture(scope="module")
def recordings() -> tuple[Recording, Recording]:
    """Of a sound rotor and of one with a pit in a bearing, heard there."""
    return recorded(1), recorded(2, TermSpec(term="outer_spall", site="bearing1"))


def recorded(seed: int, *terms: TermSpec) -> Recording:
    machine = preset("rotor").model_copy(update={"terms": [*preset("rotor").terms, *terms]})
    name = "bearing1.outer.y.acceleration"
    run = simulate(machine, duration_s=1.7, output_rate_hz=RATE_HZ, channels=[name], seed=seed)
    samples = np.asarray(run.signals[:, int(0.5 * RATE_HZ) :])
    noise = np.random.default_rng(seed).normal(size=samples.shape)
    assert machine.operating is not None
    return Recording(
        sampling_rate_hz=RATE_HZ,
        channels=(Channel(name="a", quantity="acceleration", unit="m/s^2", location="bearing1", axis="y"),),
        samples=samples + 0.1 * samples.std() * noise,
        operating=Operating(shaft=machine.operating.shaft, speed_hz=machine.operating.speed_hz),
    )


def asked(client: httpx.Client, recordings: tuple[Recording, Recording]) -> str:
    baseline, test = (send(client, recording) for recording in recordings)
    body = {"machine": "rotor", "recordings": [test], "baselines": [baseline]}
    return str(client.post("/v1/reconciliations", json=body).raise_for_status().headers["Location"])


def report(client: httpx.Client, address: str) -> dict[str, Any]:
    """Without what it cost, which no two runs have alike."""
    eventually(lambda: client.get(address).json()["status"] not in ("accepted", "running"), within_s=240)
    found: dict[str, Any] = client.get(address).json()
    assert found["status"] == "successful", found["job"]["failure"]
    del found["report"]["provenance"]["cost"]
    whole: dict[str, Any] = found["report"]
    return whole


def app_of(parts: Parts) -> Any:
    return create_app(parts.settings(), engine=PhysicsEngine(), encode=encode)


def pieces(parts: Parts) -> list[JobRecord]:
    catalogue = SqlCatalogue(engine.connect(parts.stores.catalogue_url))
    return catalogue.query(JobQuery(kind=PIECE, limit=200))[0]


@pytest.fixture(scope="module")
def left(
    service: Callable[[], Parts], recordings: tuple[Recording, Recording]
) -> tuple[dict[str, Any], list[JobRecord], set[str]]:
    """A report whose leader was killed on the way, the pieces of its atlas, and which of them the leader had made."""
    parts = service()
    first = parts.start_worker("w1", few.physics)
    with LiveServer(app_of(parts)) as client:
        address = asked(client, recordings)
        eventually(lambda: sum(p.status is Status.SUCCESSFUL for p in pieces(parts)) >= 2, within_s=120)
        first.kill()
        first.wait()
        made = {p.id for p in pieces(parts) if p.status is Status.SUCCESSFUL}
        parts.start_worker("w2", few.physics)
        return report(client, address), pieces(parts), made


def test_two_workers_make_the_report_of_one(
    service: Callable[[], Parts],
    recordings: tuple[Recording, Recording],
    left: tuple[dict[str, Any], list[JobRecord], set[str]],
) -> None:
    """Of one at a time: it leads and makes all pieces that are left, alone."""
    alone, _, _ = left
    both = service()
    for name in ("w1", "w2"):
        both.start_worker(name, few.physics)
    with LiveServer(app_of(both)) as client:
        assert report(client, asked(client, recordings)) == alone
        listed = client.get("/v1/jobs").json()["jobs"]
        assert {job["kind"] for job in listed} == {"reconciliation"}, "its parts are nobody else's business"
    assert {piece.worker for piece in pieces(both)} == {"w1", "w2"}
    assert {piece.status for piece in pieces(both)} == {Status.SUCCESSFUL}


def test_a_killed_leader_loses_its_piece_only(left: tuple[dict[str, Any], list[JobRecord], set[str]]) -> None:
    _, found, made = left
    attempts = {p.id: p.attempt for p in found}
    assert {attempts[piece_id] for piece_id in made} == {1} and sorted(attempts.values())[-1] <= 2
    assert sum(attempt > 1 for attempt in attempts.values()) <= 1, "what was finished is used again"
    assert {p.worker for p in found if p.id in made} == {"w1"} and {p.worker for p in found} == {"w1", "w2"}


def test_a_cancel_over_http_ends_the_atlas_too_and_another_asking_goes_on_from_what_is_made(
    service: Callable[[], Parts], recordings: tuple[Recording, Recording]
) -> None:
    parts = service()
    parts.start_worker("w1", few.physics)

    def made() -> set[str]:
        return {p.id for p in pieces(parts) if p.status is Status.SUCCESSFUL}

    def stopped(client: httpx.Client, address: str) -> None:
        job = client.get(address).json()["job"]["id"]
        client.post(f"/v1/jobs/{job}/cancel").raise_for_status()
        eventually(lambda: client.get(address).json()["status"] == "dismissed", within_s=60)

    with LiveServer(app_of(parts)) as client:
        address = asked(client, recordings)
        eventually(lambda: len(made()) >= 2, within_s=120)
        stopped(client, address)
        before = made()
        assert not any(p.status is Status.RUNNING for p in pieces(parts))
        assert client.get(address).json().get("report") is None
        again = asked(client, recordings)
        eventually(lambda: len(made()) > len(before), within_s=120)
        stopped(client, again)
    assert before <= made() and all(p.attempt == 1 for p in pieces(parts) if p.id in before), "made once"
