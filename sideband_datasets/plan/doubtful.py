"""What a recipe may say and hardly means: it is planned as it says, and told."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from sideband_datasets.plan.axes import drawn_only, machine_axes
from sideband_datasets.plan.machines import base_machine
from sideband_datasets.recipe.model import Recipe
from sideband_datasets.recipe.values import Choice, Factor, Range, Value, ends_of
from signals.shorthand import path_of
from sim.core.spec.operating import RampSpeed
from sim.terms import REGISTRY

ALIKE = 1e-3
"""Share of a number within which two machines are one to a classifier."""

STEADY = 0.01
"""Range of the speed in a window, relative to nominal, above which a line has no one frequency in it."""


def doubtful_warnings(recipe: Recipe) -> Iterator[str]:
    """Sentences on values that others replace, and on faults of no size."""
    yield from _replaced(recipe)
    yield from _of_no_size(recipe)
    yield from _nearly_one(recipe)
    yield from _unsteady(recipe)


def _nearly_one(recipe: Recipe) -> Iterator[str]:
    """Machines of several splits that differ by next to nothing are one machine heard in all of them."""
    for number, family in enumerate(recipe.machines):
        varied = drawn_only([axis for axis in machine_axes(recipe, number) if axis.field.startswith("machines.")])
        if len(recipe.splits) > 1 and family.instances > 1 and varied and all(_narrow(a.value) for a in varied):
            yield (
                f"machines {family.name} differ by less than {ALIKE:.1%} in everything that varies: to a classifier "
                "they are one machine, which stands in several splits"
            )


def _unsteady(recipe: Recipe) -> Iterator[str]:
    """Ramps smear lines over a window, so nothing is labelled in it."""
    for number, family in enumerate(recipe.machines):
        operating = base_machine(family, number).operating
        profile = operating.profile if operating is not None else None
        if recipe.peaks.spectra and isinstance(profile, RampSpeed) and abs(profile.end_ratio - 1.0) > STEADY:
            yield (
                f"machines {family.name} change speed while they are recorded: windows in which it changes by over "
                f"{STEADY:.0%} have no labelled peaks"
            )


def _narrow(value: Value) -> bool:
    if isinstance(value, Choice):
        return len(set(value.choices)) == 1
    if not isinstance(value, Range | Factor):
        return True
    low, high = ends_of(value)
    return high - low <= ALIKE * max(abs(low), abs(high))


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
