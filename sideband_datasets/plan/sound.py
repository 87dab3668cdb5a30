"""Whether what a recipe calls sound is sound: no machine of it may have damage that no label tells of."""

from __future__ import annotations

from collections.abc import Iterator

from sideband_datasets.plan.machines import base_machine
from sideband_datasets.recipe.model import DAMAGE_STANDS, IN_ALL, Recipe
from sim.core.errors import Problem, SpecError
from sim.terms import REGISTRY


def check_sound(recipe: Recipe) -> None:
    """SpecError lists the defects of families' drawings, of whatever size: their rows would be labelled healthy."""
    problems = [problem for number in range(len(recipe.machines)) for problem in _damage(recipe, number)]
    if problems:
        raise SpecError(problems)


def _damage(recipe: Recipe, number: int) -> Iterator[Problem]:
    family = recipe.machines[number]
    for k, term in enumerate(base_machine(family, number).terms):
        known = REGISTRY.get(term.term)
        if known is not None and known.damages:
            part = f"machine.terms.{k}" if family.machine is not None else "preset"
            given = f"{term.term}@{term.site}"
            yield Problem(field=f"machines.{number}.{part}", message=IN_ALL, given=given, allowed=DAMAGE_STANDS)


def ordinary_warnings(recipe: Recipe) -> Iterator[str]:
    """Sentences on effects of a class that sound machines have too, as an unbalance: told apart by size alone."""
    for number, family in enumerate(recipe.machines):
        keys = [key for key in (*family.set, *family.vary, *recipe.conditions) if "@" in key]
        own = {t.term for t in base_machine(family, number).terms} | {key.split("@", maxsplit=1)[0] for key in keys}
        yield from _untold(recipe, family.name, own)
        for fault in recipe.faults:
            shared = sorted({t.term for t in fault.terms} & own)
            if shared:
                yield (
                    f"machines {family.name} have {', '.join(shared)} of their own, in healthy recordings too: class "
                    f"{fault.name} differs by the size alone, and replaces it where both act at one part"
                )


def _untold(recipe: Recipe, name: str, own: set[str]) -> Iterator[str]:
    """Play, looseness, bends and forces of one's own that no class tells of."""
    told = {t.term for fault in recipe.faults for t in fault.terms}
    worn = [key for key in sorted(own - told) if (term := REGISTRY.get(key)) is not None and term.wear]
    if worn:
        yield (
            f"machines {name} have {', '.join(worn)} in all recordings, and no class tells of it: healthy ones hold it "
            "too, which is right only of sizes that a sound machine has"
        )
