"""What a recipe may say and hardly means: it is planned as it says, and told."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from sideband_datasets.recipe.model import Recipe
from sideband_datasets.recipe.values import Choice, Factor, Range, Value
from signals.shorthand import path_of
from sim.terms import REGISTRY


def doubtful_warnings(recipe: Recipe) -> Iterator[str]:
    """Sentences on values that others replace, and on faults of no size."""
    yield from _replaced(recipe)
    yield from _of_no_size(recipe)


def _replaced(recipe: Recipe) -> Iterator[str]:
    """A factor takes the machine's own value; anything else that is drawn for every recording replaces it."""
    anew = {path_of(key): ("conditions", value) for key, value in recipe.conditions.items()}
    for key, field in (("speed_hz", "speeds_hz"), ("torque_nm", "torques_nm")):
        value = getattr(recipe, field)
        if value is not None:
            anew[path_of(key)] = (field, value)
    for family in recipe.machines:
        for part, given in (("set", family.set), ("vary", family.vary)):
            for key in sorted(given):
                by, value = anew.get(path_of(key), ("", None))
                if by and not isinstance(value, Factor):
                    yield f"`{part}` of machines {family.name} has no effect on {key}: `{by}` replaces it"


def _of_no_size(recipe: Recipe) -> Iterator[str]:
    for fault in recipe.faults:
        for wanted in fault.terms:
            term = REGISTRY.get(wanted.term)
            size = term.severity if term is not None else None
            if size is not None and _may_be_zero(wanted.parameters.get(size), factorial=recipe.plan == "factorial"):
                yield f"class {fault.name}: {wanted.term} of {size} 0 is labelled as a fault all the same"


def _may_be_zero(value: Value | None, *, factorial: bool) -> bool:
    """Whether zero is among what is drawn: of a range its levels in a factorial plan, else neither of its ends."""
    if isinstance(value, Choice):
        return any(item == 0 and item is not False for item in value.choices)
    if isinstance(value, Range):
        between = factorial and value.scale == "linear"
        levels = np.linspace(value.low, value.high, value.levels) if between else np.array([value.low, value.high])
        return bool(np.any(levels == 0.0)) and (between or value.low == value.high)
    return isinstance(value, (int, float)) and not isinstance(value, bool) and value == 0
