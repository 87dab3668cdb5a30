"""What the card says was added to the motion of the model, and which recordings were left out."""

from __future__ import annotations

from collections.abc import Iterator

from sideband_datasets.recipe.background import Background
from sideband_datasets.recipe.model import Recipe
from sideband_datasets.recipe.values import Choice, Factor, Range, Value
from sim.core.spec import SpecModel

ADDED = """\
Added to the simulated accelerations, because a model of rigid contacts lacks it; drawn once a machine, so no class has
more of it than another. A level is the RMS acceleration of the same machine without the fault, times `level`."""
SOURCES = {
    "rolling": "noise of rough surfaces, following load and passing balls (Antoni & Randall 2003)",
    "knocks": "impulses at random times",
    "neighbours": "regular impulses of something else",
    "free_axis": "a ball whose axis is free: its spin slips, its spall leaves the track for a while",
}
SIBLINGS = "Every machine was recorded once in each class; these recordings differ by the fault alone."


def range_text(value: Value) -> str:
    """A value of a recipe in words."""
    if isinstance(value, Range):
        return f"{value.low:g} to {value.high:g}" + (" (logarithmic)" if value.scale == "log" else "")
    if isinstance(value, Factor):
        return f"{value.factor[0]:g} to {value.factor[1]:g} times its own"
    if isinstance(value, Choice):
        return "one of " + ", ".join(str(item) for item in value.choices)
    return str(value)


def added(recipe: Recipe) -> str:
    """Paragraphs for the card; nothing for a recipe without background, siblings and choice of recordings."""
    parts = []
    if recipe.background is not None:
        parts.append("## What was added\n\n" + ADDED)
        parts.append("\n".join(f"* {line}" for line in _ingredients(recipe.background)))
    if recipe.siblings:
        parts.append(SIBLINGS)
    if recipe.shown_db is not None:
        parts.append(
            "A faulty recording is left out, and listed in `failures.jsonl`, unless its fault adds "
            f"{recipe.shown_db:g} dB to the same machine without it in one of sixteen bands of a channel."
        )
    return "\n\n".join(parts)


def _ingredients(block: Background) -> Iterator[str]:
    yield f"level: {range_text(block.level)}"
    for name, sentence in SOURCES.items():
        found = getattr(block, name)
        if isinstance(found, SpecModel):
            values = {key: getattr(found, key) for key in type(found).model_fields}
            share = values.pop("share")
            told = "; ".join(f"{key} {range_text(value)}" for key, value in values.items())
            yield f"{name}, in a share of {share:g} of the machines: {sentence}. {told}"
    if block.chain_in_levels:
        yield "noise, hum, limits and ranges of the measurement chain are multiples of the level"
