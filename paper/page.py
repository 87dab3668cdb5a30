"""Writes docs/paper.md, docs/paper/numbers.md and the pictures."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from paper.cases import RUNOUT_M, Case, Setting, all_settings
from paper.changes import CHANGES
from paper.figures.draw import save
from paper.figures.mesh import figure_7, figure_8, figure_13
from paper.figures.sensitivity import figure_sensitivity
from paper.figures.sensor import figure_9, figure_10, figure_12, figure_16
from paper.figures.sweeps import figure_11, figure_14
from paper.run import Result
from paper.study import STUDIED, judged_changes, judged_main
from paper.tables import changed_table, quality_table, summary_table, trend_tables, verdict_numbers
from paper.verdict.rules import Judgement
from sim.version import PHYSICS_VERSION

FIGURES = (
    ("figure07", figure_7, "Figure 7: centre-distance error and offset angle, no run-out."),
    ("figure08", figure_8, "Figure 8: mesh stiffness and its mean over every single-tooth interval."),
    ("figure09", figure_9, "Figure 9: displacement of the resonator of bearing 1 and its median line, no run-out."),
    ("figure10", figure_10, "Figure 10: acceleration spectra, run-out 20 um."),
    (
        "figure11",
        figure_11,
        "Figure 11: amplitudes against clearance, no run-out; 0 is the healthy machine, x a gap of 0.",
    ),
    ("figure12", figure_12, "Figure 12: orbit of the high-speed shaft at bearing 1, no run-out."),
    ("figure13", figure_13, "Figure 13: single-tooth stiffness at different speeds, 20 um."),
    ("figure14", figure_14, "Figure 14: response at different speeds, 20 um, run-out 20 um."),
    ("figure16", figure_16, "Figure 16(a), (b): acceleration at 20 um, sampled at 30 kHz."),
)
FINDINGS = Path(__file__).parent / "findings.md"

HEAD = f"""# The paper's figures and trends, recomputed

Written by `python -m paper` (`make paper`) with physics version {PHYSICS_VERSION}. Do not edit: words about the results
are in `paper/findings.md`, everything else is computed.

Clearance sweep 1 to 50 um and speed sweep 10 to 60 Hz at 20 um, for two presets, two clearance variants
(`fit_clearance`: rigid wall instead of the support, eq. (34); `fit_clearance_series`: wall in series with the support)
and two forms of the centre distance (eq. (17) as printed; true geometry), each without and with a pinion run-out of
{RUNOUT_M * 1e6:g} um radius. What the presets assume where the paper is silent: [presets](physics/presets.md).

"0" is the healthy machine (no clearance at all). Zero gap with the rigid wall is a different machine and is drawn as a
cross. Every run is simulated from rest; 0.25 s are dropped and 24 revolutions analysed, without anti-alias filter at
60 kHz or more (a filter would ring at the stiffness jumps). Line amplitudes are peak values through a Hann window in
m/s^2 of the resonator's acceleration; multiples of f_o1 are read after all shaft multiples are removed. A line is
*present* when it is 12 dB above the median of its neighbourhood and within 80 dB of the largest line.
"""
RULES = """## How a verdict is reached

The rules are code (`paper/verdict/`). *rises*: net change above 5 % of the larger end, and rank correlation
(Spearman) of at least 0.9: reproduced (`++`); one of the two in the right direction: partly (`+`); else not (`-`).
*present*: all wanted lines `++`, at least half `+`. *envelope at f_o1*: f_o1 is the largest line of the curve made of
one value a mesh period and at least 0.1 % of the signal's range (stiffness: 100 ppm of its mean): `++` at 80 % of the
clearances from 10 um on, `+` at any. The numbers behind every verdict: [numbers](paper/numbers.md).
"""


def _pictures(folder: Path, found: Mapping[Case, Result]) -> list[str]:
    lines = ["## Figures", ""]
    for name, draw, text in FIGURES:
        save(draw(found), folder, name)
        lines += [f"![{text}](paper/{name}.png)", "", f"*{text}*", ""]
    return lines


def _sensitivity(folder: Path, found: Mapping[Case, Result]) -> list[str]:
    lines = [
        "## Which unstated parameter decides",
        "",
        "One parameter changed at a time (six clearances, run-out 20 um, rigid wall, printed form). The speed sweep of",
        "trend 7 was made for some of them only. Trend parts as in the tables above.",
        "",
    ]
    for setting in STUDIED:
        table: dict[str, Mapping[str, Judgement]] = {}
        for change, judgements in judged_changes(setting, found).items():
            table[CHANGES[change].label if change else "preset unchanged"] = judgements
        name = f"sensitivity-{setting.preset}"
        title = f"{setting.preset}: green reproduced, yellow partly, red not"
        save(figure_sensitivity(title, table), folder, name)
        lines += [f"![{title}](paper/{name}.png)", "", *changed_table(setting.preset, table), ""]
    return lines


def write_page(docs: Path, found: Mapping[Case, Result]) -> Path:
    """Write everything; returns the page."""
    folder = docs / "paper"
    folder.mkdir(parents=True, exist_ok=True)
    main: dict[Setting, Mapping[str, Judgement]] = {s: judged_main(s, found) for s in all_settings()}
    numbers = ["# Numbers behind every verdict", "", f"Physics version {PHYSICS_VERSION}.", "", *verdict_numbers(main)]
    (folder / "numbers.md").write_text("\n".join(numbers) + "\n", encoding="utf-8")
    findings = FINDINGS.read_text(encoding="utf-8").splitlines() if FINDINGS.exists() else []
    blocks = [HEAD, *findings, "", RULES, *summary_table(main), *trend_tables(main), *_sensitivity(folder, found)]
    blocks += [*quality_table(found), *_pictures(folder, found)]
    page = docs / "paper.md"
    page.write_text("\n".join(blocks).rstrip() + "\n", encoding="utf-8")
    return page
