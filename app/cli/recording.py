"""Reads a recording (R.json and the data beside it) and says what is in it: channels, levels in SI, rate, duration.

With --check it also looks for defects (samples that are not finite, stuck stretches, dropouts, clipping, mains hum) and
says where; the exit code is then 1 if any channel has one. A stated speed that looks like rpm, fewer turns than can be
compared, and sensors that hear noise alone are remarked on. What cannot be read is refused with its place (exit 2).

Example: sideband recording R.json --check
"""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from app.cli.files import json_text
from app.cli.recorded import read
from learn.doubts import doubts
from signals.ingest import report

FOUND = 1


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument("description", metavar="R.json", type=Path, help="the description; the data lies beside it")
    parser.add_argument("--check", action="store_true", help="look for defects; exit code 1 if there are any")
    parser.add_argument("--json", action="store_true", help="print one JSON object")


def run(arguments: argparse.Namespace) -> int:
    """Run the command."""
    found = read(arguments.description)
    document: dict[str, Any] = report(found)
    if arguments.check:
        document["remarks"] = [*document["remarks"], *doubts(found.recording)]
    else:
        del document["findings"], document["mains_hum"]
    print(json_text(document) if arguments.json else _text(document), end="")
    return FOUND if document.get("findings") else 0


def _text(document: Mapping[str, Any]) -> str:
    rate, samples, duration = (document[key] for key in ("sampling_rate_hz", "samples", "duration_s"))
    lines = [f"{duration:.6g} s at {rate:.9g} Hz ({samples} samples), {document['condition']}, {document['origin']}"]
    width = max(len(channel["name"]) for channel in document["channels"])
    lines += [_channel(channel, width) for channel in document["channels"]]
    operating, tacho = document["operating"], document["tacho"]
    if operating is not None:
        torque = f", {operating['torque_nm']:g} N m" if operating["torque_nm"] is not None else ""
        lines.append(f"operating: {operating['shaft']} at {operating['speed_hz']:.6g} Hz{torque}")
    if tacho is not None:
        span = f"{tacho['lowest_speed_hz']:.6g} to {tacho['highest_speed_hz']:.6g}"
        lines.append(f"tacho: {tacho['shaft']}, {tacho['pulses']} pulses, {span} Hz, mean {tacho['mean_speed_hz']:.6g}")
    lines += [f"note: {remark}" for remark in document["remarks"]]
    if "findings" in document:
        values = {channel["name"]: channel["minimum"] for channel in document["channels"]}
        told = [_finding(finding, values[finding["channel"]]) for finding in document["findings"]]
        lines += told or ["no defects found"]
        lines += [_hum(line) for line in document["mains_hum"]]
    return "\n".join(lines) + "\n"


def _channel(channel: Mapping[str, Any], width: int) -> str:
    place = " ".join(filter(None, (channel["location"], channel["axis"]))) or "-"
    level = "no finite sample"
    if channel["rms"] is not None:
        unit = channel["unit"]
        level = f"rms {channel['rms']:.4g}, {channel['minimum']:.4g} to {channel['maximum']:.4g} {unit}"
        if channel["minimum"] == channel["maximum"]:
            level = f"always {channel['minimum']:.4g} {unit}"
    return f"  {channel['name']:<{width}}  {channel['quantity'] or '-'}, {place}: {level}"


def _finding(finding: Mapping[str, Any], value: float | None) -> str:
    """`value`: the channel's smallest, the only one of a constant channel, which `reconcile` calls stuck or silence."""
    places = [f"{p['start_s']:.6g}-{p['stop_s']:.6g} s" for p in finding["places"][:3]]
    more = f" and {finding['count'] - len(places)} more" if finding["count"] > len(places) else ""
    kind = finding["kind"].replace("_", " ")
    if kind == "constant":
        kind = "silence" if value == 0.0 else "stuck"
    where = ", ".join(places) + more
    return f"{finding['channel']}: {kind}: {finding['message']} ({finding['samples']} samples: {where})"


def _hum(line: Mapping[str, Any]) -> str:
    harmonic = f"{line['harmonic']} x {line['mains_hz']:g} Hz"
    if line["shared"]:
        harmonic += ", where the machine has a line too"
    return f"{line['channel']}: mains hum at {line['frequency_hz']:.5g} Hz ({harmonic}), {line['db_over_floor']:.0f} dB"
