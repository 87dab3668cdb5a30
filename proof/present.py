"""The latest plan by the engine at hand: what it makes of cases most of which earlier versions have learnt from."""

from __future__ import annotations

from collections.abc import Sequence
from textwrap import wrap

from proof.runs import Run, met
from proof.shown import WIDTH
from proof.whole import by_law, together


def by_present(runs: Sequence[Run], present: str, planned: int) -> list[str]:
    """Paragraphs and tables of what runs of the engine `present` say of a plan of so many cases; none without a run
    of it that has more than first meetings."""
    own = [run for run in runs if run.engine == present]
    if not own or all(run.first for run in own):
        return []
    scores = list({s.name: s for run in own for s in run.scores}.values())
    first = met(own)
    new = (
        f"{len(first)} of them it met first, without having learnt from them"
        if first
        else "none of them for the first time"
    )
    others = "The others" if first else "All"
    said = (
        f"{len(scores)} of the plan's {planned} cases by {own[0].by}, {new}. {others} had been met before: what they "
        "taught is in it, so these figures are no measure of what it makes of machines it has not met. They say what "
        "`make proof` answers at this commit, and whether what was learnt from one case spoils another."
    )
    named = [f'"{run.section.capitalize()}"' for run in own]
    again = (
        f"Every case with what is wrong of it stands under {' and '.join(named)}; "
        f"`make proof SPLIT={own[0].split}` runs them again and says whether its answers are these."
    )
    table = together(scores, title="the engine at hand, cases it had mostly met")
    title = "#### The same plan by the engine at hand"
    return [title, "", *wrap(said, WIDTH), "", *wrap(again, WIDTH), "", table, "", *by_law(scores), ""]
