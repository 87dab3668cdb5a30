"""docs/proof.md from the stored summaries: what was asked, what was reached with its interval, every failure."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import matplotlib as mpl

mpl.use("Agg")
import matplotlib.pyplot as plt

from proof.engine_id import engine_id
from proof.limit import limit, told_apart
from proof.method import METHOD
from proof.one_engine import one_engine
from proof.others import cases_of
from proof.plan import COUNTS, FIRST, OTHERS, Split
from proof.said import SECTIONS
from proof.score.one import Score
from proof.score.rates import at_target
from proof.score.table import failures
from proof.shown import pair_rows, seen_rows
from proof.targets import TARGETS, cut_rows, quoted, wrong_rows
from proof.taught import RULES
from proof.unknown import OPEN
from proof.visible import stored, told
from proof.whole import read, said_of

TITLES = {
    "null": "nothing missing",
    "misset": "nothing missing, parameters mis-set",
    "sensor": "sensor fault",
    "single": "one effect",
    "double": "two effects",
    "open": "effect that no library has",
    "no_baseline": "one effect, no baseline",
    "ambiguous": "causes that look alike",
}


PARTS: tuple[tuple[Split, str], ...] = (
    ("engraver", "engraver"),
    ("dyer", "dyer"),
    ("chandler", "chandler"), ("baker", "baker"), ("twelfth", "twelfth"), ("xenial", "xenial"), ("zenith", "zenith"),
    ("zenith", "after"),
    ("inquest", "inquest"), ("jury", "jury"), ("clear", "clear"), ("vast", "vast"), ("young", "young"),
    ("mixed", "mixed"), ("mixed", "resumed"), ("mixed", "last"), ("mixed", "closing"), ("wide", "wide"),
    ("held", "held"), ("held", "begun"),
)  # fmt: skip
"""Splits, and the sections of the page they are in, of which is asked what could be told at all."""
UNMET = "No version of the engine had met these before their run"
"""How the words on a section begin whose cases were met for the first time."""
TEETH_IN: tuple[Split, ...] = ("teeth", "entire", "next")
"""Further splits of which faults of a tooth are measured."""


def write_page(docs: Path, results: Path) -> Path:
    """Write the page and its pictures; a split without stored summary has no section."""
    laws = len(FIRST) + len(OTHERS) + len(OPEN)
    single = COUNTS["sealed"]["single"] + COUNTS["sealed"]["open"]
    counts = {f"n_{split}": sum(groups.values()) for split, groups in COUNTS.items()}
    rules = "\n".join(["| rule | set by |", "|---|---|", *(f"| {rule} | {by} |" for rule, by in RULES)])
    parts = [
        METHOD.format(
            **said_of(results),
            one_engine=one_engine(results, engine_id()),
            limit=limit(results, PARTS),
            told_apart=told_apart(results, (*PARTS, *((s, s) for s in TEETH_IN))),
            rules=rules,
            laws=laws,
            crossing=laws * 4 * 27,
            n_single=single,
            **counts,
        )
    ]
    for section in SECTIONS:
        kept = results / f"{section}.json"
        if not kept.exists():
            continue
        summary = json.loads(kept.read_text(encoding="utf-8"))
        picture = docs / "proof" / f"{section}.svg"
        picture.parent.mkdir(parents=True, exist_ok=True)
        if _drawn(summary):
            draw(summary, picture)
        parts.append(_split(section, summary, results))
    target = docs / "proof.md"
    docs.mkdir(parents=True, exist_ok=True)
    target.write_text("\n".join(parts), encoding="utf-8")
    return target


def _drawn(summary: Mapping[str, Any]) -> bool:
    """Whether there are single effects, which the curves are of."""
    return bool(summary["curves"]["level"]["alarm"])


def _split(section: str, summary: Mapping[str, Any], results: Path) -> str:
    split = summary["split"]
    commit = f"; commit {summary['commit']}" if "commit" in summary else ""
    scores = read(results / f"{section}.json")
    rows = ["| target (at the target condition) | reached |", "|---|---|"]
    rows += [f"| {t.words} | {_rate(summary, 'target', t.group, t.measure)} |" for t in TARGETS]
    rows += [*cut_rows(scores), *wrong_rows([s for s in scores if at_target(s)])]
    planned: Counter[str] = Counter(case.group for case in cases_of(split))
    wide = ["| group | cases run | verdict right | mechanism | place |", "|---|---|---|---|---|"]
    for group, title in TITLES.items():
        row = summary["groups"]["all"].get(group)
        if row is not None or planned[group]:
            cells = [_rate(summary, "all", group, m) for m in ("verdict_right", "mechanism", "place")]
            wide.append(f"| {title} | {row['alarm']['n'] if row else 0} of {planned[group]} | {' | '.join(cells)} |")
    error, gain = summary["severity_error"], summary["gain"]
    seen = stored(results / f"visible-{split}.json")
    listed = [f"* {line}{told(seen.get(line.split()[0]))}" for line in failures(scores)] or ["* none"]
    return "\n".join(
        [
            f"\n## {section.capitalize()}: {summary['cases']} cases of split `{split}`\n",
            f"{_said(section, summary)} Engine `{summary.get('engine', 'unknown')}` (hash of its source{commit}).\n",
            f"`make proof SPLIT={split} CASES={','.join(s.name for s in scores)}` runs them again.\n",
            *rows, "", *wide, "", *seen_rows(scores, seen), *pair_rows(scores, seen),
            f"Severity error (target: median at most 0.1, 90th percentile 0.3): {_quantiles(error)}.",
            f"Core-seconds (bar 120): {_quantiles(summary['core_seconds'], '.3g')}.",
            f"Held-out gain: {_quantiles(gain)}. Gain that drift between the recordings and noise let a perfect",
            f"model expect: {_quantiles(summary['ceiling'])}{_above(scores)}.\n",
            *([f"![curves](proof/{section}.svg)\n"] if _drawn(summary) else []),
            "### Every case that is wrong in something\n", *listed, "",
        ]
    )  # fmt: skip


def _said(section: str, summary: Mapping[str, Any]) -> str:
    """What a section is: that its cases were met for the first time only where it is stored with the answers."""
    words = SECTIONS[section]
    if not words.startswith(UNMET) or summary.get("first_run"):
        return words
    return (
        "These answers are not stored as a first run: an engine may have met the cases, and learnt from them, before."
    )


def _above(scores: Sequence[Score]) -> str:
    """How many gains are surely above what was expected at most: an expectation is no bound."""
    told = [s for s in scores if s.ceiling is not None and s.gain_low is not None]
    over = sum(s.gain_low > s.ceiling for s in told if s.gain_low is not None and s.ceiling is not None)
    return f"; {over} of {len(told)} gains are surely above it, as it is an expectation and no bound" if over else ""


def _rate(summary: Mapping[str, Any], part: str, group: str, measure: str) -> str:
    found = summary["groups"][part].get(group, {}).get(measure)
    return "-" if found is None else quoted(found)


def _quantiles(found: Mapping[str, float], form: str = ".2g") -> str:
    if not found["n"]:
        return "none measured"
    return f"median {found['median']:{form}}, 90th percentile {found['p90']:{form}} (n = {found['n']})"


def draw(summary: Mapping[str, Any], path: Path) -> None:
    """Rates of single effects over severity, noise, sensors and speeds."""
    axes = {"level": "severity (0 faint, 3 strong)", "snr_db": "SNR, dB", "sensors": "sensors", "speeds": "speeds"}
    with mpl.rc_context({"svg.hashsalt": "proof", "font.size": 8}):
        figure, panels = plt.subplots(1, len(axes), figsize=(11, 2.8), sharey=True)
        for panel, (axis, label) in zip(panels, axes.items(), strict=True):
            for measure, title in (("alarm", "detected"), ("mechanism", "mechanism right"), ("place", "and place")):
                rows = sorted((float(v), r) for v, r in summary["curves"][axis][measure].items())
                if not rows:
                    continue
                share = [r["hits"] / max(1, r["n"]) for _, r in rows]
                low = [max(0.0, s - r["low"]) for s, (_, r) in zip(share, rows, strict=True)]
                high = [max(0.0, r["high"] - s) for s, (_, r) in zip(share, rows, strict=True)]
                places = list(range(len(rows)))
                panel.errorbar(places, share, yerr=[low, high], marker="o", capsize=2, label=title)
                panel.set_xticks(places, [f"{v:g}" for v, _ in rows])
            panel.set_xlabel(label)
            panel.set_ylim(0, 1.02)
        panels[0].set_ylabel("share, 90 % interval")
        handles, titles = panels[0].get_legend_handles_labels()
        if titles:  # beside the panels, where it covers no point
            figure.legend(handles, titles, loc="center right")
        figure.tight_layout(rect=(0.0, 0.0, 0.88, 1.0))
        figure.savefig(path, metadata={"Date": None})
        plt.close(figure)
