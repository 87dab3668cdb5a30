"""What a worker does with a recording: reads it in a process apart, looks for defects, keeps channels x samples."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np

from jobs.errors import RecordingRefused, UnknownArtefact
from jobs.health.features import condition_document
from jobs.health.words import CONDITION
from jobs.ports import ArtefactStore
from jobs.record import ResultRef
from jobs.recordings.words import READERS_VERSION, RECORDING, SUMMARY, upload_key
from jobs.reporter import Reporter
from jobs.results import ChannelEntry, Manifest, json_bytes, put_file
from reconcile.kinematics import described_kinematics
from signals.encode import describe
from signals.ingest import Bounds, Ingested, parse, read_description, report
from signals.readers.guard import load_apart
from sim.core.errors import Problem, SpecError

COPY = "data"


def read_upload(
    artefacts: ArtefactStore, reporter: Reporter, request: Mapping[str, object], job_id: str, attempt: int, name: str
) -> ResultRef:
    """Turn the file into a stored recording; RecordingRefused says why it is none, and the file is let go of.

    `name`: what the sender calls the file, by which refusals name it.
    """
    reporter.stage("reading", 0.1)
    try:
        found = _parsed(artefacts, request, job_id)
        spec = described_kinematics(read_description(request["description"]))
    except SpecError as error:
        artefacts.delete_prefix(f"{job_id}/")
        raise RecordingRefused([_by_name(p, request["file"], name) for p in error.problems]) from error
    reporter.stage("analysing", 0.6)
    summary = report(found)
    condition = condition_document(found.recording, spec)
    reporter.stage("storing", 0.8)
    return _kept(artefacts, f"{job_id}/{attempt}", attempt, found, {SUMMARY: summary, CONDITION: condition})


def _by_name(problem: Problem, file: object, name: str) -> Problem:
    """Here every file is called `data`: its sender's name in its place, in what is said of the file."""
    assert isinstance(file, Mapping)
    here = f"{COPY}{file['format']}"
    if not name or here not in (problem.field, *problem.message.split()):
        return problem
    return replace(
        problem,
        field=name if problem.field == here else problem.field,
        message=" ".join(name if word == here else word for word in problem.message.split(" ")),
    )


def _parsed(artefacts: ArtefactStore, request: Mapping[str, object], job_id: str) -> Ingested:
    file = request["file"]
    assert isinstance(file, Mapping)
    suffix, key = str(file["format"]), upload_key(job_id, str(file["format"]))
    with tempfile.TemporaryDirectory(prefix="sideband-") as folder:
        path = Path(folder) / f"{COPY}{suffix}"
        try:
            with path.open("wb") as stream:
                for piece in artefacts.chunks(key, 0, artefacts.size(key)):
                    stream.write(piece)
        except UnknownArtefact as error:
            raise SpecError(Problem(field="file", message="is no longer here; send it again")) from error
        return parse(read_description(request["description"]), path, Bounds(), load_apart)


def _kept(
    artefacts: ArtefactStore, prefix: str, attempt: int, found: Ingested, documents: Mapping[str, Mapping[str, object]]
) -> ResultRef:
    """As a simulation's result is kept (`jobs.results`), with the description in place of spectra and labels."""
    recording = found.recording
    rows = (np.ascontiguousarray(row, dtype="<f8").tobytes() for row in recording.samples)
    files = {
        "signals.f64": put_file(artefacts, f"{prefix}/signals.f64", rows),
        **{
            f"{name}.json": put_file(artefacts, f"{prefix}/{name}.json", [json_bytes(document)])
            for name, document in {**documents, RECORDING: describe(recording)}.items()
        },
    }
    manifest = Manifest(
        physics_version=READERS_VERSION,
        seed=0,
        sampling_rate_hz=recording.sampling_rate_hz,
        samples=int(recording.samples.shape[1]),
        channels=tuple(ChannelEntry(**asdict(channel)) for channel in recording.channels),
        spectra=(),
        files=files,
    )
    table = put_file(artefacts, f"{prefix}/manifest.json", [json_bytes(manifest.model_dump(mode="json"))])
    size = table.bytes + sum(entry.bytes for entry in files.values())
    return ResultRef(attempt=attempt, size_bytes=size, sha256=table.sha256, expires_at=None)
