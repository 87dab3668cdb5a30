"""Classify a measured recording with a model that was trained on simulated ones: bearings and teeth, sound or not.

R.json is the description of a recording (the data file beside it). Where it says the bearing (`bearing`: a catalogue
name or its sizes; or `kinematics` as in a machine file) or --machine does, its lines are looked for; otherwise any
usual bearing is thought possible. Where `kinematics` state gears in mesh, each stage is answered too: a damaged tooth,
or healthy. The stated speed is where the search for the true one starts, unless --trust-speed.

Example: sideband classify --recording R.json --json
"""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from app.cli.choice import read_machine
from app.cli.files import json_text, read_json
from app.cli.recorded import read
from learn.classify import classify
from learn.describe import sites
from learn.gears.stage import stages
from learn.model import default_model, load
from reconcile.kinematics import KinematicSpec, described_kinematics, of_machine, read_kinematic_spec
from signals.ingest.file import load_description


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument(
        "--recording", metavar="R.json", type=Path, required=True, help="the description; data beside it"
    )
    parser.add_argument(
        "--model", metavar="M", type=Path, default=None, help="a trained model (default: the shipped one)"
    )
    parser.add_argument(
        "--machine", metavar="FILE", type=Path, default=None, help="machine or kinematics: bearings, gears"
    )
    parser.add_argument("--channel", metavar="NAME", nargs="+", default=None, help="only these channels")
    parser.add_argument(
        "--trust-speed", action="store_true", help="take the stated speed as exact, where no tacho tells it all along"
    )
    parser.add_argument("--json", action="store_true", help="print one JSON object")


def run(arguments: argparse.Namespace) -> int:
    """Run the command."""
    model = load(arguments.model) if arguments.model is not None else default_model()
    recording = read(arguments.recording).recording
    told = recording.operating or recording.tacho
    shaft = told.shaft if told is not None else None
    spec = _kinematics(arguments)
    found = classify(
        recording,
        model,
        sites(spec, shaft) if spec is not None else (),
        stages=stages(spec, shaft) if spec is not None else (),
        channels=arguments.channel,
        trust_speed=arguments.trust_speed,
    )
    print(json_text(found) if arguments.json else _text(found), end="")
    return 0


def _kinematics(arguments: argparse.Namespace) -> KinematicSpec | None:
    """Of the machine file, else of the description."""
    if arguments.machine is None:
        return described_kinematics(load_description(arguments.recording))
    document = read_json(arguments.machine)
    return read_kinematic_spec(document) if "kinematics" in document else of_machine(read_machine(arguments.machine))


def _text(found: Mapping[str, Any]) -> str:
    shares = ", ".join(f"{name} {p:.2f}" for name, p in sorted(found["probabilities"].items(), key=lambda x: -x[1]))
    part = found["bearing"] or found["gear"] or found["stage"]
    lines = [f"{found['label']}{f' at {part}' if part else ''} ({shares})"]
    speed = found["speed"]
    how = {
        "tacho": "by its pulses",
        "given": "as stated",
        "stated": "as stated, no lines confirm it",
        "scan": "searched, none was stated",
    }
    told = how.get(speed["method"], "read from its lines")
    lines.append(f"speed {speed['speed_hz']:.5g} Hz, {told}; {found['turns']:.0f} turns; geometry {found['geometry']}")
    lines += [_line(line) for line in found["lines"]]
    if len(found["parts"]) > 1:
        lines += [
            f"  {one['bearing'] or one['stage']}: {one['label']} ({one['probabilities'][one['label']]:.2f})"
            for one in found["parts"]
        ]
    lines += [f"note: {remark}" for remark in found["remarks"]]
    return "\n".join(lines) + "\n"


def _line(line: Mapping[str, Any]) -> str:
    where = f"  {line['family']:<8} order {line['order']:.3g}, {line['frequency_hz']:.3g} Hz"
    if "peak_over_mean_db" in line:
        return (
            f"{where}: one place of the turn {line['peak_over_mean_db']:.0f} dB over the others' mean, "
            f"{line['peak_over_next_db']:.0f} dB over the next, {line['band']} of {line['channel']}"
        )
    if "slip" not in line:
        return f"{where}: {line['z']:.1f} deviations over other orders"
    low, high = line["band_hz"]
    return (
        f"{where} ({line['slip']:+.1%}): {line['z']:.1f} deviations over other orders, depth {line['depth']:.2g} "
        f"of the envelope in {low:.0f}-{high:.0f} Hz of {line['channel']}"
    )
