"""How many machines a recipe may ask for: each is built once, so that none is found wrong later."""

from __future__ import annotations

from collections.abc import Iterator

from sideband_datasets.plan.axes import Axis, drawn_only
from sideband_datasets.recipe.model import Recipe
from sim.core.errors import Problem, SpecError

MOST_MACHINES = 10_000
"""Of all families together; one of a small machine takes 0.3 ms."""
MOST_DRAWN = 500_000
"""Values drawn for all machines: 6 us each, and the numbers are kept."""
MOST_DESCRIBED = 50_000_000
"""Characters of the descriptions of all machines with their chains: 0.1 us each."""
MOST_KINDS = 500
"""Classes times families: one recording of each is put together, 20 ms or so each."""


def counted_problems(recipe: Recipe) -> Iterator[Problem]:
    """Problems that the numbers of the recipe tell alone."""
    machines = sum(family.instances for family in recipe.machines)
    if machines > MOST_MACHINES:
        allowed = f"{MOST_MACHINES} `instances` or fewer in all"
        yield Problem(field="machines", message="are too many to be built", given=machines, allowed=allowed)
    kinds = len(recipe.machines) * len(recipe.classes)
    if kinds > MOST_KINDS:
        allowed = f"{MOST_KINDS} or fewer classes times families"
        message = f"of {len(recipe.classes)} classes and {len(recipe.machines)} families are too many kinds to be tried"
        yield Problem(field="faults", message=message, given=kinds, allowed=allowed)


def check_drawn(recipe: Recipe, axes: list[tuple[Axis, ...]], sizes: list[int]) -> None:
    """SpecError where machines together take too long to be built.

    `axes`: of each family; `sizes`: characters of the description of one of its machines, with its longest chain.
    """
    counts = [family.instances for family in recipe.machines]
    drawn = [count * len(drawn_only(own)) for count, own in zip(counts, axes, strict=True)]
    described = [count * size for count, size in zip(counts, sizes, strict=True)]
    problems = []
    for found, most, what in ((drawn, MOST_DRAWN, "values drawn"), (described, MOST_DESCRIBED, "characters described")):
        if sum(found) > most:
            field = f"machines.{max(range(len(found)), key=found.__getitem__)}.instances"
            message = f"makes machines of {sum(found)} {what} in all; {most} are allowed"
            given = sum(counts)
            allowed = f"{given * most // sum(found)} or fewer `instances` in all, or machines with less in them"
            problems.append(Problem(field=field, message=message, given=given, allowed=allowed))
    if problems:
        raise SpecError(problems)
