"""The same cases told by kinematics alone: drawings of bearings and teeth, no machine that can be simulated."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from proof.score.one import QUIET

Document = dict[str, Any]
SHAFTS = ("input", "input", "output", "output")
"""Of the four bearings, in their order."""
STRIKING = {"outer_pit": "outer_spall", "inner_pit": "inner_spall", "ball_pit": "ball_spall"}
"""What this level can name, by the law that hides it."""


def kinematics(reference: Mapping[str, Any]) -> Document:
    """What `reconcile --machine` takes at this level, from the case's `machine.json` (one drawing for all bearings)."""
    parameters, drawing = reference["parameters"], reference["bearings"][0]
    geometry = {key: drawing[key] for key in ("balls", "ball_diameter_m", "pitch_diameter_m")}
    teeth = {"pinion": ("input", "z1"), "gear": ("output", "z2")}
    return {
        "kinematics": {
            "shafts": [{"name": "input"}, {"name": "output"}],
            "bearings": [{"name": f"bearing{k}", "shaft": shaft, **geometry} for k, shaft in enumerate(SHAFTS, 1)],
            "gears": [{"name": g, "shaft": s, "teeth": int(parameters[key])} for g, (s, key) in teeth.items()],
            "meshes": [{"name": "mesh1", "gears": list(teeth)}],
        }
    }


def write_kinematics(case: Path, target: Path) -> None:
    """The description of a case's machine at this level, as a file."""
    reference = json.loads((case / "machine.json").read_text(encoding="utf-8"))
    target.write_text(json.dumps(kinematics(reference)), encoding="utf-8")


def answer(truth: Mapping[str, Any], report: Mapping[str, Any] | None) -> str:
    """What an answer is worth, in a few words."""
    if report is None:
        return "failed"
    verdict, effects = report["verdict"], truth["effects"]
    if truth["fault"]:
        return "fault of the measurement" if verdict == "measurement_fault" else _loud(verdict)
    if not effects:
        return _loud(verdict)
    told = {(cause["term"], cause["site"]) for cause in report["causes"]}
    right = {(STRIKING.get(e["law"]), site) for e in effects for site in e["sites"]}
    if not told & right:
        return _loud(verdict)
    named = {(c["term"], c["site"]) for c in report["causes"] if c["named"]}
    if named - right:
        return "a wrong name"
    return "named with its place" if named else "in the set"


def _loud(verdict: str) -> str:
    return "quiet" if verdict in QUIET else f"other ({verdict})"


def told_table(answers: Iterable[tuple[Mapping[str, Any], Mapping[str, Any] | None]]) -> str:
    """A table in Markdown: groups of truths, and how their cases were answered."""
    rows: dict[str, Counter[str]] = {}
    for truth, report in answers:
        rows.setdefault(_group(truth), Counter())[answer(truth, report)] += 1
    lines = ["| hidden | cases | answers |", "|---|---|---|"]
    for group, counted in sorted(rows.items()):
        each = ", ".join(f"{kind} {count}" for kind, count in counted.most_common())
        lines.append(f"| {group} | {counted.total()} | {each} |")
    return "\n".join(lines) + "\n"


def _group(truth: Mapping[str, Any]) -> str:
    """By what this level can say of the case."""
    if truth["fault"]:
        return "a fault of a sensor"
    if not truth["effects"]:
        return "nothing"
    pits = [e["law"] in STRIKING for e in truth["effects"]]
    return "a pit of a bearing" if len(pits) == 1 and pits[0] else "a pit and more" if any(pits) else "other effects"
