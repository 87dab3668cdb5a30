"""What a recipe may say and hardly means: it is planned as it says, and told."""

from __future__ import annotations

from collections.abc import Iterator

from sideband_datasets.recipe.model import Recipe
from sideband_datasets.recipe.values import Choice, Factor, Value
from sim.terms import REGISTRY


def doubtful_warnings(recipe: Recipe) -> Iterator[str]:
    """Sentences on values that others replace, and on faults of no size."""
    yield from _replaced(recipe)
    yield from _of_no_size(recipe)


def _replaced(recipe: Recipe) -> Iterator[str]:
    """A factor takes the machine's own value; anything else of `conditions` replaces it in every recording."""
    anew = {key for key, value in recipe.conditions.items() if not isinstance(value, Factor)}
    for family in recipe.machines:
        for part, given in (("set", family.set), ("vary", family.vary)):
            for key in sorted(anew & set(given)):
                yield f"`{part}` of machines {family.name} has no effect on {key}: `conditions` replaces it"


def _of_no_size(recipe: Recipe) -> Iterator[str]:
    for fault in recipe.faults:
        for wanted in fault.terms:
            term = REGISTRY.get(wanted.term)
            size = term.severity if term is not None else None
            if size is not None and _may_be_zero(wanted.parameters.get(size)):
                yield f"class {fault.name}: {wanted.term} of {size} 0 is labelled as a fault all the same"


def _may_be_zero(value: Value | None) -> bool:
    """Whether zero is among what is drawn; the end of a range is not drawn."""
    if isinstance(value, Choice):
        return any(item == 0 and item is not False for item in value.choices)
    return isinstance(value, (int, float)) and not isinstance(value, bool) and value == 0
