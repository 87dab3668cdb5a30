"""Tables of the page, as lines of Markdown."""

from __future__ import annotations

from collections.abc import Mapping

from paper.cases import FORMS, PRESETS, RUNOUT_M, VARIANTS, Case, Form, Setting
from paper.run import Result
from paper.verdict.parts import PARTS
from paper.verdict.rules import Judgement, Verdict

MARKS: Mapping[Verdict, str] = {"reproduced": "++", "partly": "+", "not": "-"}
SHORT = {
    "paper": "paper",
    "paper-lightly-damped": "light",
    "fit_clearance": "rigid",
    "fit_clearance_series": "series",
}
TRENDS = {
    "1": "Trend 1 (Fig. 7): centre distance and offset angle",
    "2": "Trend 2 (Fig. 8): mesh stiffness",
    "3": "Trend 3 (Fig. 9): displacement of the resonator",
    "4": "Trend 4 (Fig. 10): spectrum",
    "5": "Trend 5 (Fig. 11): line amplitudes against clearance",
    "6": "Trend 6 (Fig. 12): orbit",
    "7": "Trend 7 (Figs 13, 14): speed",
    "8": "Trend 8 (Fig. 16): the lines of the experiment, in the model",
}
Judged = Mapping[Setting, Mapping[str, Judgement]]


def _row(cells: list[str]) -> str:
    return "| " + " | ".join(cells) + " |"


def _pair(main: Judged, column: tuple[str, str, Form], key: str) -> str:
    """Verdict without and with run-out, once where both agree."""
    preset, variant, form = column
    settings = [Setting(preset=preset, variant=variant, form=form, runout_m=r) for r in (0.0, RUNOUT_M)]
    first, second = (MARKS[main[s][key].verdict] for s in settings)
    return first if first == second else f"{first} / {second}"


def summary_table(main: Judged) -> list[str]:
    """How many parts each setting reproduces, reproduces partly, and does not."""
    lines = ["## Summary", "", _row(["setting", "run-out, um", "++", "+", "-"]), _row(["---"] * 5)]
    for setting, judged in main.items():
        marks = [MARKS[j.verdict] for j in judged.values()]
        name = f"{SHORT[setting.preset]} {SHORT[setting.variant]} {setting.form}"
        counts = [str(marks.count(mark)) for mark in ("++", "+", "-")]
        lines.append(_row([name, f"{setting.runout_m * 1e6:g}", *counts]))
    return [*lines, ""]


def trend_tables(main: Judged) -> list[str]:
    """One table a trend: verdicts of every part by preset, variant and form; `without / with run-out`."""
    columns = [(p, v, f) for p in PRESETS for v in VARIANTS for f in FORMS]
    titles = [f"{SHORT[p]} {SHORT[v]} {f}" for p, v, f in columns]
    lines = [
        "## Verdicts",
        "",
        "`++` reproduced, `+` partly, `-` not. Two marks: without / with run-out; one mark: the same for both.",
        "",
    ]
    for number, heading in TRENDS.items():
        lines += [f"### {heading}", "", _row(["part", "claim", *titles]), _row(["---"] * (2 + len(columns)))]
        for part in (p for p in PARTS if p.key.startswith(number)):
            cells = [_pair(main, column, part.key) for column in columns]
            lines.append(_row([part.key, part.claim, *cells]))
        lines.append("")
    return lines


def verdict_numbers(main: Judged) -> list[str]:
    """One table a part: setting, verdict, numbers."""
    lines = []
    for part in PARTS:
        lines += [f"## {part.key}: {part.claim}", "", _row(["setting", "verdict", "numbers"]), _row(["---"] * 3)]
        for setting, judged in main.items():
            name = f"{SHORT[setting.preset]} {SHORT[setting.variant]} {setting.form}"
            name += f" run-out {setting.runout_m * 1e6:g} um"
            lines.append(_row([name, judged[part.key].verdict, judged[part.key].numbers]))
        lines.append("")
    return lines


def changed_table(preset: str, table: Mapping[str, Mapping[str, Judgement]]) -> list[str]:
    """For every part: the changes under which its verdict gets better, and worse."""
    order = {"not": 0, "partly": 1, "reproduced": 2}
    base = next(iter(table.values()))
    lines = [_row([f"{preset}: part", "unchanged", "better with", "worse with"]), _row(["---"] * 4)]
    claims = {p.key: p.claim for p in PARTS}
    for key, judgement in base.items():
        level = order[judgement.verdict]
        moved = {label: order[row[key].verdict] - level for label, row in table.items() if key in row}
        better = [f"{label} ({MARKS[table[label][key].verdict]})" for label, d in moved.items() if d > 0]
        worse = [f"{label} ({MARKS[table[label][key].verdict]})" for label, d in moved.items() if d < 0]
        cells = [f"{key} {claims[key]}", MARKS[judgement.verdict], "; ".join(better), "; ".join(worse)]
        lines.append(_row(cells))
    return lines


def quality_table(found: Mapping[Case, Result]) -> list[str]:
    """How good the runs are: worst energy residual, unsettled runs, steps that did not converge."""
    lines = [
        "## Quality of the runs",
        "",
        "`halves`: RMS of the first over the second half of the analysed stretch (1 when settled). `irregular`: share",
        "of the acceleration that does not repeat with the mesh (1: nothing repeats).",
        "",
        _row(["preset", "runs", "worst energy residual", "unconverged steps", "halves", "most irregular"]),
        _row(["---"] * 6),
    ]
    for preset in PRESETS:
        numbers = [r.numbers for c, r in found.items() if c.setting.preset == preset and not c.setting.change]
        halves = [n["acc_halves"] for n in numbers]
        cells = [
            preset,
            str(len(numbers)),
            f"{max(n['energy_residual'] for n in numbers):.2g}",
            f"{sum(n['unconverged'] for n in numbers):g}",
            f"{min(halves):.3f} to {max(halves):.3f}",
            f"{max(n['acc_irregular'] for n in numbers):.2f}",
        ]
        lines.append(_row(cells))
    return [*lines, ""]
