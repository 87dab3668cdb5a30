"""All ways of answering on all recordings, as tables and as one line of JSON."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass

from learn.gears.assess import CLASSES as GEAR_CLASSES
from learn.model import Model
from learn.real.load import Case
from learn.sim2real.answers import Answer, ByModel, Way, ask, by_detector
from learn.sim2real.gear_answers import gear_ways
from learn.sim2real.rivals import rows_of, said_by, trained_on
from learn.sim2real.scores import confusion, score
from learn.sim2real.severities import severity_table
from learn.simulate.machines import CLASSES

KINDS = ("recording", "window")
GIVEN, NEAR = "speed and geometry given", "speed estimated near the stated one"
RIVAL = "classical detector (same information)"
INTERVALS = """Balanced accuracy over all rigs (means of the classes' 95 % Wilson bounds; windows of one recording
are not independent, so their interval is too narrow):
"""


@dataclass(frozen=True, kw_only=True)
class Results:
    """Tables in Markdown and the last line."""

    text: str
    line: str


def report(
    model: Model, ablated: Mapping[str, Model], cases: Sequence[Case], *, seed: int, pool: Executor | None = None
) -> Results:
    """Everything."""
    stages = [c for c in cases if c.teeth is not None]
    cases = [c for c in cases if c.teeth is None]
    known = [c for c in cases if c.orders is not None]
    main, detector = ask(known, ByModel(model=model), pool=pool), ask(known, by_detector, pool=pool)
    gears = gear_ways(stages, model, pool)
    plain: dict[str, tuple[Sequence[Case], Way, bool]] = {
        NEAR: (known, ByModel(model=model, speed="near"), True),
        "speed estimated from nothing": (known, ByModel(model=model, speed="none"), False),
        "geometry unknown": (cases, ByModel(model=model, geometry=False), True),
        "geometry unknown, speed estimated near the stated one": (
            cases,
            ByModel(model=model, geometry=False, speed="near"),
            True,
        ),
    }
    plain |= {f"smaller data set, {name}": (known, ByModel(model=other), True) for name, other in ablated.items()}
    ways = {GIVEN: main, RIVAL: detector}
    ways |= {name: ask(which, way, windows=cut, pool=pool) for name, (which, way, cut) in plain.items()}
    alone = {name: ways[name] for name in (GIVEN, RIVAL, NEAR)}
    for name, more in zip(alone, gears, strict=True):
        ways[name] = [*ways[name], *more]
    text = "\n\n".join(
        (
            _summary(ways, alone if stages else {}),
            _rivals(known, seed),
            _by_recording(ways),
            _failures(ways),
            "Confusion, windows, speed and geometry given (rows: truth):\n\n" + _confusion(ways[GIVEN]),
            severity_table(main),
        )
    )
    line = {
        "rigs": _rigs(ways[GIVEN]),
        "detector": _rigs(ways[RIVAL]),
        "pooled": _pooled(ways[GIVEN]),
        "pooled_detector": _pooled(ways[RIVAL]),
        "pooled_bearings": _pooled(main),
        "pooled_detector_bearings": _pooled(detector),
        "geometry_unknown": _rigs(ways["geometry unknown"]) | {"pooled": _pooled(ways["geometry unknown"])},
        "speed_estimated": _pooled(ways[NEAR]),
        "speed_estimated_bearings": _pooled(alone[NEAR]),
    }
    return Results(text=text, line="SIM2REAL " + json.dumps(line))


def _of(answers: Sequence[Answer], rig: str | None, kind: str) -> dict[str, object] | None:
    chosen = [a for a in answers if a.unit.kind == kind and rig in (None, a.unit.case.rig)]
    if not chosen:
        return None
    return score([a.unit.case.label for a in chosen], [a.label for a in chosen], kind)


def _rigs(answers: Sequence[Answer]) -> dict[str, object]:
    """Rigs with several classes: whole recordings under their name, windows under `NAME_windows`."""
    found: dict[str, object] = {}
    for rig in dict.fromkeys(a.unit.case.rig for a in answers):
        if len({a.unit.case.label for a in answers if a.unit.case.rig == rig}) < 2:
            continue
        for kind, tail in zip(KINDS, ("", "_windows"), strict=True):
            one = _of(answers, rig, kind)
            if one is not None:
                found[rig + tail] = one
    return found


def _pooled(answers: Sequence[Answer]) -> dict[str, object]:
    """All rigs together, single-class ones too: whole recordings, with the windows' figures beside them."""
    whole, cut = _of(answers, None, KINDS[0]), _of(answers, None, KINDS[1])
    return {**(whole or {}), "windows": cut}


