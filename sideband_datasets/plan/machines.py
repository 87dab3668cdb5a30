"""The machines of a dataset: each drawn once, with its sensors and its transfer path."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

from pydantic import ValidationError

from sideband_datasets.plan.axes import Axis, drawn_only, levels, machine_axes
from sideband_datasets.plan.documents import holders, value_in
from sideband_datasets.plan.identity import channel_paths, content_of, path_id_of
from sideband_datasets.plan.most import check_drawn
from sideband_datasets.plan.points import Points
from sideband_datasets.plan.seeds import Stream, whole_seed
from sideband_datasets.recipe.model import Machines, Recipe
from sideband_datasets.recipe.values import Drawn, drawn
from signals.copied import copied
from signals.overrides import apply_overrides
from signals.sensors import SensorChain
from signals.series import FloatArray
from signals.shorthand import path_of
from signals.validation import problems_of
from sim.core.errors import Problem, SpecError, UnknownName
from sim.core.near import did_you_mean
from sim.core.spec import MachineSpec
from sim.presets import preset

Document = dict[str, Any]


@dataclass(frozen=True, kw_only=True)
class Machine:
    """One machine of a family, sound, at the family's operating point; `chain` is the document of its sensors.

    `content` is a hash of what it is built of, `channel_paths` has one of each channel's transfer path by the channel's
    name: equal ones are one machine, one path. `path_id` stands for all the paths together.
    """

    machine_id: str
    family: str
    spec: MachineSpec
    measurement: int | None
    chain: Document | None
    content: str
    channel_paths: Mapping[str, str]
    path_id: str
    seed: int


@contextmanager
def told_as(field: str) -> Iterator[None]:
    """Problems of changes (`set.KEY`) raised inside carry the name `field.KEY` of the recipe."""
    try:
        yield
    except SpecError as error:
        found = [
            replace(p, field=f"{field}.{p.field.removeprefix('set.').removeprefix(f'{field}.')}")
            for p in error.problems
        ]
        raise SpecError(found) from error


def base_machine(family: Machines, number: int) -> MachineSpec:
    """What all of a family have in common."""
    try:
        machine = preset(family.preset) if family.preset is not None else family.machine
    except UnknownName as error:
        message = f"is no ready machine{did_you_mean(error.name, error.known)}"
        problem = Problem(field=f"machines.{number}.preset", message=message, given=error.name,
                          allowed=", ".join(error.known))  # fmt: skip
        raise SpecError(problem) from error
    assert machine is not None
    with told_as(f"machines.{number}.set"):
        return apply_overrides(machine, family.set)


def values_at(axes: tuple[Axis, ...], point: FloatArray, own: Mapping[str, object]) -> dict[str, Drawn]:
    """Every axis' value at a point of the drawn ones."""
    free = {axis.key: float(share) for axis, share in zip(drawn_only(axes), point, strict=True)}
    return {a.key: drawn(a.value, free.get(a.key, 0.0), own.get(a.key), a.field) for a in axes}


def part(values: Mapping[str, Drawn], prefix: str) -> dict[str, Drawn]:
    """Values whose key begins with `prefix:`, without it."""
    head = f"{prefix}:"
    return {key.removeprefix(head): value for key, value in values.items() if key.startswith(head)}


def chain_document(recipe: Recipe, number: int) -> Document:
    """A chain with every stage of its sensors written out; SpecError names its wrong fields."""
    field = f"measurement.{number}.chain"
    try:
        chain = SensorChain.model_validate(recipe.measurement[number].chain)
    except ValidationError as error:
        raise SpecError(problems_of(error, prefix=field, model=SensorChain)) from error
    return chain.model_dump(mode="json")


def with_values(document: Document, values: Mapping[str, object], field: str) -> Document:
    """A copy of a chain's document with values put in by path."""
    changed: Document = copied(document)
    for path, value in values.items():
        for holder, name in holders(changed, path, f"{field}.{path}"):
            holder[name] = value
    return changed


def _own_values(axes: tuple[Axis, ...], base: MachineSpec, chains: Sequence[Document]) -> dict[str, object]:
    document = base.model_dump(mode="json")
    own: dict[str, object] = {}
    for axis in axes:
        head, _, key = axis.key.partition(":")
        if head == "machine":
            own[axis.key] = value_in(document, path_of(key))
        elif head.startswith("chain.") and key:
            found = list(holders(chains[int(head.removeprefix("chain."))], key, axis.field))
            own[axis.key] = found[0][0].get(found[0][1]) if found else None
    return own


def machine_id_of(family: str, instance: int) -> str:
    """Name of machine `instance` of a family."""
    return f"{family}-{instance:04d}"


@dataclass(frozen=True, kw_only=True)
class Family:
    """What the machines of a family are built from: any of them alone, whenever it is wanted.

    `own`: what the base has where something is drawn; `chains`: documents of all chains of the recipe.
    """

    recipe: Recipe
    number: int
    base: MachineSpec
    axes: tuple[Axis, ...]
    own: Mapping[str, object]
    chains: Sequence[Document]

    @cached_property
    def points(self) -> FloatArray:
        """What was drawn for each machine, shape (instances, drawn axes), each from 0 to 1."""
        return Points(
            # Machines are a sample of a population: levels would build the same one again.
            kind="latin_hypercube" if self.recipe.plan == "factorial" else self.recipe.plan,
            levels=levels(drawn_only(self.axes)),
            count=self.recipe.machines[self.number].instances,
            seed=self.recipe.seed,
            stream=Stream.FAMILY,
            number=self.number,
        ).table()

    def built(self, instance: int) -> Machine:
        """Machine `instance`, a pure function of the recipe and the two numbers; SpecError when it cannot be built."""
        recipe, name = self.recipe, self.recipe.machines[self.number].name
        values = values_at(self.axes, self.points[instance], self.own)
        with told_as(f"machines.{self.number}.vary"):
            spec = apply_overrides(self.base, part(values, "machine"))
        chosen, chain = None, None
        if recipe.measurement:
            chosen = [m.name for m in recipe.measurement].index(str(values["chain"]))
            own = part(values, f"chain.{chosen}")
            chain = with_values(self.chains[chosen], own, f"measurement.{chosen}.vary")
        machine_id = machine_id_of(name, instance)
        return Machine(
            machine_id=machine_id,
            family=name,
            spec=spec,
            measurement=chosen,
            chain=chain,
            content=content_of(spec, recipe.conditions),
            channel_paths=channel_paths(chain),
            path_id=path_id_of(machine_id, chain),
            seed=whole_seed(recipe.seed, Stream.MACHINE, self.number, instance),
        )


def families_of(recipe: Recipe) -> list[Family]:
    """All families, none of their machines built; SpecError for a base or a chain that cannot be, and for more
    machines than may be built."""
    bases = [base_machine(family, number) for number, family in enumerate(recipe.machines)]
    chains = [chain_document(recipe, k) for k in range(len(recipe.measurement))]
    every = [machine_axes(recipe, number) for number in range(len(bases))]
    longest = max((len(str(chain)) for chain in chains), default=0)
    check_drawn(recipe, every, [len(base.model_dump_json()) + longest for base in bases])
    found = []
    for number, (base, axes) in enumerate(zip(bases, every, strict=True)):
        own = _own_values(axes, base, chains)
        found.append(Family(recipe=recipe, number=number, base=base, axes=axes, own=own, chains=chains))
    return found
