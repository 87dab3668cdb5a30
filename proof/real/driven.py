"""Measured systems whose input was measured too: the engine's law, and how it runs on data that it was not fitted on.

Machine: the preset `oscillator`, a mass on a spring. The engine is started from a linear model that it fits itself.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from proof.real import told
from proof.real.call import Answer, Source, reconciled
from proof.real.rigs import WHY
from proof.real.tables import table
from proof.run import Engine

Document = Mapping[str, Any]
MACHINE = "oscillator"
INCH_MM = 25.4
RUNS_ON = re.compile(
    r"(: \S+ mm of play|; the exponent|; free-run error|; error of the force|, and after a reversal).*"
)
"""What of a sentence stands in other columns."""


@dataclass(frozen=True, kw_only=True)
class System:
    """Recordings of one system: files by stem, each with the columns that are described (None: all).

    `says`: words the answer must have to be right; `published`: best published error, or what its source reads off.
    """

    name: str
    files: tuple[str, ...]
    truth: str
    columns: tuple[Mapping[str, tuple[str, str]], ...] | None = None
    says: tuple[str, ...]
    explained: bool = True
    published: str = ""


SYSTEMS = (
    System(
        name="silverbox",
        files=("SNLS80mV",),
        truth="cubic stiffness",
        says=("cubic support, odd stiffness",),
        published="0.44 %",
    ),
    System(
        name="brfd, two amplitudes",
        files=("ds2_1Hz30lbtension0.5amplitude", "ds2_1Hz30lbtension1.5amplitude"),
        truth="backlash and friction",
        says=("backlash", "friction"),
    ),
    System(
        name="brfd, two band tensions",
        files=("ds1_1Hz20lbtension", "ds1_1Hz80lbtension"),
        truth="backlash and friction",
        says=("backlash", "friction"),
    ),
    System(
        name="cascaded_tanks",
        files=("dataBenchmark", "dataBenchmark"),
        columns=(
            {"uEst": ("pump", "input"), "yEst": ("level", "output")},
            {"uVal": ("pump", "input"), "yVal": ("level", "output")},
        ),
        truth="overflow, square-root outflow",
        says=("saturation", "root"),
    ),
)
TRAVEL_IN = {
    "ds1_1Hz20lbtension": 0.196,
    "ds2_1Hz30lbtension0.5amplitude": 0.362,
}
"""Way after a reversal until 80 % of the sliding force, inch, as read off the fitted file by the catalogue."""


def answered(engine: Engine, recordings: Path, entries: Mapping[str, Document], system: System) -> Answer:
    """The engine on one system."""
    columns = system.columns or (None,) * len(system.files)
    tests = [Source(entry=entries[f], channels=c) for f, c in zip(system.files, columns, strict=True)]
    return reconciled(engine, recordings, MACHINE, tests)


def judged(system: System, answer: Answer) -> str:
    """`right`, `undecided` (part of the truth is said) or `wrong`."""
    if answer.report is None:
        return "wrong"
    said = [word in answer.report["sentence"] for word in system.says]
    if all(said) and answer.report["verdict"] == "explained":
        return "right"
    return "undecided" if any(said) else "wrong"


def laws(found: Sequence[tuple[System, Answer]]) -> list[str]:
    """Verdict, law, and sizes."""
    rows = []
    for system, answer in found:
        report = answer.report
        verdict = "failed" if report is None else report["verdict"].replace("_", " ")
        law = (answer.error or "") if report is None else RUNS_ON.sub("", report["sentence"])
        size = "" if report is None else _size(system, report)
        rows.append([system.name, system.truth, verdict, law, size, judged(system, answer)])
    return table(("system", "truth", "verdict", "says", "exponent or size (90 %)", "judged"), rows)


def _size(system: System, report: Document) -> str:
    power = next((s["exponent_by_free_run"] for s in report["stages"] if "exponent_by_free_run" in s), None)
    if power is not None and report["verdict"] == "explained":
        return f"exponent {power[0]:.2f} ({power[1]:.2f} to {power[2]:.2f})"
    travel = _travel(report)
    if travel is None:
        return ""
    mean, low, high = travel
    friction = next(c["severity"] for c in report["causes"] if c["term"] == "coulomb_friction")
    level, least, most = (friction[k] / 1e3 for k in ("value", "low", "high"))
    read = f"{INCH_MM * TRAVEL_IN[system.files[0]]:.1f} by the catalogue"
    play = report["causes"][0]["severity"]
    return (
        f"play {1e3 * play['value']:.1f} mm ({1e3 * play['low']:.1f} to {1e3 * play['high']:.1f}); friction "
        f"{level:.1f} kN ({least:.1f} to {most:.1f}); travel {mean:.1f} mm ({low:.1f} to {high:.1f}; {read})"
    )


def runs(found: Sequence[tuple[System, Answer]]) -> list[str]:
    """Every held-out part or run: error before and after, and of the rivals."""
    rows = []
    for system, answer in found:
        stages = answer.report["stages"] if answer.report is not None else []
        for v in (s for s in stages if s.get("stage") == "validate"):
            before, after, box, placebo, how = _errors(v)
            cells = [told.amount(x, "1") for x in (before, after, _retuned(v, before), box, placebo)]
            rows.append([system.name, f"{v['held']} (fitted on {v['fitted_on']}){how}", *cells, system.published])
    head = ("system", "held out", "before", "after", "retuned", "black box", "placebo", "best published")
    return table(head, rows)


def _errors(v: Document) -> tuple[float, float, float, float, str]:
    """Errors of linear model, law, black box and placebo; with how much of the held-out run was used."""
    if "linear" not in v:
        before = v["before"]
        return before, v["after"], before * (1 - v["black_box"]), before * (1 - v["placebo"]), ""
    k = 0 if v["friction_transfers"] else 1
    how = "" if k == 0 else ", friction level from its first third"
    return v["linear"][k], v["chosen"][k], v["black_box"][k], v["placebo"][k], how


def _retuned(v: Document, before: float) -> float:
    """Error of the retuned linear model."""
    return float(v["retuned"] if "linear" in v else before * (1 - v["retuned"]))


def misses(found: Sequence[tuple[System, Answer]]) -> list[str]:
    """Every system that is not right, with the reason, and every size that is not the catalogue's."""
    lines = []
    for system, answer in found:
        if (word := judged(system, answer)) != "right":
            lines.append(f"- {system.name} ({word}): {WHY.get(system.files[0], '')}")
        travel = _travel(answer.report)
        true = TRAVEL_IN.get(system.files[0])
        if travel is not None and true is not None and not travel[1] <= INCH_MM * true <= travel[2]:
            said = f"{travel[1]:.1f} to {travel[2]:.1f} mm"
            lines.append(f"- {system.name} (travel): {said} do not hold {INCH_MM * true:.1f} mm, the catalogue's.")
    return lines


def _travel(report: Document | None) -> tuple[float, float, float] | None:
    """Way after a reversal, mm: mean and 90 % interval."""
    stages = report["stages"] if report is not None else []
    found = next((s["travel_after_reversal"] for s in stages if "travel_after_reversal" in s), None)
    if found is None:
        return None
    mean, low, high = (1e3 * float(found[k]) for k in ("mean_m", "low_m", "high_m"))
    return mean, low, high
