"""What could have been told of single effects that the engine did not name: bounds from below and above; and which
fault of a tooth it is, from above."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from textwrap import wrap

from proof.apart import FAR, SURE, Apart
from proof.apart import store_of as apart_store
from proof.apart import stored as stored_apart
from proof.oracle import FALSE_ALARMS, HALF, Seen, store_of, stored
from proof.others import cases_of
from proof.plan import Case, Split
from proof.score.one import Score
from proof.score.rates import at_target
from proof.shown import WIDTH
from proof.whole import LAWS, read


def limit(results: Path, parts: Sequence[tuple[Split, str]]) -> str:
    """Of the measured single effects at the target condition in splits and their sections of the page."""
    rows, named, missing = [], 0, 0
    for split, section in parts:
        seen, cases = stored(store_of(results, split)), {c.name: c for c in cases_of(split)}
        singles = [s for s in read(results / f"{section}.json") if s.group == "single" and at_target(s)]
        missing += sum(not s.place and s.name not in seen for s in singles) if seen else 0
        for s in singles:
            if s.name in seen:
                named += bool(s.place)
                rows += [] if s.place else [(s, cases[s.name], seen[s.name])]
    if not rows:
        return ""
    can = sum(seen.low >= HALF for _, _, seen in rows)
    cannot = sum(seen.most < HALF for _, _, seen in rows)
    left = f" ({missing} more of these splits are not measured yet)" if missing else ""
    said = (
        f"Measured on {len(rows)} single effects at the target condition that were not named with their place{left} "
        f"and {named} that were. At {100 * FALSE_ALARMS:.0f} % false alarms half of the tests with an effect are told "
        f"from a distance of {HALF:.1f} on, if all spread normally. {cannot} of the {len(rows)} cannot come so far, "
        f"{can} surely do, of the other {len(rows) - can - cannot} it is open:"
    )
    return "\n".join([*wrap(said, WIDTH), "", *_table(rows)])


def _table(rows: Sequence[tuple[Score, Case, Seen]]) -> list[str]:
    found = ["| case | hidden | the engine said | distance told (90 %) | at most |", "|---|---|---|---|---|"]
    for score, case, seen in sorted(rows, key=lambda row: row[2].most):
        effect = case.effects[0]
        hidden = f"{LAWS[effect.law]}, {effect.site}, {effect.value:.3g} {effect.about().unit}"
        said = score.verdict.replace("_", " ")
        told = f"{seen.distance:.1f} ({seen.low:.1f} to {seen.high:.1f})"
        found.append(f"| {score.name} | {hidden} | {said} | {told} | {seen.most:.1f} |")
    return found


def told_apart(results: Path, parts: Sequence[tuple[Split, str]]) -> str:
    """Of the measured faults of a tooth in splits and their sections of the page."""
    rows = []
    for split, section in parts:
        found, cases = stored_apart(apart_store(results, split)), {c.name: c for c in cases_of(split)}
        rows += [(s, cases[s.name], found[s.name]) for s in read(results / f"{section}.json") if s.name in found]
    if not rows:
        return ""
    near = sum(one.least < FAR for _, _, one in rows)
    said = (
        f"{100 * SURE:.0f} % of the answers can be right from a distance of {FAR:.1f} on, if either fault is as "
        f"likely. {near} of {len(rows)} stay below it; of the others the last column says how well everything between "
        f"tooth and sensor has to be known, order by order, for the difference to count:"
    )
    return "\n".join([*wrap(said, WIDTH), "", *_apart_table(rows)])


def _apart_table(rows: Sequence[tuple[Score, Case, Apart]]) -> list[str]:
    heads = (
        "case", "hidden", "the engine said", "at most from a sound tooth", "nearest other fault", "at most from it",
        "share of the burst that differs",
    )  # fmt: skip
    found = [f"| {' | '.join(heads)} |", "|---" * len(heads) + "|"]
    for score, case, one in sorted(rows, key=lambda row: row[2].least):
        effect = case.effects[0]
        hidden = f"{LAWS[effect.law]}, {effect.site}, {effect.value:.3g} {effect.about().unit}"
        said, other = score.verdict.replace("_", " "), LAWS[one.nearest]
        share = f"{100 * one.least / one.seen:.0f} %"
        found.append(f"| {score.name} | {hidden} | {said} | {one.seen:.1f} | {other} | {one.least:.1f} | {share} |")
    return found
