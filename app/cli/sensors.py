"""`--sensors FILE`: the measurement chain of a simulation, from a file."""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path

from pydantic import ValidationError

from app.cli.files import read_json
from jobs.validation import problems_of
from signals.sensors import SensorChain
from sim.core.errors import Problem, SpecError


def add_sensor_options(parser: argparse.ArgumentParser) -> None:
    """`--sensors`, `--keep-raw`."""
    parser.add_argument(
        "--sensors",
        metavar="FILE",
        type=Path,
        help="record what sensors see: a measurement chain, JSON (docs/sensors.md); replaces --channels",
    )
    parser.add_argument(
        "--keep-raw", action="store_true", help="with --sensors: keep the motion before the sensors too, in raw.npz"
    )


def chosen_sensors(arguments: argparse.Namespace) -> SensorChain | None:
    """The chain of `--sensors`; SpecError names its wrong fields."""
    if arguments.sensors is None:
        if arguments.keep_raw:
            message = "belongs to --sensors; without sensors nothing but the motion is recorded"
            raise SpecError(Problem(field="--keep-raw", message=message))
        return None
    document = read_json(arguments.sensors)
    try:
        return SensorChain.model_validate(document)
    except ValidationError as error:
        found = problems_of(error, model=SensorChain)
        raise SpecError([replace(problem, field=f"--sensors {problem.field}") for problem in found]) from error
