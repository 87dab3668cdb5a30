"""The splits that one version of the engine runs each: their tables, and how pits with a lip compare."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from textwrap import wrap

import numpy as np

from proof.effects import LIPPED
from proof.entire import ENTIRE, HELD, MIXED, STRUCK, WIDE, Design, cases_of_design
from proof.plan import Case
from proof.score.one import Score
from proof.score.rates import MEASURES, at_target, rate
from proof.shown import WIDTH
from proof.targets import written
from proof.visible import Visible, stored
from proof.whole import by_law, read, together

FAR_OFF = 0.74
"""Error of a size, as a share of it."""
CLEAR = 3.0
"""Times as far as drift, from which there is much to see."""
COMMITS: Mapping[str, str] = {"mixed": "6b73d6fa", "wide": "9c93d3ef", "held": "919f12b", "entire": "8e8edc1"}
"""Whose engine ran each of the splits."""
ELSEWHERE: Mapping[str, tuple[str, str]] = {
    "mixed": ("resumed", "a later"), "held": ("begun", "an earlier"), "entire": ("hearing", "a later"),
}  # fmt: skip
"""Section of those cases of a split that another engine met first, and which."""
RUN_BY_ONE = ("mixed", "resumed", "wide", "held", "begun", "hearing", "entire")
"""Sections of these splits' cases."""


def one_engine(results: Path) -> str:
    """What the page says of the splits that one engine ran each, the latest first."""
    every = [s for name in RUN_BY_ONE for s in read(results / f"{name}.json")]
    told = "\n".join(wrap(of_sizes(every), WIDTH))
    return "\n\n".join([*(_of(design, results) for design in (MIXED, WIDE, HELD, ENTIRE)), *([told] if told else [])])


def of_sizes(scores: Sequence[Score]) -> str:
    """Of all cases of these splits, at all conditions: how far sizes are off, and how often placebos gain."""
    errors = [s.severity_error for s in scores if s.severity_error is not None]
    placebos = [s.placebo_improves for s in scores if s.placebo_improves is not None]
    if not errors or not placebos:
        return ""
    held = sum(s.severity_covered is True for s in scores)
    middle, last = (100.0 * float(np.quantile(errors, share)) for share in (0.5, 0.9))
    far = 100.0 * float(np.mean(np.array(errors) >= FAR_OFF))
    return (
        f"Of the {len(scores)} cases of these splits, whichever engine met them first, {len(errors)} sizes were told: "
        f"half are within {middle:.0f} %, {far:.0f} % are off by {100 * FAR_OFF:.0f} % or more, one in ten by "
        f"{last:.0f} %; {held} of their intervals hold the truth. In {sum(placebos)} of {len(placebos)} cases the "
        "median placebo gains more than 0.05."
    )


def _of(design: Design, results: Path) -> str:
    title = f"### {TITLES[design.split]}: split `{design.split}`"
    path = results / f"{design.split}.json"
    scores = read(path)
    if not scores:
        return f"{title}\n\nNone of its cases are stored."
    engine, commit = json.loads(path.read_text(encoding="utf-8"))["engine"], COMMITS[design.split]
    section, other = ELSEWHERE.get(design.split, ("", ""))
    elsewhere = {s.name for s in read(results / f"{section}.json")} if section else set()
    cases = cases_of_design(design)
    left = {c.name for c in cases} - {s.name for s in scores} - elsewhere
    more = f'{len(elsewhere)} more were first met by {other} engine ("{section.capitalize()}" below). '
    said = (
        f"{len(scores)} of its {len(cases)} cases are run, all by engine `{engine}` (commit {commit}), which had met "
        f"none of them and was not changed between them. {more if elsewhere else ''}"
        f"{LEFT[design.split] if left else ''}"
        f"`git checkout {commit} && make proof SPLIT={design.split}` makes these figures again; a later engine's "
        f"answers are held against them case by case by `make proof SPLIT={design.split} CASES=...`."
    )
    seen = seen_singles(scores, stored(results / f"visible-{design.split}.json"))
    told = wrap(f"{lips(scores, cases)}{seen}", WIDTH)
    return "\n".join([title, "", *wrap(said, WIDTH), "", together(scores), "", *by_law(scores), "", *told])


TITLES = {
    "mixed": "The latest engine",
    "wide": "The latest plan that is run whole",
    "held": "An engine before",
    "entire": "An earlier engine",
}
NOT_YET = "The others are not run yet: the names' order is drawn, so those run are a sample of the plan. "
LEFT = {
    "mixed": NOT_YET,
    "wide": NOT_YET,
    "held": NOT_YET,
    "entire": "The others are not run: the names' order is drawn, so those run are a sample of the plan but for the "
    "cases that need atlases of their own (mis-set files, five speeds, another load), which were put last. ",
}


def seen_singles(scores: Sequence[Score], seen: Mapping[str, Visible]) -> str:
    """Single effects at the target condition by how far they move the spectrum; empty where it is not stored of all."""
    single = [s for s in scores if s.group == "single" and at_target(s)]
    if not single or any(s.name not in seen for s in single):
        return ""
    far = [s for s in single if seen[s.name].effect_db >= CLEAR * seen[s.name].drift_db]
    told = [written(rate(part, MEASURES["place"])) for part in (far, [s for s in single if s not in far])]
    return (
        f" Of single effects at the target condition that move the spectrum three times as far as drift or more "
        f"{told[0]} are named with their place; of the others {told[1]} (`python -m proof visible`)."
    )


def lips(scores: Sequence[Score], cases: Sequence[Case]) -> str:
    """Single pits at the target condition by the form of their edges."""
    forms = {c.name: {e.variant for e in c.effects if e.law in STRUCK} for c in cases if c.group == "single"}
    single = [s for s in scores if s.group == "single" and at_target(s) and forms.get(s.name)]
    told = [
        written(rate([s for s in single if (LIPPED in forms[s.name]) is lipped], MEASURES["place"]))
        for lipped in (True, False)
    ]
    return (
        "Of single pits of bearings with edges that stand up, which the product's law has not, "
        f"{told[0]} are named with their place; of the others {told[1]}."
    )
