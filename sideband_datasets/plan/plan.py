"""The plan of a dataset: which machine, class, operating point, seed and split each recording has."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from sideband_datasets.plan.apart import check_apart
from sideband_datasets.plan.axes import drawn_only, levels, recording_axes
from sideband_datasets.plan.check import channels_of, check_recipe, confounded_warnings, split_warnings
from sideband_datasets.plan.doubtful import doubtful_warnings
from sideband_datasets.plan.ends import check_ends
from sideband_datasets.plan.machines import Machine, families_of, machine_id_of
from sideband_datasets.plan.points import Points
from sideband_datasets.plan.population import Population
from sideband_datasets.plan.quotas import IntArray, interleaved, quotas, ranks
from sideband_datasets.plan.seeds import Stream, generator
from sideband_datasets.plan.sound import check_sound, ordinary_warnings
from sideband_datasets.plan.walk import walked
from sideband_datasets.recipe.model import Recipe
from sim.core.errors import Problem, SpecError


@dataclass(frozen=True, kw_only=True)
class Plan:
    """Everything is a pure function of the recipe; arrays have shape (recordings,).

    `kind`: number of the class, 0 healthy; `rank`: how many of that class come before, its point of the class' plan;
    `machine`: number in `machines`, which are built when they are asked for; `split_of`, `family`, `instance`: numbers
    of each machine's split and family, and its own in the family, shape (machines,).
    """

    recipe: Recipe
    machines: Sequence[Machine]
    family: IntArray
    instance: IntArray
    splits: tuple[str, ...]
    split_of: IntArray
    kind: IntArray
    rank: IntArray
    machine: IntArray
    channels: int
    """Rows that each window gives."""
    warnings: tuple[str, ...]

    @property
    def rows_per_recording(self) -> int:
        """Windows times channels."""
        return self.recipe.windows.per_recording * self.channels

    @property
    def rows(self) -> int:
        """Rows when every recording succeeds."""
        return self.recipe.count * self.rows_per_recording

    def machine_id(self, machine: int) -> str:
        """Name of a machine by its number in `machines`; it is not built."""
        return machine_id_of(self.recipe.machines[int(self.family[machine])].name, int(self.instance[machine]))

    def split(self, recording: int) -> str:
        """The split of a recording: that of its machine."""
        return self.splits[int(self.split_of[self.machine[recording]])]

    def of_split(self, split: str) -> IntArray:
        """Recordings of a split, in their order."""
        number = self.splits.index(split)
        return np.flatnonzero(self.split_of[self.machine] == number)

    def points(self, kind: int) -> Points:
        """The sampling plan of a class."""
        fault = self.recipe.faults[kind - 1] if kind else None
        axes = drawn_only(recording_axes(self.recipe, fault, kind - 1))
        return Points(
            kind=self.recipe.plan,
            levels=levels(axes),
            count=int(np.count_nonzero(self.kind == kind)),
            seed=self.recipe.seed,
            stream=Stream.CLASS,
            number=kind,
        )


def class_weights(recipe: Recipe) -> list[float]:
    """Shares of the classes, healthy first."""
    weights = [fault.weight for fault in recipe.faults]
    if not weights:
        return [1.0]
    if recipe.healthy_share is None:
        return [1.0, *weights]
    left = (1.0 - recipe.healthy_share) / sum(weights)
    return [recipe.healthy_share, *(left * weight for weight in weights)]


def _mixed_families(recipe: Recipe) -> tuple[IntArray, IntArray]:
    """Family of every machine and its number there: families mixed evenly, each in a drawn order."""
    counts = [family.instances for family in recipe.machines]
    family = interleaved(counts)
    instance = np.zeros_like(family)
    for number, count in enumerate(counts):
        instance[family == number] = generator(recipe.seed, Stream.ORDER, 1, number).permutation(count)
    return family, instance


def _splits(recipe: Recipe, machines: int) -> IntArray:
    """Split of each of so many machines; every split has one."""
    names, shares = list(recipe.splits), list(recipe.splits.values())
    if machines < len(names):
        message = f"{len(names)} splits need as many machines, so that none occurs in two"
        allowed = f"{len(names)} or more `instances` in all, or fewer splits"
        raise SpecError(Problem(field="splits", message=message, given=machines, allowed=allowed))
    return interleaved(quotas(shares, machines, least=1))


def _recordings(recipe: Recipe, family: IntArray, split_of: IntArray) -> tuple[IntArray, IntArray]:
    """Class and machine of every recording, mixed. Exact to one: classes, splits; machines within their split."""
    if recipe.siblings:
        return _siblings(recipe, family)
    per_split = quotas(list(recipe.splits.values()), recipe.count)
    machine: list[int] = []
    for split, count in enumerate(per_split):
        members = np.flatnonzero(split_of == split)
        for member, own in zip(members, quotas([1.0] * members.size, count), strict=True):
            machine += [int(member)] * own
    # Machines one after the other, classes in an order whose every stretch is balanced: so is each machine.
    kind = interleaved(quotas(class_weights(recipe), recipe.count))
    order = generator(recipe.seed, Stream.ORDER, 0).permutation(recipe.count)
    return kind[order], np.asarray(machine, dtype=np.int64)[order]


def _siblings(recipe: Recipe, family: IntArray) -> tuple[IntArray, IntArray]:
    """One recording of each class of every machine, machine after machine, those of a family together: a shard then
    has siblings side by side, and machines enough of one structure."""
    classes = len(recipe.classes)
    wanted = classes * family.size
    if recipe.count != wanted:
        message = f"`siblings` records each of {family.size} machines once in each of {classes} classes"
        raise SpecError(Problem(field="count", message=message, given=recipe.count, allowed=f"{wanted}"))
    order = np.argsort(family, kind="stable").astype(np.int64)
    return np.tile(np.arange(classes), family.size), np.repeat(order, classes)


def inspected(plan: Plan) -> None:
    """Every end and choice tried, every machine of a plan built once; SpecError for what cannot be, for damage in what
    is called sound, and where one machine would stand in two splits."""
    check_sound(plan.recipe)
    check_ends(plan.recipe)
    check_apart(plan.recipe, plan.machines, walked(plan.machines), plan.split_of)


def planned(recipe: Recipe) -> Plan:
    """The plan, all its machines looked at; SpecError lists what of the recipe contradicts itself."""
    plan = laid_out(recipe)
    inspected(plan)
    return plan


def laid_out(recipe: Recipe) -> Plan:
    """The plan with no machine built yet; SpecError lists what of the recipe itself contradicts.

    Whether each machine can be built and stands in one split is not asked: that takes all of them (`planned`).
    """
    check_recipe(recipe)
    family, instance = _mixed_families(recipe)
    split_of = _splits(recipe, family.size)
    kind, machine = _recordings(recipe, family, split_of)
    families = families_of(recipe)
    return Plan(
        recipe=recipe,
        machines=Population(families, family, instance),
        family=family,
        instance=instance,
        splits=tuple(recipe.splits),
        split_of=split_of,
        kind=kind,
        rank=ranks(kind),
        machine=machine,
        channels=channels_of(recipe, families),
        warnings=(
            *split_warnings(recipe, family, split_of, kind, machine),
            *confounded_warnings(recipe, kind),
            *doubtful_warnings(recipe),
            *ordinary_warnings(recipe),
        ),
    )
