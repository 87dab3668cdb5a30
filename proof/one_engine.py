"""The split that one version of the engine runs: its tables, and how pits with a lip compare."""

from __future__ import annotations

import json
from collections.abc import Collection, Sequence
from pathlib import Path
from textwrap import wrap

from proof.effects import LIPPED
from proof.entire import ENTIRE, STRUCK, entire
from proof.score.one import Score
from proof.score.rates import MEASURES, at_target, rate
from proof.shown import WIDTH
from proof.targets import written
from proof.whole import by_law, read, together

COMMIT = "8e8edc1"
"""Whose engine ran them."""
LATER = "hearing"
"""Section of those that a later engine met first."""


def one_engine(results: Path) -> str:
    """What the page says of the split; that there is nothing where nothing is stored."""
    scores = read(results / f"{ENTIRE.split}.json")
    if not scores:
        return "None of its cases are stored."
    engine = json.loads((results / f"{ENTIRE.split}.json").read_text(encoding="utf-8"))["engine"]
    later = {s.name for s in read(results / f"{LATER}.json")}
    left = sorted({c.name for c in entire()} - {s.name for s in scores} - later)
    said = (
        f"{len(scores)} of its {sum(ENTIRE.groups.values())} cases are run, all by engine `{engine}` (commit "
        f"{COMMIT}), which had met none of them and was not changed between them. {_later(later)}{_left(left)}"
        f"`git checkout {COMMIT} && make proof` makes these figures again; a later engine's answers are held against "
        f"them case by case by `make proof CASES=...`."
    )
    return "\n".join([*wrap(said, WIDTH), "", together(scores), "", *by_law(scores), "", *wrap(lips(scores), WIDTH)])


def _later(names: Collection[str]) -> str:
    if not names:
        return ""
    return f'{len(names)} more were first met by a later engine ("{LATER.capitalize()}" below). '


def _left(names: Sequence[str]) -> str:
    if not names:
        return ""
    return (
        f"The other {len(names)} are not run yet: the names' order is drawn, so those run are a sample of the plan but "
        "for the cases that need atlases of their own (mis-set files, five speeds, another load), which were put last. "
    )


def lips(scores: Sequence[Score]) -> str:
    """Single pits at the target condition by the form of their edges."""
    forms = {c.name: {e.variant for e in c.effects if e.law in STRUCK} for c in entire() if c.group == "single"}
    single = [s for s in scores if s.group == "single" and at_target(s) and forms.get(s.name)]
    told = [
        written(rate([s for s in single if (LIPPED in forms[s.name]) is lipped], MEASURES["place"]))
        for lipped in (True, False)
    ]
    return (
        "Of single pits of bearings with edges that stand up, which no earlier case had nor the product's law has, "
        f"{told[0]} are named with their place; of the others {told[1]}."
    )
