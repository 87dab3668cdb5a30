"""The engine on real recordings: by its command line, on copies whose names tell nothing."""

from __future__ import annotations

import json
import os
import subprocess
import tempfile
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from proof.real.describe import write
from proof.run import Engine

KEPT_ERROR = 300
BULK = ("pictures", "machine")


@dataclass(frozen=True, kw_only=True)
class Source:
    """An entry of the catalogue; `channels`: the columns that are described, as (name, location) by column."""

    entry: Mapping[str, Any]
    channels: Mapping[str, tuple[str, str]] | None = None


@dataclass(frozen=True, kw_only=True)
class Answer:
    """The report (without pictures and machine), or the error it was refused with, and the time it took, s."""

    report: Mapping[str, Any] | None
    error: str | None
    wall_s: float


def reconciled(
    engine: Engine,
    recordings: Path,
    machine: Mapping[str, Any] | str,
    tests: Sequence[Source],
    baselines: Sequence[Source] = (),
) -> Answer:
    """What the engine says; `machine` is a document, or the name of a ready machine."""
    with tempfile.TemporaryDirectory(prefix="real-") as temporary:
        folder = Path(temporary)
        given = {
            kind: [str(_written(recordings, one, folder, kind, i)) for i, one in enumerate(several, 1)]
            for kind, several in (("baseline", baselines), ("test", tests))
        }
        made = folder / "machine.json"
        began = time.monotonic()
        error = None
        if isinstance(machine, str):
            error = _failure(engine, ["machine", "--preset", machine, "--out", str(made)])
        else:
            made.write_text(json.dumps(machine), encoding="utf-8")
        command = ["reconcile", "--machine", str(made), "--recording", *given["test"], "--out", str(folder / "out")]
        command += ["--baseline", *given["baseline"]] if given["baseline"] else []
        error = error or _failure(engine, [*command, "--budget", engine.budget])
        wall = time.monotonic() - began
        if error is not None:
            return Answer(report=None, error=error, wall_s=wall)
        report = json.loads((folder / "out" / "report.json").read_text(encoding="utf-8"))
    return Answer(report={k: v for k, v in report.items() if k not in BULK}, error=None, wall_s=wall)


def _written(recordings: Path, source: Source, folder: Path, kind: str, number: int) -> Path:
    condition = "baseline" if kind == "baseline" else "unknown"
    path = write(recordings, source.entry, folder, f"{kind}_{number}", condition=condition)
    if source.channels is not None:
        document = json.loads(path.read_text(encoding="utf-8"))
        kept = []
        for channel in document["channels"]:
            column = channel.get("column", channel["name"])
            if column in source.channels:
                name, location = source.channels[column]
                kept.append({**channel, "name": name, "location": location, "column": column})
        path.write_text(json.dumps({**document, "channels": kept}), encoding="utf-8")
    return path


def _failure(engine: Engine, arguments: Sequence[str]) -> str | None:
    environment = os.environ | {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
    command = [*engine.command, *arguments]
    try:
        done = subprocess.run(
            command, capture_output=True, text=True, timeout=engine.timeout_s, env=environment, check=False
        )
    except subprocess.TimeoutExpired:
        return f"no answer within {engine.timeout_s:g} s"
    return None if done.returncode == 0 else done.stderr.strip()[:KEPT_ERROR]
