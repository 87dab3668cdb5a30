"""Tables of the report, in Markdown."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from learn.gears.assess import CLASSES as GEAR_CLASSES
from learn.sim2real.answers import Answer
from learn.sim2real.figures import KINDS, figure, paired, right, share
from learn.sim2real.rigs import INFERRED
from learn.sim2real.scores import confusion
from sideband_datasets.recipe.bearings import CLASSES

INTERVALS = """Balanced accuracy over all rigs (95 % interval: a bootstrap over recordings, half a wrong one
added to each class for the lower bound, half a right one for the upper; rather too wide):
"""


def summary(rows: Mapping[str, Sequence[Answer]], rule_db: float | None) -> str:
    """All ways, over all rigs they were asked about."""
    lines = [INTERVALS, "| way | recordings | windows of 10 turns |", "|---|---|---|"]
    for name, answers in rows.items():
        lines.append(f"| {name} | {' | '.join(share(figure(answers, None, kind)) for kind in KINDS)} |")
    if rule_db is not None:
        lines.append(f"\nThe fitted threshold is {rule_db:.1f} dB (`learn/sim2real/fitted_rule.py`), the other 30 dB.")
    return "\n".join(lines)


def by_rig(title: str, ways: Mapping[str, Sequence[Answer]]) -> str:
    """One row for each rig."""
    heads = [f"{name}{unit}" for name in ways for unit in ("recordings", "windows")]
    lines = [f"{title}\n", f"| rig | {' | '.join(heads)} |", "|---" * (1 + len(heads)) + "|"]
    for rig in dict.fromkeys(a.unit.case.rig for answers in ways.values() for a in answers):
        cells = [share(figure(answers, rig, kind)) for answers in ways.values() for kind in KINDS]
        lines.append(f"| {rig} | {' | '.join(cells)} |")
    return "\n".join(lines)


def inferred(answers: Sequence[Answer]) -> str:
    """A note on rigs whose bearing is a conclusion from their own recordings; empty without such."""
    named = [rig for rig in INFERRED if any(a.unit.case.rig == rig for a in answers)]
    if not named:
        return ""
    return (
        f"The bearing of {', '.join(named)} is not stated: its size was inferred "
        "from orders found in these recordings,\n"
        'faulty ones among them. "Bearings of stated size", above, is without.'
    )


def by_class(title: str, ways: Mapping[str, Sequence[Answer]]) -> str:
    """How many of each class are answered rightly."""
    lines = [f"{title}\n", f"| way | unit | {' | '.join(CLASSES)} |", "|---" * (2 + len(CLASSES)) + "|"]
    for name, answers in ways.items():
        for kind in KINDS:
            own = [a for a in answers if a.unit.kind == kind]
            if own:
                of = [[right(a) for a in own if a.unit.case.label == label] for label in CLASSES]
                lines.append(f"| {name} | {kind} | {' | '.join(f'{sum(one)}/{len(one)}' for one in of)} |")
    return "\n".join(lines)


def paired_table(name: str, ways: Mapping[str, Sequence[Answer]]) -> str:
    """One way against each other one, recording by recording."""
    lines = [
        f"{name[0].upper()}{name[1:]}, against the other ways (recordings answered better or worse; of windows: more",
        "or fewer of its windows right; p: exact two-sided sign test):\n",
        "| against | unit | recordings | better | worse | p |",
        "|---|---|---|---|---|---|",
    ]
    for other, answers in ways.items():
        for kind in KINDS:
            if other != name and any(a.unit.kind == kind for a in answers):
                pair = paired([a for a in ways[name] if a.unit.kind == kind], answers, kind)
                cells = (pair[key] for key in ("unit", "recordings", "better", "worse", "sign_test_p"))
                lines.append(f"| {other} | {' | '.join(map(str, cells))} |")
    return "\n".join(lines)


def unscored(answers: Sequence[Answer]) -> str:
    """Recordings of a condition that is no class."""
    if not answers:
        return ""
    lines = ["Recordings that count nowhere, as their condition is none of the classes:\n"]
    lines += [f"* {a.unit.case.rig}, {a.unit.case.name}: said {a.label} ({a.detail})" for a in answers]
    return "\n".join(lines)


def by_recording(ways: Mapping[str, Sequence[Answer]]) -> str:
    """Every recording, every way."""
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
            cut = [right(a) for a in own if a.unit.window is not None]
            cells.append(f"{whole} ({sum(cut)}/{len(cut)})" if cut else whole)
        lines.append(f"| {rig} | {name} | {truth} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def failures(ways: Mapping[str, Sequence[Answer]]) -> str:
    """Whole recordings answered wrongly, with the detail."""
    lines = ["Whole recordings answered wrongly:\n"]
    for name, answers in ways.items():
        for a in answers:
            case = a.unit.case
            if a.unit.window is None and not right(a):
                lines += [f"* {name}: {case.name} is {case.label}, said {a.label} ({a.detail})"]
    return "\n".join(lines)


def confusion_table(answers: Sequence[Answer]) -> str:
    """Windows by truth and answer."""
    cut = [a for a in answers if a.unit.window is not None]
    classes = tuple(dict.fromkeys((*CLASSES, *GEAR_CLASSES)))
    rows = confusion([a.unit.case.label for a in cut], [a.label for a in cut], classes)
    lines = ["| truth | " + " | ".join(classes) + " |", "|---" * (1 + len(classes)) + "|"]
    lines += [f"| {name} | " + " | ".join(map(str, row)) + " |" for name, row in zip(classes, rows, strict=True)]
    return "\n".join(lines)
