"""A recording from acceptance through the worker's hands and back, on a real catalogue and folder."""

from __future__ import annotations

import io
import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from jobs import run
from jobs.accept import Desk
from jobs.errors import BrokerAway, UnknownJob
from jobs.limits import Limits
from jobs.recordings.accept import Upload, accept_recording
from jobs.recordings.stored import stored_recording
from jobs.recordings.words import upload_key
from jobs.results import ResultReader
from jobs.run import Bench
from jobs.status import Status
from signals.encode import describe, encode
from signals.recording import Operating, Recording, Tacho
from sim.core.errors import SpecError, UnknownName
from sim.core.response import Channel
from store.artefacts.folder import FolderStore
from store.catalogue import engine, schema
from store.catalogue.catalogue import SqlCatalogue
from tests.service.fakes import FakeEngine, analyse
from tests.service.reconciling import Broker

RECORDING = Recording(
    sampling_rate_hz=1024.0,
    channels=(
        Channel(name="a", quantity="acceleration", unit="m/s^2", location="bearing1", axis="x"),
        Channel(name="b", quantity="force", unit="N", location="bearing1", axis="y"),
    ),
    samples=np.random.default_rng(6).normal(size=(2, 700)),
    operating=Operating(shaft="input", speed_hz=20.0, torque_nm=4.0),
    tacho=Tacho(shaft="input", pulse_times_s=2.0 + np.arange(1, 13) * 0.05, pulses_per_revolution=2),
    condition="baseline",
    notes="n",
    start_s=2.0,
)


class World:
    """Desk, bench and stores on one folder."""

    def __init__(self, folder: Path) -> None:
        database = engine.connect(f"sqlite:///{folder / 'c.sqlite'}")
        schema.create_schema(database)
        self.folder, self.broker = folder, Broker()
        self.catalogue, self.artefacts = SqlCatalogue(database), FolderStore(folder / "artefacts")
        self.desk = Desk(
            catalogue=self.catalogue,
            queue=self.broker,
            artefacts=self.artefacts,
            engine=FakeEngine(),
            limits=Limits(),
            clock=lambda: 1000.0,
        )
        self.bench = Bench(
            catalogue=self.catalogue,
            artefacts=self.artefacts,
            engine=FakeEngine(),
            analyse=analyse,
            clock=lambda: 1000.0,
        )

    def send(self, content: bytes, about: Any, name: str = "r.npz") -> Any:
        return accept_recording(self.desk, about, Upload(name=name, content=io.BytesIO(content)), submitter="me").record


@pytest.fixture
def world(tmp_path: Path) -> World:
    return World(tmp_path)


def about(recording: Recording = RECORDING) -> Any:
    return json.loads(json.dumps(describe(recording)))


@pytest.mark.slow
def test_a_recording_comes_back_as_it_was_sent(world: World) -> None:
    record = world.send(encode(RECORDING, "npz"), about())
    assert world.artefacts.size(upload_key(record.id, ".npz")) > 0, "kept before the reply"
    done = run.run(world.bench, record.id, record.attempt, "w")
    assert done is not None and done.status is Status.SUCCESSFUL and done.result is not None
    assert done.result.expires_at is None, "what was sent in is kept until it is deleted"
    reader = ResultReader(world.artefacts, f"{record.id}/1")
    found = stored_recording(reader)
    np.testing.assert_array_equal(found.samples, RECORDING.samples)
    np.testing.assert_array_equal(found.tacho.pulse_times_s, RECORDING.tacho.pulse_times_s)
    for field in ("sampling_rate_hz", "channels", "operating", "condition", "origin", "notes", "start_s"):
        assert getattr(found, field) == getattr(RECORDING, field), field
    part = stored_recording(reader, ["b"], start=100, stop=200)
    np.testing.assert_array_equal(part.samples, RECORDING.samples[1:, 100:200])
    assert part.start_s == pytest.approx(2.0 + 100 / 1024)


def test_who_is_told_no_leaves_nothing_behind(world: World) -> None:
    world.broker.away = True
    with pytest.raises(BrokerAway):
        world.send(encode(RECORDING, "npz"), about())
    assert not list((world.folder / "artefacts").iterdir())
    world.broker.away = False
    for wrong in ({}, {**about(), "channels": []}, None):
        with pytest.raises(SpecError):
            world.send(encode(RECORDING, "npz"), wrong)
    with pytest.raises(SpecError, match="empty"):
        world.send(b"", about())
    assert not list((world.folder / "artefacts").iterdir())


@pytest.mark.slow
def test_refused_is_an_end_with_reasons_and_sent_again_is_a_new_attempt(world: World) -> None:
    record = world.send(b"no archive", about(), "C:\\runs\\Pump 3, east.npz")
    done = run.run(world.bench, record.id, 1, "w")
    assert done is not None and done.status is Status.FAILED and done.failure is not None
    assert done.failure.code == "refused"
    assert done.failure.detail is not None and done.failure.detail["errors"][0]["field"] == "Pump 3, east.npz"
    assert not (world.folder / "artefacts" / record.id).exists()
    again = world.send(b"no archive", about())
    assert (again.id, again.attempt, again.status) == (record.id, 2, Status.ACCEPTED)


@pytest.mark.slow
def test_a_described_bearing_names_its_lines(world: World) -> None:
    long = replace(RECORDING, samples=np.random.default_rng(1).normal(size=(2, 1400)), tacho=None)
    for wrong, told in (("no such size", "in the catalogue"), ({"balls": 9}, "bearing"), (7, "bearing")):
        with pytest.raises((SpecError, UnknownName), match=told):
            world.send(encode(long, "npz"), {**about(long), "bearing": wrong})
    record = world.send(encode(long, "npz"), {**about(long), "bearing": "6205"})
    done = run.run(world.bench, record.id, 1, "w")
    assert done is not None and done.status is Status.SUCCESSFUL
    document = json.loads((world.folder / "artefacts" / record.id / "1" / "condition.json").read_text())
    assert document["reasons"] == []
    assert {"bearing.outer", "bearing.inner", "bearing.ball", "input.shaft"} <= set(
        document["channels"]["a"]["features"]
    )


def test_a_file_that_is_gone_before_it_was_read_is_told(world: World) -> None:
    record = world.send(encode(RECORDING, "npz"), about())
    world.artefacts.delete_prefix(f"{record.id}/")
    done = run.run(world.bench, record.id, 1, "w")
    assert done is not None and done.failure is not None and "send it again" in done.failure.message


@pytest.mark.slow
def test_a_lost_worker_loses_no_file(world: World) -> None:
    record = world.send(encode(RECORDING, "csv"), about(), "r.csv")
    (world.folder / "artefacts" / record.id / "1").mkdir()  # a half-written attempt
    assert run.run(world.bench, record.id, 1, "w1") is not None
    assert run.run(world.bench, record.id, 1, "w2") is None, "delivered twice, done once"


def test_names_of_files_cannot_lead_elsewhere(world: World) -> None:
    record = world.send(encode(RECORDING, "npz"), {**about(), "data": "/etc/passwd"}, "../../../x.npz")
    assert record.source["name"] == "x.npz" and "data" not in record.source["description"]
    assert [p.name for p in (world.folder / "artefacts").iterdir()] == [record.id]
    with pytest.raises(SpecError, match="ends in its format"):
        world.send(b"x", about(), "passwd")
    with pytest.raises(UnknownJob):
        world.catalogue.get("nothing")
