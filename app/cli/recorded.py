"""Reading a recording with its description, which is refused for what the service would refuse it for."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from jobs.recordings.described import check_kinematics
from signals.ingest import Ingested, ingest, load_description
from sim.core.errors import SpecError


def read(path: Path) -> Ingested:
    """The recording. Its bearing is checked also where nothing looks at it: a slip would be found later, or never."""
    description = load_description(path)
    try:
        check_kinematics(description)
    except SpecError as error:
        raise SpecError([replace(p, field=f"{path.name}: {p.field}") for p in error.problems]) from error
    return ingest(path)
