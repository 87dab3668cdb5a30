"""All stored first runs taken together: every target, by law, by version of the engine."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from textwrap import wrap
from typing import NamedTuple

from proof.said import FIRST_RUNS, HISTORY, TAKEN_DOWN
from proof.score.one import Score
from proof.score.rates import MEASURES, Rate, at_target, quantiles, rate
from proof.shown import WIDTH, all_rows, parting
from proof.targets import (
    BAR_S,
    CUT_WORDS,
    SEVERITY,
    TARGETS,
    WRONG_WORDS,
    Stands,
    cut_rates,
    written,
    wrong_rates,
)
from proof.visible import Visible, stored

LAWS = {
    "loose_fit": "ring loose in its seat",
    "outer_pit": "pit of an outer race",
    "inner_pit": "pit of an inner race",
    "ball_pit": "pit of a ball",
    "root_crack": "cracked tooth root",
    "flank_pit": "pit of a tooth's flank",
    "broken_tooth": "broken tooth",
    "loose_seat": "loose pedestal",
    "imbalance": "unbalance",
    "run_out": "eccentric gear",
    "bow": "bent shaft",
    "parallel_offset": "parallel misalignment of a coupling",
    "joint_angle": "angular misalignment of a coupling",
    "uneven_torque": "uneven torque",
    "touching_ring": "rub",
    "play": "backlash",
    "flank_friction": "friction of teeth",
    "tooth_pitch": "pitch error of a gear",
    "tooth_profile": "profile error of a gear",
    "wider_clearance": "wider clearance of a bearing",
    "outer_waves": "wavy outer race",
    "inner_waves": "wavy inner race",
    "extra_mode": "part that vibrates on a seat",
    "load_stiffening": "support that stiffens with load",
    "breathing_crack": "cracked shaft",
    "oil_film": "oil film at a seat",
    "stiffening_coupling": "coupling that stiffens",
}
"""The library's laws in words of the field."""
PITS = ("outer_pit", "inner_pit", "ball_pit")
"""Of bearings, whose balls have no mass in the product either."""
FEW = 2
"""So few cases of a law say next to nothing of it."""


def read(path: Path) -> list[Score]:
    """The scores of a stored summary; none where there is no such file."""
    if not path.exists():
        return []
    return [Score(**(s | {"laws": tuple(s["laws"])})) for s in json.loads(path.read_text(encoding="utf-8"))["scores"]]


def first_runs(results: Path) -> list[Score]:
    """All stored first runs, each with the engine of its day."""
    return [s for section in FIRST_RUNS for s in read(results / f"{section}.json")]


class Row(NamedTuple):
    """One of the table: words, a cell at the target condition and one at all, how it stands."""

    words: str
    at: str
    every: str
    stands: Stands | None = None


def together(scores: Sequence[Score], wider: Sequence[Score] = (), *, title: str = "stored first runs") -> str:
    """Table of every target, at the target condition and at all; and which targets are missed and held.

    `wider`: scores of further first runs with these, of which the same is told in columns beside; `title`: what the
    scores are.
    """
    rows, beside = whole_rows(scores), whole_rows(wider) if wider else []
    titles = "at the target condition | at all conditions | target |"
    if not wider:
        table = [f"| {title} | {titles}", "|---|---|---|---|"]
        table += [f"| {r.words} | {_cells(r)} |" for r in rows]
        return "\n".join([*table, *_standing(rows, "")])
    table = [f"| {title} | one engine, {titles} all first runs, {titles}", "|---|---|---|---|---|---|---|"]
    table += [f"| {r.words} | {_cells(r)} | {_cells(w)} |" for r, w in zip(rows, beside, strict=True)]
    parts = [*table, *_standing(rows, " by the one engine"), *_standing(beside, " by all first runs together")]
    return "\n".join(parts)


def _cells(row: Row) -> str:
    return f"{row.at} | {row.every} | {row.stands.text() if row.stands else '-'}"


def _standing(rows: Sequence[Row], by: str) -> list[str]:
    """Paragraphs of what is missed and held."""
    found = []
    for title, met in (("Missed", False), ("Held", True)):
        part = [(r.words, r.stands.words) for r in rows if r.stands and r.stands.met is met]
        told = "; ".join(f"{words} ({how})" if how else words for words, how in part)
        found += ["", *wrap(f"{title}{by} are: {told or 'none'}.", WIDTH)]
    return found


def whole_rows(scores: Sequence[Score]) -> list[Row]:
    """Rows of the table."""
    columns = [s for s in scores if at_target(s)], scores
    rows = []
    for target in TARGETS:
        at, every = (rate([s for s in c if s.group == target.group], MEASURES[target.measure]) for c in columns)
        rows.append(Row(target.words, written(at), written(every), target.standing(at if at.n else every)))
    rows += _sizes(columns)
    for titles, rates in ((CUT_WORDS, cut_rates), (WRONG_WORDS, wrong_rates)):
        found = [rates(part) for part in columns]
        rows += [Row(words, written(a), written(b)) for words, a, b in zip(titles, *found, strict=True)]
    return rows + _costs(columns)