def _share(one: Mapping[str, object] | None) -> str:
    if one is None:
        return "-"
    mean, low, high = (float(str(one[key])) for key in ("balanced_accuracy", "low", "high"))
    return f"{mean:.3f} ({low:.2f} to {high:.2f}), n {one['n']}"


def _summary(ways: Mapping[str, Sequence[Answer]], alone: Mapping[str, Sequence[Answer]]) -> str:
    lines = [
        INTERVALS,
        "| way | recordings | windows of 10 turns |",
        "|---|---|---|",
    ]
    rows = [*ways.items(), *((f"{name}, bearings alone", answers) for name, answers in alone.items())]
    for name, answers in rows:
        lines.append(f"| {name} | {_share(_of(answers, None, KINDS[0]))} | {_share(_of(answers, None, KINDS[1]))} |")
    lines += [
        "\nBy rig, speed and geometry given:\n",
        "| rig | recordings | windows | detector: recordings | windows |",
        "|---|---|---|---|---|",
    ]
    main, detector = ways[GIVEN], ways[RIVAL]
    for rig in dict.fromkeys(a.unit.case.rig for a in main):
        cells = [_share(_of(answers, rig, kind)) for answers in (main, detector) for kind in KINDS]
        lines.append(f"| {rig} | {' | '.join(cells)} |")
    lines += ["\nGeometry unknown, by rig:\n", "| rig | recordings | windows |", "|---|---|---|"]
    unknown = ways["geometry unknown"]
    for rig in dict.fromkeys(a.unit.case.rig for a in unknown):
        lines.append(f"| {rig} | {' | '.join(_share(_of(unknown, rig, kind)) for kind in KINDS)} |")
    return "\n".join(lines)


def _rivals(cases: Sequence[Case], seed: int) -> str:
    rigs = {r: rows_of([c for c in cases if c.rig == r]) for r in dict.fromkeys(c.rig for c in cases)}
    teachers = [r for r, rows in rigs.items() if len({u.case.label for u, _ in rows}) > 1]
    lines = [
        "Trained on another real rig (comparison only), same features:\n",
        "| trained on | tested on | recordings | windows |",
        "|---|---|---|---|",
    ]
    for teacher in teachers:
        head = trained_on(rigs[teacher], seed)
        for rig, rows in rigs.items():
            if rig == teacher:
                continue
            said = said_by(head, rows)
            cells = []
            for kind in KINDS:
                picked = [(u.case.label, s) for (u, _), s in zip(rows, said, strict=True) if u.kind == kind]
                cells.append(_share(score([t for t, _ in picked], [s for _, s in picked], kind)) if picked else "-")
            lines.append(f"| {teacher} | {rig} | {' | '.join(cells)} |")
    return "\n".join(lines)


def _by_recording(ways: Mapping[str, Sequence[Answer]]) -> str:
    names = list(ways)
    lines = ["Recording by recording (windows in brackets: right of all):\n"]
    lines += [f"{k}. {name}" for k, name in enumerate(names, 1)]
    lines += ["", "| rig | recording | truth | " + " | ".join(str(k + 1) for k in range(len(names))) + " |"]
    lines.append("|---" * (3 + len(names)) + "|")
    keys = list(dict.fromkeys((a.unit.case.rig, a.unit.case.name) for answers in ways.values() for a in answers))
    for rig, name in keys:
        cells, truth = [], ""
        for answers in ways.values():
            own = [a for a in answers if (a.unit.case.rig, a.unit.case.name) == (rig, name)]
            truth = own[0].unit.case.label if own else truth
            whole = next((a.label for a in own if a.unit.window is None), "-")
            cut = [a.label == a.unit.case.label for a in own if a.unit.window is not None]
            cells.append(f"{whole} ({sum(cut)}/{len(cut)})" if cut else whole)
        lines.append(f"| {rig} | {name} | {truth} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def _failures(ways: Mapping[str, Sequence[Answer]]) -> str:
    lines = ["Whole recordings answered wrongly:\n"]
    for name, answers in ways.items():
        for a in answers:
            case = a.unit.case
            if a.unit.window is None and a.label != case.label:
                lines += [f"* {name}: {case.name} is {case.label}, said {a.label} ({a.detail})"]
    return "\n".join(lines)


def _confusion(answers: Sequence[Answer]) -> str:
    cut = [a for a in answers if a.unit.window is not None]
    classes = tuple(dict.fromkeys((*CLASSES, *GEAR_CLASSES)))
    rows = confusion([a.unit.case.label for a in cut], [a.label for a in cut], classes)
    lines = ["| truth | " + " | ".join(classes) + " |", "|---" * (1 + len(classes)) + "|"]
    lines += [f"| {name} | " + " | ".join(map(str, row)) + " |" for name, row in zip(classes, rows, strict=True)]
    return "\n".join(lines)
