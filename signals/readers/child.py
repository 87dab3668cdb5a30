"""The process that reads one file: `python -m signals.readers.child`, a request on its input, the answer on its output.

It bounds itself before it looks at the file: address space, processor time, wall time, size of what it writes.
"""

from __future__ import annotations

import json
import resource
import signal
import sys
from pathlib import Path

import numpy as np

from signals.readers.limits import Bounds
from signals.readers.load import Loaded, Stored, Want, load
from sim.core.errors import SidebandError, SpecError

_ITEM = 8


def main() -> int:
    """Entry point; 0 also when the file is refused, which the answer then says."""
    request = json.loads(sys.stdin.read())
    bounds = Bounds(**request["bounds"])
    _confine(bounds)
    try:
        wanted = [Want(**want) for want in request["wanted"]]
        found = load(Path(request["path"]), wanted, request["times"], bounds)
        answer = _answer(found, Path(request["folder"]))
    except SpecError as error:
        answer = {"problems": [problem.to_dict() for problem in error.problems]}
    except SidebandError as error:
        answer = {"problems": [{"field": Path(request["path"]).name, "message": str(error)}]}
    sys.stdout.write(json.dumps(answer, default=str))
    return 0


def _confine(bounds: Bounds) -> None:
    seconds = int(bounds.seconds) + 1
    for kind, most in (
        (resource.RLIMIT_AS, bounds.memory_bytes),
        (resource.RLIMIT_CPU, seconds),
        (resource.RLIMIT_FSIZE, 2 * bounds.values * _ITEM),
        (resource.RLIMIT_CORE, 0),
    ):
        _, hard = resource.getrlimit(kind)
        bound = most if hard == resource.RLIM_INFINITY else min(most, hard)
        resource.setrlimit(kind, (bound, bound))
    signal.alarm(seconds)  # also when the process that asked is gone


def _answer(found: Loaded, folder: Path) -> dict[str, object]:
    return {
        "rate_hz": found.rate_hz,
        "wanted": [_kept(stored, folder, f"w{i}") for i, stored in enumerate(found.wanted)],
        "times": {name: _kept(stored, folder, f"t{i}") for i, (name, stored) in enumerate(found.times.items())},
        "remarks": list(found.remarks),
    }


def _kept(stored: Stored, folder: Path, name: str) -> dict[str, object]:
    stored.samples.astype("<f8").tofile(folder / name)
    return {"file": name, "unit": stored.unit, "rate_hz": stored.rate_hz}


if __name__ == "__main__":
    np.seterr(all="ignore")  # broken samples are no matter of this process
    sys.exit(main())