def _sizes(columns: Sequence[Sequence[Score]]) -> list[Row]:
    """Severity error and held-out gain."""
    found = [quantiles(s.severity_error for s in part) for part in columns]
    rows = []
    for key, most, words in SEVERITY:
        at, every = (f"{q[key]:.2f} (n = {q['n']})" if q["n"] else "-" for q in found)
        over = found[0][key] - most if found[0]["n"] else None
        stands = None if over is None else Stands(False, f"by {over:.2f}") if over > 0.0 else Stands(True, "")
        rows.append(Row(words, at, every, stands))
    gains = [quantiles(s.gain for s in part) for part in columns]
    at, every = (f"{q['median']:.2f}, {q['p90']:.2f} (n = {q['n']})" if q["n"] else "-" for q in gains)
    return [*rows, Row("held-out gain where one was measured: median, 90th percentile", at, every)]


def _costs(columns: Sequence[Sequence[Score]]) -> list[Row]:
    """Core-seconds."""
    costs = [[s.core_seconds for s in part if s.core_seconds is not None] for part in columns]
    known = [quantiles(part) for part in costs]
    at, every = (f"{q['median']:.0f}, {q['p90']:.0f} (n = {q['n']})" if q["n"] else "-" for q in known)
    lost = [sum(s.failed and s.core_seconds is None for s in part) for part in columns]
    over = [Rate(hits=sum(c > BAR_S for c in p) + k, n=len(p) + k) for p, k in zip(costs, lost, strict=True)]
    stands = Stands(False, f"in {over[0].hits} of {over[0].n}") if over[0].hits else None
    return [
        Row("core-seconds: median, 90th percentile", at, every),
        Row(
            f"cases that took more than {BAR_S:.0f} core-seconds, or came to no end",
            written(over[0]),
            written(over[1]),
            stands,
        ),
    ]


def by_law(scores: Sequence[Score]) -> list[str]:
    """Table of single effects at the target condition, those most often hidden first, and their sum."""
    single = [s for s in scores if s.group == "single" and at_target(s)]
    often = Counter(s.laws[0] for s in single)
    parts = {law: [s for s in single if s.laws[0] == law] for law in sorted(often, key=lambda one: (-often[one], one))}
    rows = ["| effect | cases | detected | mechanism | with place |", "|---|---|---|---|---|"]
    for law, part in parts.items():
        rows.append(f"| {LAWS[law]} (`{law}`) | {_counts(part)} |")
    rows += [f"| all | {_counts(single)} |", ""]
    never = [f"{LAWS[law]} ({len(part)})" for law, part in parts.items() if not any(s.mechanism for s in part)]
    few = sum(len(part) <= FEW for part in parts.values())
    absent = [title for law, title in LAWS.items() if law not in parts]
    others = rate([s for s in single if s.laws[0] not in PITS], MEASURES["place"])
    said = [
        f"Without the pits of bearings {written(others)} are named with their place.",
        f"Named in no case: {', '.join(never)}." if never else "",
        f"Hidden in no case: {', '.join(absent)}. {few} of the {len(parts)} have {FEW} cases at most.",
    ]
    return [*rows, *wrap(" ".join(said), WIDTH)]


def _counts(part: Sequence[Score]) -> str:
    marks: Sequence[Callable[[Score], bool | None]] = (lambda s: s.alarm, lambda s: s.mechanism, lambda s: s.place)
    return " | ".join([str(len(part)), *(f"{sum(bool(mark(s)) for s in part)}/{len(part)}" for mark in marks)])


def history(results: Path) -> str:
    """Rows of the first runs at the target condition by what the engine of their day could, of stored summaries."""
    rows = []
    for section, (cases, could) in HISTORY.items():
        at = [s for s in read(results / f"{section}.json") if at_target(s)]
        cells = []
        for group, measure, word in (
            ("single", "place", ""), ("null", "alarm", " alarms"), ("open", "unknown_flagged", " flagged"),
            ("double", "both", ""),
        ):  # fmt: skip
            found = rate([s for s in at if s.group == group], MEASURES[measure])
            cells.append(f"{found.hits} of {found.n}{word}" if found.n else "-")
        if at:
            rows.append(f"| {cases} | {could} | {' | '.join(cells)} |")
    return "\n".join(rows)


def said_of(results: Path) -> dict[str, object]:
    """What the page's text says of the stored first runs."""
    scores = first_runs(results)
    at = [s for s in scores if at_target(s)]
    single = rate([s for s in at if s.group == "single"], MEASURES["place"])
    every = Rate(hits=single.hits + TAKEN_DOWN[0], n=single.n + TAKEN_DOWN[1])
    kept = [results / f"{section}.json" for section in FIRST_RUNS]
    engines = {json.loads(path.read_text(encoding="utf-8")).get("engine") for path in kept if path.exists()}
    return {
        "together": together(scores),
        "by_law": "\n".join(by_law(scores)),
        "shown": of_what_shows(scores, measured(results)),
        "history": history(results),
        "overall": f"Counted with them {written(every)} of single effects are named with their place.",
        "versions": len(engines),
        "undecided": sum(s.verdict == "not_decidable" for s in scores if s.group == "null"),
        "elsewhere": len(scores) - len(at),
        "n_first": len(scores),
        "few_pairs": sum(s.verdict_right and not s.both for s in at if s.group == "double"),
        "right_pairs": sum(s.verdict_right for s in at if s.group == "double"),
    }


def measured(results: Path) -> dict[str, Visible]:
    """What is to be seen in all cases of which it was measured."""
    return {name: one for path in sorted(results.glob("visible-*.json")) for name, one in stored(path).items()}


def of_what_shows(scores: Sequence[Score], seen: Mapping[str, Visible]) -> str:
    """First runs at the target condition by how much there is to see, and how well that parts the right ones."""
    at = [s for s in scores if at_target(s)]
    return "\n".join([*all_rows(at, seen), *parting(at, seen)])
