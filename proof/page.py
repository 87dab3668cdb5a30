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

from proof.method import FIRST_RUNS, METHOD, SECTIONS
from proof.others import cases_of
from proof.plan import COUNTS, FIRST, OTHERS
from proof.score.one import Score
from proof.score.rates import MEASURES, Rate, at_target, rate
from proof.score.table import failures
from proof.shown import all_rows, pair_rows, seen_rows
from proof.taught import RULES
from proof.unknown import OPEN
from proof.visible import stored, told

HALF = 0.5
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
TARGETS = (
    ("null", "alarm", "false alarms on nulls at most 8/300"),
    ("single", "mechanism", "mechanism right at least 95 %"),
    ("single", "place", "with place at least 85 %"),
    ("single", "top_three", "among the first three at least 97 %"),
    ("open", "unknown_flagged", "unknown effects flagged at least 80 %"),
    ("single", "false_unknown", "false unknowns at most 5 %"),
    ("double", "both", "both of a pair at least 70 %"),
    ("double", "false_name", "a name beside the pair's"),
    ("single", "severity_covered", "90 % intervals cover 85-95 %"),
    ("single", "beats_black_box", "beats the black box in at least 80 %"),
    ("single", "placebo_improves", "placebos (the median of each case's) improve in at most 5 %"),
    ("ambiguous", "cannot_tell", '"cannot tell" in at least 90 % of look-alikes'),
)


def write_page(docs: Path, results: Path) -> Path:
    """Write the page and its pictures; a split without stored summary has no section."""
    laws = len(FIRST) + len(OTHERS) + len(OPEN)
    single = COUNTS["sealed"]["single"] + COUNTS["sealed"]["open"]
    counts = {f"n_{split}": sum(groups.values()) for split, groups in COUNTS.items()}
    rules = "\n".join(["| rule | set by |", "|---|---|", *(f"| {rule} | {by} |" for rule, by in RULES)])
    parts = [
        METHOD.format(
            together=together(results),
            shown=of_what_shows(results),
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
    scores = [Score(**(s | {"laws": tuple(s["laws"])})) for s in summary["scores"]]
    rows = ["| target (at the target condition) | reached |", "|---|---|"]
    rows += [f"| {sentence} | {_rate(summary, 'target', group, measure)} |" for group, measure, sentence in TARGETS]
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
            f"{SECTIONS[section]} Engine `{summary.get('engine', 'unknown')}` (hash of its source).\n",
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


def cut_rows(scores: Sequence[Score]) -> list[str]:
    """How often the spectral distance is cut by half: of all single effects, undetected ones too, and of those of which
    a gain was measured and drift and noise let one expect as much."""
    single = [s for s in scores if s.group == "single" and at_target(s)]
    room = [s for s in single if s.gain is not None and s.ceiling is not None and s.ceiling >= HALF]
    rows = []
    for part, words in ((single, "of all"), (room, "of those detected where drift and noise leave room for it")):
        found = Rate(hits=sum(s.gain is not None and s.gain >= HALF for s in part), n=len(part)).document()
        rows.append(f"| spectral distance cut by at least 50 %, {words} | {_written(found) if part else '-'} |")
    return rows


def wrong_rows(scores: Sequence[Score]) -> list[str]:
    """Names given to single effects that are wrong in kind or place, and to machines where nothing is hidden."""
    single = [s for s in scores if s.group == "single"]
    found = Rate(hits=sum(s.verdict == "explained" and not s.place for s in single), n=len(single))
    sound = [s for s in scores if s.group in ("null", "misset", "sensor")]
    named = Rate(hits=sum(s.verdict == "explained" for s in sound), n=len(sound))
    rows = ((found, "one effect named as another or elsewhere"), (named, "a name where no effect is hidden"))
    return [f"| {words} | {_written(r.document()) if r.n else '-'} |" for r, words in rows]


def first_runs(results: Path) -> list[Score]:
    """All stored first runs, each with the engine of its day."""
    scores = []
    for section in FIRST_RUNS:
        if (results / f"{section}.json").exists():
            kept = json.loads((results / f"{section}.json").read_text(encoding="utf-8"))["scores"]
            scores += [Score(**(s | {"laws": tuple(s["laws"])})) for s in kept]
    return scores


def together(results: Path) -> str:
    """Table of all stored first runs."""
    scores = first_runs(results)
    asked = [t for t in TARGETS if t[1] in ("alarm", "mechanism", "place", "top_three", "unknown_flagged", "both")]
    rows = ["| stored first runs | at the target condition | at all conditions |", "|---|---|---|"]
    parts = [[s for s in scores if at_target(s)], scores]
    for group, measure, words in asked:
        cells = [rate([s for s in part if s.group == group], MEASURES[measure]) for part in parts]
        rows.append(f"| {words} | {' | '.join(_written(c.document()) if c.n else '-' for c in cells)} |")
    for first, second in zip(*(wrong_rows(part) for part in parts), strict=True):
        rows.append(f"{first} {second.split('|')[2].strip()} |")
    return "\n".join(rows)


def of_what_shows(results: Path) -> str:
    """The same at the target condition by how much there is to see."""
    seen = {name: one for path in sorted(results.glob("visible-*.json")) for name, one in stored(path).items()}
    return "\n".join(all_rows([s for s in first_runs(results) if at_target(s)], seen))


def _above(scores: Sequence[Score]) -> str:
    """How many gains are surely above what was expected at most: an expectation is no bound."""
    told = [s for s in scores if s.ceiling is not None and s.gain_low is not None]
    over = sum(s.gain_low > s.ceiling for s in told if s.gain_low is not None and s.ceiling is not None)
    return f"; {over} of {len(told)} gains are surely above it, as it is an expectation and no bound" if over else ""


def _rate(summary: Mapping[str, Any], part: str, group: str, measure: str) -> str:
    found = summary["groups"][part].get(group, {}).get(measure)
    return "-" if found is None else _written(found)


def _written(found: Mapping[str, float]) -> str:
    share = 100 * found["hits"] / found["n"]
    return f"{found['hits']}/{found['n']} = {share:.0f} % ({100 * found['low']:.0f} to {100 * found['high']:.0f})"


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
