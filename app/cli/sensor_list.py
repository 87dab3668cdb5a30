"""List the sensors there are by name, or explain one: the stages of the measurement chain that it fills in.

Example: sideband sensors icp-magnet
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Mapping

from app.cli.files import json_text
from jobs.sensor_document import sensor_document, sensor_preset
from signals.sensors import PRESETS


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument("name", metavar="NAME", nargs="?", help="explain this one")
    parser.add_argument(
        "--json", action="store_true", help="print JSON; without NAME also the kinds of channels and the JSON Schema"
    )


def run(arguments: argparse.Namespace) -> int:
    """Run the command."""
    if arguments.name is not None:
        found = sensor_preset(arguments.name)
        print(json_text(found) if arguments.json else _explained(found), end="" if arguments.json else "\n")
        return 0
    if arguments.json:
        print(json_text(sensor_document()), end="")
        return 0
    names, kinds = max(map(len, PRESETS)), max(len(preset.kind) for preset in PRESETS.values())
    for name, preset in PRESETS.items():
        print(f"{name:<{names}}  {preset.kind:<{kinds}}  {preset.sentence}")
    print('use: {"channels": [{"kind": KIND, "name": ..., "preset": NAME, ...}]} in a file for simulate --sensors')
    return 0


def _explained(found: Mapping[str, object]) -> str:
    stages = found["stages"]
    assert isinstance(stages, Mapping)
    lines = [f"{found['name']} ({found['kind']}): {found['sentence']}"]
    lines += [f"  {stage}: {json.dumps(values)}" for stage, values in stages.items()]
    return "\n".join([*lines, f"  source: {found['source']}"])
