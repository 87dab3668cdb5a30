"""Every machine of a plan built once, one after the other: what of them is asked for is kept, the machines are not."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from sideband_datasets.plan.documents import value_in
from sideband_datasets.plan.machines import Machine
from sideband_datasets.plan.quotas import IntArray
from sideband_datasets.recipe.model import Recipe
from sideband_datasets.recipe.values import Choice
from signals.shorthand import path_of


@dataclass(frozen=True, kw_only=True, slots=True)
class Known:
    """What tells a machine and its transfer paths from others: see `Machine`."""

    machine_id: str
    measurement: int | None
    content: str
    channel_paths: Mapping[str, str]


@dataclass(frozen=True, kw_only=True)
class Walk:
    """`known`: of each machine; `named`: the first machine, by its number, that has each of the names which are chosen
    among (a bearing, say), with the recipe's field, family after family."""

    known: Sequence[Known]
    named: Sequence[tuple[str, int]]


def known_of(machine: Machine) -> Known:
    """What is kept of a machine."""
    return Known(
        machine_id=machine.machine_id,
        measurement=machine.measurement,
        content=machine.content,
        channel_paths=machine.channel_paths,
    )


def walked(recipe: Recipe, machines: Iterable[Machine], family: IntArray) -> Walk:
    """All machines of a plan; `family`: number of each one's family, shape (machines,). SpecError for the first that
    cannot be built."""
    texts = [_texts(recipe, number) for number in range(len(recipe.machines))]
    seen: list[set[tuple[str, object]]] = [set() for _ in texts]
    named: list[list[tuple[str, int]]] = [[] for _ in texts]
    known = []
    for number, machine in enumerate(machines):
        known.append(known_of(machine))
        own = int(family[number])
        if not texts[own]:
            continue
        document = machine.spec.model_dump(mode="json")
        new = {(path, value_in(document, path_of(path))) for path in texts[own]} - seen[own]
        if new:
            seen[own] |= new
            named[own].append((f"machines.{own}.vary.{min(new, key=str)[0]}.choices", number))
    return Walk(known=known, named=[one for of_family in named for one in of_family])


def _texts(recipe: Recipe, family: int) -> list[str]:
    """Where one name of a list is drawn: numbers of a range are alike, but one name may be wrong."""
    return [
        path
        for path, value in recipe.machines[family].vary.items()
        if isinstance(value, Choice) and any(isinstance(item, str) for item in value.choices)
    ]
