"""A desk, a bench and stores on one folder: recordings are sent in, reconciliations asked for and carried out."""

from __future__ import annotations

import io
import json
from pathlib import Path
from typing import Any

import numpy as np

from jobs import run
from jobs.accept import Desk
from jobs.errors import BrokerAway
from jobs.limits import Limits
from jobs.ports import Ticket
from jobs.reconciliations.accept import accept_reconciliation
from jobs.reconciliations.request import ReconciliationRequest
from jobs.record import JobRecord
from jobs.recordings.accept import Upload, accept_recording
from jobs.run import Bench
from jobs.status import Status
from signals.encode import describe, encode
from signals.recording import Operating, Recording
from sim.core.response import Channel
from store.artefacts.folder import FolderStore
from store.catalogue import engine, schema
from store.catalogue.catalogue import SqlCatalogue
from tests.service.fakes import FakeEngine, analyse

KINEMATICS: dict[str, Any] = {
    "kinematics": {
        "shafts": [{"name": "input"}],
        "bearings": [{"name": "bearing1", "shaft": "input", "catalogue": "6205"}],
    }
}


def made(seed: int) -> Recording:
    return Recording(
        sampling_rate_hz=1024.0,
        channels=(Channel(name="a", quantity="acceleration", unit="m/s^2", location="bearing1", axis="x"),),
        samples=np.random.default_rng(seed).normal(size=(1, 900)),
        operating=Operating(shaft="input", speed_hz=20.0),
    )


class Broker:
    """`jobs.ports.Queue` that keeps nothing; `away` as told."""

    away = False

    def ping(self) -> None:
        if self.away:
            raise BrokerAway("away")

    def submit(self, ticket: Ticket) -> None:
        self.ping()

    def holds(self, ticket: Ticket) -> bool:
        return True

    def withdraw(self, ticket: Ticket) -> None:
        pass

    def length(self) -> int:
        return 0


class World:
    """Desk, bench and stores on one folder, with a clock that goes on by itself."""

    def __init__(self, folder: Path) -> None:
        database = engine.connect(f"sqlite:///{folder / 'c.sqlite'}")
        schema.create_schema(database)
        self.now = 1000.0
        self.catalogue, self.artefacts = SqlCatalogue(database), FolderStore(folder / "artefacts")
        common: Any = {"catalogue": self.catalogue, "artefacts": self.artefacts, "clock": self.clock}
        self.desk = Desk(queue=Broker(), engine=FakeEngine(), limits=Limits(), **common)
        self.bench = Bench(engine=FakeEngine(), analyse=analyse, keep_s=60.0, **common)

    def clock(self) -> float:
        self.now += 1.0
        return self.now

    def recording(self, seed: int, *, read: bool = True) -> str:
        return self.sent(made(seed), read=read)

    def sent(self, recording: Recording, *, read: bool = True, **further: object) -> str:
        """`further`: keys of its description beside those of the recording."""
        content = encode(recording, "npz")
        about = {**json.loads(json.dumps(describe(recording))), **further}
        upload = Upload(name="r.npz", content=io.BytesIO(content))
        record = accept_recording(self.desk, about, upload, submitter="me").record
        if read:
            done = run.run(self.bench, record.id, record.attempt, "w")
            assert done is not None and done.status is Status.SUCCESSFUL
        return record.id

    def ask(self, ids: list[str], known: object = None, key: str | None = None, **more: Any) -> JobRecord:
        body = {"machine": known or KINEMATICS, "recordings": ids, **more}
        request = ReconciliationRequest.model_validate(body)
        return accept_reconciliation(self.desk, request, submitter="me", scope="", key=key).record

    def carried_out(self, record: JobRecord) -> JobRecord:
        done = run.run(self.bench, record.id, record.attempt, "w")
        assert done is not None
        return done
