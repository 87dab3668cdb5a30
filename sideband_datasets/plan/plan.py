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
from sideband_datasets.plan.machines import Machine, machines_of
from sideband_datasets.plan.points import Points
from sideband_datasets.plan.quotas import IntArray, interleaved, quotas, ranks
from sideband_datasets.plan.seeds import Stream, generator
from sideband_datasets.plan.sound import check_sound, ordinary_warnings
from sideband_datasets.recipe.model import Recipe
from sim.core.errors import Problem, SpecError


@dataclass(frozen=True, kw_only=True)
class Plan:
    """Everything is a pure function of the recipe; arrays have shape (recordings,).

    `kind`: number of the class, 0 healthy; `rank`: how many of that class come before, its point of the class' plan;
    `machine`: number in `machines`; `split_of`: number of each machine's split, shape (machines,).
    """

    recipe: Recipe
    machines: tuple[Machine, ...]
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


def _mixed_families(recipe: Recipe, families: Sequence[Sequence[Machine]]) -> list[Machine]:
    """All machines, families mixed evenly, each family in a drawn order."""
    shuffled = []
    for number, family in enumerate(families):
        order = generator(recipe.seed, Stream.ORDER, 1, number).permutation(len(family))
        shuffled.append(iter([family[k] for k in order]))
    return [next(shuffled[number]) for number in interleaved([len(family) for family in families])]


def _splits(recipe: Recipe, machines: Sequence[Machine]) -> IntArray:
    """Split of each machine; every split has one. SpecError where one machine, or one path, would stand in two."""
    names, shares = list(recipe.splits), list(recipe.splits.values())
    if len(machines) < len(names):
        message = f"{len(names)} splits need as many machines, so that none occurs in two"
        allowed = f"{len(names)} or more `instances` in all, or fewer splits"
        raise SpecError(Problem(field="splits", message=message, given=len(machines), allowed=allowed))
    split_of = interleaved(quotas(shares, len(machines), least=1))
    check_apart(recipe, machines, split_of)
    return split_of


def _recordings(recipe: Recipe, machines: Sequence[Machine], split_of: IntArray) -> tuple[IntArray, IntArray]:
    """Class and machine of every recording, mixed. Exact to one: classes, splits; machines within their split."""
    if recipe.siblings:
        return _siblings(recipe, machines)
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


def _siblings(recipe: Recipe, machines: Sequence[Machine]) -> tuple[IntArray, IntArray]:
    """One recording of each class of every machine, machine after machine, those of a family together: a shard then
    has siblings side by side, and machines enough of one structure."""
    classes, families = len(recipe.classes), [family.name for family in recipe.machines]
    order = sorted(range(len(machines)), key=lambda m: families.index(machines[m].family))
    wanted = classes * len(machines)
    if recipe.count != wanted:
        message = f"`siblings` records each of {len(machines)} machines once in each of {classes} classes"
        raise SpecError(Problem(field="count", message=message, given=recipe.count, allowed=f"{wanted}"))
    return np.tile(np.arange(classes), len(machines)), np.repeat(np.asarray(order, dtype=np.int64), classes)


def planned(recipe: Recipe) -> Plan:
    """The plan; SpecError lists what of the recipe contradicts itself."""
    check_recipe(recipe)
    check_sound(recipe)
    check_ends(recipe)
    families = [machines_of(recipe, number) for number in range(len(recipe.machines))]
    machines = _mixed_families(recipe, families)
    split_of = _splits(recipe, machines)
    kind, machine = _recordings(recipe, machines, split_of)
    return Plan(
        recipe=recipe,
        machines=tuple(machines),
        splits=tuple(recipe.splits),
        split_of=split_of,
        kind=kind,
        rank=ranks(kind),
        machine=machine,
        channels=channels_of(recipe, families),
        warnings=(
            *split_warnings(recipe, machines, split_of, kind, machine),
            *confounded_warnings(recipe, kind),
            *doubtful_warnings(recipe),
            *ordinary_warnings(recipe),
        ),
    )
