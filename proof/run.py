"""Runs the engine on cases through the command line, one stored JSON a case; what is stored is not run again."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from proof.engine_id import engine_id
from proof.kinematic import write_kinematics

TIMEOUT_S = 3_600.0
KEPT_ERROR = 2_000


@dataclass(frozen=True, kw_only=True)
class Engine:
    """How the engine is called: the command in front of `reconcile`, its budget, and where atlases are kept."""

    command: tuple[str, ...] = (sys.executable, "-m", "app.cli.main")
    budget: str = "quick"
    timeout_s: float = TIMEOUT_S
    atlas: Path | None = None
    jobs: int | None = None
    by_kinematics: bool = False
    """Whether the engine gets the drawings alone instead of the machine."""

    @property
    def source(self) -> str:
        """Which engine it is."""
        return engine_id("kinematics" if self.by_kinematics else "machine")

    def call(self, machine: Path, case: Path, out: Path) -> list[str]:
        """The whole command."""
        given = {kind: [str(p) for p in sorted(case.glob(f"{kind}_*.json"))] for kind in ("baseline", "test")}
        if not given["test"]:
            raise FileNotFoundError(f"{case} holds no test_*.json")
        baseline = ["--baseline", *given["baseline"]] if given["baseline"] else []
        where = ["--machine", str(machine), *baseline, "--recording", *given["test"]]
        return [*self.command, "reconcile", *where, "--budget", self.budget, "--out", str(out), *self._shared()]

    def _shared(self) -> list[str]:
        atlas = [] if self.atlas is None else ["--atlas", str(self.atlas)]
        return atlas if self.jobs is None else [*atlas, "--jobs", str(self.jobs)]


def run_case(engine: Engine, case: Path, results: Path, *, fresh: bool = False) -> dict[str, Any]:
    """The stored result of a case: `report` (None if the engine failed), `error`, `wall_s`, `budget`, `engine`.

    What another engine (`proof.engine_id`) stored is run again.

    The engine sees a copy without the case's name.
    """
    stored = results / f"{case.name}.json"
    if stored.exists() and not fresh:
        found: dict[str, Any] = json.loads(stored.read_text(encoding="utf-8"))
        if found.get("engine") == engine.source:
            return found
    results.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="reconcile-") as temporary:
        copy = Path(temporary) / "data"
        shutil.copytree(case, copy)
        began = time.monotonic()
        result = _reconciled(engine, copy, Path(temporary))
        result |= {"wall_s": round(time.monotonic() - began, 2), "budget": engine.budget, "engine": engine.source}
    part = stored.with_suffix(".part")
    part.write_text(json.dumps(result, sort_keys=True, indent=1) + "\n", encoding="utf-8")
    part.replace(stored)
    return result


def _reconciled(engine: Engine, case: Path, folder: Path) -> dict[str, Any]:
    machine, out = folder / "machine.json", folder / "out"
    commands = [engine.call(machine, case, out)]
    if engine.by_kinematics:
        write_kinematics(case, machine)
    else:
        given = case / "machine.json"
        form = "--from-reference" if "parameters" in json.loads(given.read_text(encoding="utf-8")) else "--machine"
        commands.insert(0, [*engine.command, "machine", form, str(given), "--out", str(machine)])
    for command in commands:
        error = _failure(command, engine.timeout_s)
        if error is not None:
            return {"report": None, "error": error}
    return {"report": slim(json.loads((out / "report.json").read_text(encoding="utf-8"))), "error": None}


def _failure(command: Sequence[str], timeout_s: float) -> str | None:
    environment = os.environ | {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=timeout_s, env=environment, check=False)
    except subprocess.TimeoutExpired:
        return f"no answer within {timeout_s:g} s"
    return None if done.returncode == 0 else f"exit code {done.returncode}: {done.stderr[-KEPT_ERROR:]}"


def slim(report: Mapping[str, Any]) -> dict[str, Any]:
    """The report without its bulk: pictures, the revised machine and the samples of an estimated force."""
    kept = {key: value for key, value in report.items() if key not in {"pictures", "machine"}}
    if isinstance(kept.get("force"), dict):
        kept["force"] = {key: value for key, value in kept["force"].items() if key != "samples"}
    return kept
