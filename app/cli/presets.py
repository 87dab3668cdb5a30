"""List the ready machines, or print the specification of one (always JSON).

Example: sideband presets paper > machine.json
"""

from __future__ import annotations

import argparse

from app.cli.files import json_text
from sim import presets


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument("name", metavar="NAME", nargs="?", help="print the specification of this one")
    parser.add_argument("--json", action="store_true", help="print JSON")


def run(arguments: argparse.Namespace) -> int:
    """Run the command."""
    if arguments.name is not None:
        print(json_text(presets.preset(arguments.name).model_dump(mode="json")), end="")
        return 0
    if arguments.json:
        print(json_text([{"name": p.name, "sentence": p.sentence} for p in presets.PRESETS.values()]), end="")
        return 0
    width = max(map(len, presets.names()))
    for preset in presets.PRESETS.values():
        print(f"{preset.name:<{width}}  {preset.sentence}")
    return 0
