"""The machines of a plan by their numbers: each is built when it is asked for, and only some are kept."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import lru_cache
from typing import overload

from sideband_datasets.plan.machines import Family, Machine
from sideband_datasets.plan.quotas import IntArray

KEPT = 256
"""Machines that are kept once built: as many as the recordings that are worked on at once may have."""


class Population(Sequence[Machine]):
    """`family`, `instance`: number of each machine's family and its number there, shape (machines,)."""

    def __init__(self, families: Sequence[Family], family: IntArray, instance: IntArray) -> None:
        self._families, self._family, self._instance = tuple(families), family, instance
        self._kept = lru_cache(maxsize=KEPT)(self._built)

    def _built(self, number: int) -> Machine:
        return self._families[int(self._family[number])].built(int(self._instance[number]))

    @overload
    def __getitem__(self, number: int) -> Machine: ...
    @overload
    def __getitem__(self, number: slice) -> list[Machine]: ...
    def __getitem__(self, number: int | slice) -> Machine | list[Machine]:
        """One machine, or those of a slice; SpecError when one cannot be built."""
        found = range(len(self))[number]
        return self._kept(found) if isinstance(found, int) else [self._kept(k) for k in found]

    def __iter__(self) -> Iterator[Machine]:
        """All machines in their order, none of them kept."""
        return (self._built(number) for number in range(len(self)))

    def __len__(self) -> int:
        return int(self._family.size)
