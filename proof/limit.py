"""What an oracle could have told of single effects that the engine did not name: the limit, for the page."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from textwrap import wrap

from proof.oracle import FALSE_ALARMS, Seen, store_of, stored
from proof.others import cases_of
from proof.plan import Case, Split
from proof.score.one import Score
from proof.score.rates import at_target
from proof.shown import WIDTH
from proof.whole import LAWS, read

HALF = 0.5
"""Power from which an oracle is said to tell an effect."""


def limit(results: Path, parts: Sequence[tuple[Split, str]]) -> str:
    """Of the single effects at the target condition in splits and their sections of the page."""
    rows, named, told, found = [], 0, 0, 0
    for split, section in parts:
        seen, cases = stored(store_of(results, split)), {c.name: c for c in cases_of(split)}
        for s in read(results / f"{section}.json"):
            if s.group != "single" or not at_target(s) or s.name not in seen:
                continue
            found, named = found + 1, named + bool(s.place)
            told += seen[s.name].power >= HALF
            if not s.place:
                rows.append((s, cases[s.name], seen[s.name]))
    if not found:
        return ""
    unseen = sum(seen.power < HALF for _, _, seen in rows)
    said = (
        f"Measured on {found} single effects at the target condition, {named} of them named with their place: at "
        f"{100 * FALSE_ALARMS:.0f} % false alarms the oracle tells {told} in half of its tests or more. Of the "
        f"{len(rows)} that were not named it does not tell {unseen}:"
    )
    return "\n".join([*wrap(said, WIDTH), "", *_table(rows)])


def _table(rows: Sequence[tuple[Score, Case, Seen]]) -> list[str]:
    found = ["| case | hidden | the engine said | oracle: distance | told |", "|---|---|---|---|---|"]
    for score, case, seen in sorted(rows, key=lambda row: row[2].distance):
        effect = case.effects[0]
        hidden = f"{LAWS[effect.law]}, {effect.site}, {effect.value:.3g} {effect.about().unit}"
        said = score.verdict.replace("_", " ")
        found.append(f"| {score.name} | {hidden} | {said} | {seen.distance:.1f} | {100 * seen.power:.0f} % |")
    return found
