"""Reading a file in a process apart, with bounded memory and time: what kills a parser does not kill us."""

from __future__ import annotations

import json
import logging
import os
import signal
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from signals.readers.formats import format_of
from signals.readers.limits import Bounds
from signals.readers.load import Loaded, Stored, Want, load
from sim.core.errors import Problem, SpecError

log = logging.getLogger(__name__)

START_S = 30.0
"""For starting an interpreter on a busy machine, besides the time that the file may take."""
_ROOT = Path(__file__).parents[2]
_OUT_OF_TIME = (signal.SIGXCPU, signal.SIGALRM, signal.SIGKILL)


def load_carefully(path: Path, wanted: Sequence[Want], times: bool, bounds: Bounds) -> Loaded:
    """One's own file: here, or apart where its parser is fragile."""
    return (load_apart if format_of(path).fragile else load)(path, wanted, times, bounds)


def load_apart(path: Path, wanted: Sequence[Want], times: bool, bounds: Bounds) -> Loaded:
    """A stranger's file: in a process of its own. Its answer is JSON and raw numbers, nothing that is executed."""
    format_of(path)
    with tempfile.TemporaryDirectory(prefix="sideband-") as folder:
        request = {
            "path": str(path.absolute()),
            "folder": folder,
            "wanted": [asdict(want) for want in wanted],
            "times": times,
            "bounds": asdict(bounds),
        }
        answer = _ask(path, json.dumps(request), bounds)
        if "problems" in answer:
            raise SpecError([Problem(**problem) for problem in answer["problems"]])
        return Loaded(
            wanted=tuple(_stored(Path(folder), entry) for entry in answer["wanted"]),
            times={name: _stored(Path(folder), entry) for name, entry in answer["times"].items()},
            rate_hz=answer["rate_hz"],
            remarks=tuple(answer["remarks"]),
        )


def _ask(path: Path, request: str, bounds: Bounds) -> dict[str, Any]:
    # the project may be on this process's path only
    known = os.pathsep.join([str(_ROOT), *filter(None, [os.environ.get("PYTHONPATH")])])
    try:
        told = subprocess.run(
            [sys.executable, "-m", "signals.readers.child"],
            input=request,
            capture_output=True,
            text=True,
            timeout=bounds.seconds + START_S,
            env={**os.environ, "PYTHONPATH": known},
            check=False,
        )
    except subprocess.TimeoutExpired as error:
        raise _gave_up(path, f"it takes longer than {bounds.seconds:g} s") from error
    if told.returncode == 0:
        answer: dict[str, Any] = json.loads(told.stdout)
        return answer
    log.warning("reading %s ended with %d: %s", path.name, told.returncode, told.stderr[-500:])
    if -told.returncode in _OUT_OF_TIME:
        raise _gave_up(path, f"it takes longer than {bounds.seconds:g} s or more memory than allowed")
    how = signal.Signals(-told.returncode).name if told.returncode < 0 else f"exit code {told.returncode}"
    raise _gave_up(path, f"it is damaged: its parser broke down over it ({how})")


def _gave_up(path: Path, reason: str) -> SpecError:
    return SpecError(Problem(field=path.name, message=f"cannot be read: {reason}"))


def _stored(folder: Path, entry: dict[str, Any]) -> Stored:
    samples = np.fromfile(folder / entry["file"], dtype="<f8")
    return Stored(samples=samples, unit=entry["unit"], rate_hz=entry["rate_hz"])
