"""What travels between the workers of a round: the machines to simulate as JSON, what they showed as plain arrays."""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from jobs.atlas.words import METHOD_VERSION
from reconcile.atlas.bank import ARRAYS, Task
from reconcile.atlas.keep import ATLAS_VERSION
from reconcile.atlas.plan import AtlasPlan, Draw, Point
from reconcile.calibrate.uncertain import Offsets, Uncertain
from reconcile.observe.statistics import Statistics
from sideband_datasets.folder.manifest import versions
from sim.core.spec import MachineSpec, TermSpec

NAMES = {"name": "machine", "notes": ""}
"""What a machine is called changes none of its numbers."""
SCALARS = ("resolution_hz", "duration_s")


def made_by() -> dict[str, str]:
    """Versions of what makes the numbers of a round: of the simulator, and of how an atlas asks it."""
    return {**versions(), "atlas": str(ATLAS_VERSION)}


def round_document(tasks: Sequence[Task]) -> dict[str, object]:
    """Everything that the numbers of these tasks depend on; they are of one plan, point and set of channels."""
    plan, point = tasks[0].plan, tasks[0].point
    return {
        "method": METHOD_VERSION,
        "versions": made_by(),
        "machine": plan.machine.model_dump(mode="json") | NAMES,
        "numbers": [[list(n.path), n.kind] for n in plan.numbers],
        "offsets": [o.values.tolist() for o in plan.offsets],
        "twins": [o.values.tolist() for o in plan.twins],
        "seed": plan.seed,
        "point": [point.speed_hz, point.torque_ratio],
        "channels": list(tasks[0].channels),
        "tasks": [[_draw_document(plan.draws[k]) for k in task.draws] for task in tasks],
    }


def restored_tasks(document: Mapping[str, Any], first: int, last: int) -> list[Task]:
    """Tasks first .. last - 1 of the document; their draws are numbered anew."""
    several = [[_draw(one) for one in task] for task in document["tasks"][first:last]]
    plan = AtlasPlan(
        machine=MachineSpec.model_validate(document["machine"]),
        numbers=tuple(Uncertain(path=tuple(path), kind=kind) for path, kind in document["numbers"]),
        offsets=tuple(Offsets(values=np.array(values)) for values in document["offsets"]),
        twins=tuple(Offsets(values=np.array(values)) for values in document["twins"]),
        draws=tuple(draw for draws in several for draw in draws),
        seed=document["seed"],
    )
    speed_hz, torque_ratio = document["point"]
    point, channels = Point(speed_hz=speed_hz, torque_ratio=torque_ratio), tuple(document["channels"])
    tasks, start = [], 0
    for draws in several:
        numbers = tuple(range(start, start + len(draws)))
        tasks.append(Task(plan=plan, draws=numbers, point=point, channels=channels))
        start += len(draws)
    return tasks


def _draw_document(draw: Draw) -> dict[str, object]:
    """Without the candidate: what is simulated are its terms."""
    return {
        "pair": draw.pair,
        "twin": draw.twin,
        "term": None if draw.term is None else draw.term.model_dump(mode="json"),
        "also": [term.model_dump(mode="json") for term in draw.also],
        "beside": [term.model_dump(mode="json") for term in draw.beside],
    }


def _draw(document: Mapping[str, Any]) -> Draw:
    term = document["term"]
    return Draw(
        pair=document["pair"],
        twin=document["twin"],
        term=None if term is None else TermSpec.model_validate(term),
        also=tuple(TermSpec.model_validate(one) for one in document["also"]),
        beside=tuple(TermSpec.model_validate(one) for one in document["beside"]),
    )


def to_bytes(found: Sequence[Statistics | None]) -> bytes:
    """npz of every draw that ran, in double precision: the same numbers give the same bytes."""
    there = [one for one in found if one is not None]
    arrays = {name: np.array([getattr(one, name) for one in there], dtype=np.float64) for name in (*ARRAYS, *SCALARS)}
    buffer = io.BytesIO()
    np.savez(buffer, alive=np.array([one is not None for one in found]), **arrays)  # type: ignore[arg-type]
    return buffer.getvalue()


def from_bytes(data: bytes) -> list[Statistics | None]:
    """Inverse of `to_bytes`."""
    with np.load(io.BytesIO(data), allow_pickle=False) as stored:
        arrays = {name: stored[name] for name in ARRAYS}
        scalars = {name: stored[name] for name in SCALARS}
        places = np.cumsum(stored["alive"]) - 1
        return [
            Statistics(
                **{name: values[k] for name, values in arrays.items()},
                resolution_hz=float(scalars["resolution_hz"][k]),
                duration_s=float(scalars["duration_s"][k]),
            )
            if alive
            else None
            for alive, k in zip(stored["alive"], places, strict=True)
        ]
