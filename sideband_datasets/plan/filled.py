"""How well the eight lanes of the solver are filled: which recordings of a plan are of one structure."""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from sideband_datasets.plan.drawing import Drawing, drawing
from sideband_datasets.plan.plan import Plan
from sideband_datasets.plan.quotas import IntArray
from sideband_datasets.plan.size import batch_size
from sideband_datasets.plan.tried import alike, cells_of, make_plan, outputs_of
from sideband_datasets.recipe.model import Recipe
from sideband_datasets.recipe.read import canonical
from sim.assembly.assemble import assemble
from sim.core.lanes import WIDTH
from sim.core.system import System

MOST_OF_A_CELL = 6
MOST_SAMPLES = 40
"""Recordings put together for an estimate: some of each class and family, one of each at least."""


@dataclass(frozen=True, kw_only=True)
class Sample:
    """A recording put together: its structure and that of its machine without the fault by their numbers."""

    drawing: Drawing
    system: System
    outputs: tuple[str, ...] | None
    structure: int
    sound: int


@dataclass(frozen=True, kw_only=True)
class Samples:
    """`like`: the sample that stands for each recording, shape (recordings,); a sample stands for itself."""

    found: tuple[Sample, ...]
    like: IntArray


def _chosen(cells: IntArray, seed: int) -> tuple[list[int], IntArray]:
    """Recordings that are put together, and which of them stands for each: one of its cell, drawn."""
    number = int(cells.max()) + 1
    each = min(max(MOST_SAMPLES // number, 1), MOST_OF_A_CELL)
    rng = np.random.default_rng(seed)
    chosen: list[int] = []
    like = np.zeros(cells.size, dtype=np.int64)
    for cell in range(number):
        members = np.flatnonzero(cells == cell)
        own = np.unique(np.linspace(0, members.size - 1, min(each, members.size)).round().astype(np.int64))
        like[members] = len(chosen) + rng.integers(own.size, size=members.size)
        like[members[own]] = len(chosen) + np.arange(own.size)
        chosen += members[own].tolist()
    return chosen, like


def sampled(plan: Plan) -> Samples:
    """Some recordings of a plan, put together, and which of them stands for each of the others."""
    return _sampled(canonical(plan.recipe))


@lru_cache(maxsize=2)
def _sampled(text: str) -> Samples:
    plan = make_plan(Recipe.model_validate_json(text))
    chosen, like = _chosen(cells_of(plan), plan.recipe.seed)
    known: dict[Hashable, int] = {}
    found = []
    for number in chosen:
        drawn = drawing(plan, number)
        system = assemble(drawn.spec, seed=drawn.seed)
        outputs = outputs_of(plan, drawn, system)
        own = known.setdefault(alike(plan, system, outputs), len(known))
        sound = own
        if plan.recipe.beside_sound and drawn.effects:
            bare = assemble(drawn.sound, seed=drawn.seed)
            sound = known.setdefault(alike(plan, bare, outputs), len(known))
        found.append(Sample(drawing=drawn, system=system, outputs=outputs, structure=own, sound=sound))
    return Samples(found=tuple(found), like=like)


def runs(plan: Plan, samples: Samples, members: Sequence[int]) -> Iterator[tuple[Sample, int]]:
    """Runs of up to eight lanes that a shard of the recordings `members` takes: a sample that is in it, and how many
    of its lanes are filled."""
    size = batch_size(plan)
    for first in range(0, len(members), size):
        batch = [(number, samples.found[samples.like[number]]) for number in members[first : first + size]]
        if plan.recipe.beside_sound:
            yield from _beside(plan, batch)
        else:
            yield from _grouped([(sample.structure, sample) for _, sample in batch])


def _beside(plan: Plan, batch: Sequence[tuple[int, Sample]]) -> Iterator[tuple[Sample, int]]:
    """Eight machines without a fault, faulty ones of their structure in the lanes they leave, then the others."""
    sounds: dict[int, list[Sample]] = {}
    for number, sample in batch:
        sounds.setdefault(int(plan.machine[number]) if plan.recipe.siblings else number, []).append(sample)
    groups: dict[int, list[list[Sample]]] = {}
    for members in sounds.values():
        groups.setdefault(members[0].sound, []).append(members)
    for group in groups.values():
        for first in range(0, len(group), WIDTH):
            lanes = group[first : first + WIDTH]
            faulty = [sample for members in lanes for sample in members if sample.drawing.effects]
            # A sample stands for many recordings, so places tell them apart.
            same = [k for k, sample in enumerate(faulty) if sample.structure == lanes[0][0].sound]
            taken = same[: WIDTH - len(lanes)]
            yield lanes[0][0], len(lanes) + len(taken)
            yield from _grouped([(sample.structure, sample) for k, sample in enumerate(faulty) if k not in taken])


def _grouped(found: Sequence[tuple[int, Sample]]) -> Iterator[tuple[Sample, int]]:
    groups: dict[int, list[Sample]] = {}
    for structure, sample in found:
        groups.setdefault(structure, []).append(sample)
    for group in groups.values():
        for first in range(0, len(group), WIDTH):
            yield group[first], min(WIDTH, len(group) - first)
