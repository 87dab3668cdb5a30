"""What the card says that every machine of a family has: drawing, settings, effects, profile of the speed."""

from __future__ import annotations

from collections.abc import Iterator

from sideband_datasets.plan.machines import base_machine
from sideband_datasets.recipe.model import Machines, Recipe
from sim.core.spec import MachineSpec

HEAD = ("machines", "what all of them have")


def held(recipe: Recipe) -> Iterator[tuple[str, str]]:
    """(family, words) in the order of the recipe."""
    for number, family in enumerate(recipe.machines):
        machine = base_machine(family, number)
        yield family.name, "; ".join([_drawing(family), *_settings(family), *_effects(machine), *_profile(machine)])


def _drawing(family: Machines) -> str:
    return f"preset `{family.preset}`" if family.preset is not None else "a drawing of the recipe's own"


def _settings(family: Machines) -> Iterator[str]:
    yield from (f"`{key}` {value}" for key, value in family.set.items() if "@" not in key)


def _effects(machine: MachineSpec) -> Iterator[str]:
    for term in machine.terms:
        sizes = ", ".join(f"{name} {value:g}" for name, value in term.parameters.items())
        yield f"`{term.term}@{term.site}`" + (f" ({sizes})" if sizes else "")


def _profile(machine: MachineSpec) -> Iterator[str]:
    profile = machine.operating.profile if machine.operating is not None else None
    if profile is not None:
        told = ", ".join(
            f"{name} {value}" for name, value in profile.model_dump().items() if not isinstance(value, list)
        )
        yield f"speed profile: {told}; `speed_hz` of a row is that of its window"
