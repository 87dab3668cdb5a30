"""The splits that one version of the engine runs each: their tables, and how pits with a lip compare."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from textwrap import wrap

import numpy as np

from proof.effects import LIPPED
from proof.entire import (
    BAKER,
    CHANDLER,
    DYER,
    ENGRAVER,
    ENTIRE,
    HELD,
    INQUEST,
    JURY,
    MIXED,
    STRUCK,
    TWELFTH,
    VAST,
    WIDE,
    XENIAL,
    YOUNG,
    ZENITH,
    Design,
    cases_of_design,
)
from proof.entire import CLEAR as SEVENTH
from proof.plan import Case
from proof.present import by_present
from proof.runs import Run, every_run, met
from proof.score.one import Score
from proof.score.rates import MEASURES, at_target, rate
from proof.shown import WIDTH
from proof.targets import written
from proof.visible import Visible, stored
from proof.whole import by_law, together

FAR_OFF = 0.74
"""Error of a size, as a share of it."""
CLEAR = 3.0
"""Times as far as drift, from which there is much to see."""
DESIGNS = (
    ENGRAVER, DYER, CHANDLER, BAKER, TWELFTH, XENIAL, ZENITH, INQUEST, JURY, SEVENTH, VAST, YOUNG, MIXED, WIDE, HELD,
    ENTIRE,
)  # fmt: skip
"""The splits, the latest first."""


def one_engine(results: Path, present: str) -> str:
    """What the page says of the splits that one engine ran each, the latest first; `present`: the engine at hand."""
    every = every_run(results)
    of = {design.split: [run for run in every if run.split == design.split] for design in DESIGNS}
    told = "\n".join(wrap(of_sizes([s for runs in of.values() for s in met(runs)]), WIDTH))
    parts = [_of(d, of[d.split], results, at_hand(every, present) if d is DESIGNS[0] else "") for d in DESIGNS]
    latest = DESIGNS[0]
    parts[0] = "\n".join([parts[0], "", *by_present(of[latest.split], present, len(cases_of_design(latest)))]).rstrip(
        "\n"
    )
    return "\n\n".join([*parts, *([told] if told else [])])


def at_hand(runs: Sequence[Run], present: str) -> str:
    """Whether a stored run is of the engine at hand."""
    own = [f'"{run.section.capitalize()}"' for run in runs if run.engine == present]
    if own:
        return f"Of the engine at hand when this page was written {_are(len(own))} {', '.join(own)} alone. "
    return "No stored run is of the engine at hand when this page was written: it has changed since each of them. "


def _are(count: int) -> str:
    return "is" if count == 1 else "are"


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


def _of(design: Design, runs: Sequence[Run], results: Path, before: str) -> str:
    title = f"### {TITLES[design.split]}: split `{design.split}`"
    run = next((run for run in runs if run.section == design.split and run.scores), None)
    if run is None:
        return f"{title}\n\nNone of its cases are stored."
    cases = cases_of_design(design)
    others = [other for other in runs if other.first and other is not run]
    wider = met(runs) if others else []
    left = {c.name for c in cases} - {s.name for one in (run, *others) for s in one.scores}
    said = f"{_by_one(run, len(cases))}{_by_others(run, others, len(wider))}{LEFT[design.split] if left else ''}"
    first = [*wrap(before, WIDTH), ""] if before else []
    seen = seen_singles(run.scores, stored(results / f"visible-{design.split}.json"))
    pairs = seen_pairs(run.scores, stored(results / f"visible-{design.split}.json"))
    told = wrap(f"{lips(run.scores, cases)}{seen}{pairs}", WIDTH)
    table = together(run.scores, wider)
    parts = [title, "", *first, *wrap(said, WIDTH), "", *_again(run), "", table, "", *by_law(run.scores), "", *told]
    return "\n".join(parts)


def _by_one(run: Run, count: int) -> str:
    """Which cases the one engine ran, and whether it met them first."""
    lost = sum(s.failed for s in run.scores)
    ended = f" ({lost} of them came to no end and {_are(lost)} wrong in all that applies)" if lost else ""
    of = f"{len(run.scores)} of the plan's {count} cases{ended} are"
    if run.first:
        met_none = "which had met none of them and was not changed between them"
        return f"{of} run by one engine, {run.by}, {met_none}. "
    return (
        f"{of} stored, by engine {run.by}. This is not stored as their first run: an engine may have met them, and "
        "learnt from them, before. "
    )


def _by_others(run: Run, others: Sequence[Run], count: int) -> str:
    """Which cases other runs met first, and how the figures of all stand beside those of the one engine."""
    if not others:
        return ""
    more = [
        f"{len(o.scores)} more were first met by {'it' if o.engine == run.engine else f'another engine, {o.by}'} "
        f'("{o.section.capitalize()}" below). '
        for o in others
    ]
    engines = len({one.engine for one in (run, *others) if one.first})
    by = f"{engines} engines" if engines > 1 else "one engine"
    return (
        f"{''.join(more)}The columns on the right are of all {count} stored first runs of this plan together, by {by}; "
        f"all other figures here are of {run.by} alone. "
    )


def _again(run: Run) -> list[str]:
    """How the figures are made again, and how the engine at hand is held against them."""
    command = f"make proof SPLIT={run.split} CASES={','.join(s.name for s in run.scores)}"
    first = f"These {len(run.scores)} cases again, by that engine, with their rates and what is wrong of each:"
    made = [first, "", "```sh", f"git checkout {run.commit} && {command}", "```", ""]
    held = (
        f"`make proof SPLIT={run.split}` runs all cases of the split by the engine at hand and says, case by case, "
        "which of its answers are those stored; it replaces none."
    )
    return [*(made if run.commit else []), *wrap(held, WIDTH)]


TITLES = {
    "engraver": "The latest plan",
    "dyer": "The plan before",
    "chandler": "The one before that",
    "baker": "An older one",
    "twelfth": "One older than that",
    "xenial": "One before those",
    "zenith": "An older plan",
    "inquest": "One before that plan",
    "jury": "A yet older plan",
    "clear": "Before that one",
    "vast": "One more before",
    "young": "One further back",
    "mixed": "Another before",
    "wide": "A plan before",
    "held": "An engine before",
    "entire": "An earlier engine",
}
NOT_YET = "The others are not run yet: the names' order is drawn, so those run are a sample of the plan. "
LEFT = {
    "engraver": NOT_YET,
    "dyer": NOT_YET,
    "chandler": NOT_YET,
    "baker": NOT_YET,
    "twelfth": "The one that is not run, tw002, is at a lower load, which needs an atlas of its own. ",
    "xenial": NOT_YET,
    "zenith": NOT_YET,
    "inquest": NOT_YET,
    "jury": NOT_YET,
    "clear": NOT_YET,
    "vast": NOT_YET,
    "young": NOT_YET,
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


def seen_pairs(scores: Sequence[Score], seen: Mapping[str, Visible]) -> str:
    """Pairs at the target condition by how far the fainter effect moves what the other shows; empty where that is not
    stored of all."""
    pairs = [s for s in scores if s.group == "double" and at_target(s)]
    if not pairs or any(s.name not in seen or not seen[s.name].parts_db for s in pairs):
        return ""
    far = [s for s in pairs if min(seen[s.name].parts_db) >= CLEAR * seen[s.name].drift_db]
    rest = [s for s in pairs if s not in far]
    told = [f"{sum(bool(s.both) for s in part)} of {len(part)}" for part in (far, rest)]
    return (
        f" Of pairs of which each moves what the other shows so far {told[0]} are named whole; of the others {told[1]}."
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
