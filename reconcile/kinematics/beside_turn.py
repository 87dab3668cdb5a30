"""What impacts once a turn leave beside their own lines is no bearing's, and hides none.

A speed that wanders widens the high multiples of a turn beyond the bins that are taken out for the shafts. A bearing
whose drawing lies within slip of a whole number then finds a comb there, and the orders of no part, against which all
families are held, find such combs too: a race that is surely struck does not stand out of them any more.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from reconcile.kinematics.candidate import DEFECTS, LEAST_Z, LEVEL, Candidate
from reconcile.kinematics.observe import Observation

NEXT_BINS = 4.0
"""Within which the skirts of a strong line reach."""
ONE_LINE = 0.004
"""Measured orders nearer than this are of one line: jitter and the search's grid move them by 0.2 %."""

Beside = Callable[[tuple[Candidate, ...]], tuple[Candidate, ...]]
"""All candidates but these, without their lines."""


class Turned:
    """The families of one search against the turns that have risen in it."""

    def __init__(self, found: Sequence[Candidate], tests: Sequence[Observation], beside: Beside) -> None:
        self._turns = tuple(c for c in found if c.family.kind == "turn" and c.present and c.risen)
        self._tests = tests
        self._beside = beside
        self._without: dict[str, tuple[Candidate, ...]] = {}

    def told(self, one: Candidate) -> Candidate:
        """The family, which knows whether it is what a turn leaves there; of one that only the turn's lines hide among
        the orders of no part what stands without them."""
        if one.family.kind not in DEFECTS or not one.risen or one.z <= LEAST_Z:
            return one
        if self.leaves(one):
            return replace(one, of_turn=True)
        return one if one.chance < LEVEL else self._freed(one)

    def leaves(self, one: Candidate) -> bool:
        """Whether a family that begins next to a multiple of a shaft, of which something strikes once a turn and is
        firmer, is what that leaves there: it is not present any more without those lines. A broken tooth was the inner
        race, 1.5 bins off five times its shaft."""
        near = next((t for t in self._turns if t.z > one.z and self._beside_it(one, t)), None)
        return near is not None and not any(
            c.family.key == one.family.key and c.present and c.risen for c in self._cleared(near)
        )

    def _beside_it(self, one: Candidate, turn: Candidate) -> bool:
        channel = self._tests[one.strongest].channel(one.best.channel)
        assert channel is not None
        number = round(one.best.order / turn.best.order)
        return abs(one.best.order - number * turn.best.order) < NEXT_BINS * channel.order_step

    def _freed(self, one: Candidate) -> Candidate:
        """The same line in the search without the lines of a turn that is firmer, where it is present there."""
        for turn in self._turns:
            if turn.z <= one.z or self._beside_it(one, turn):
                continue
            again = next((c for c in self._cleared(turn) if c.family.key == one.family.key), None)
            if again is not None and again.present and again.risen and _same_line(again, one):
                return again
        return one

    def _cleared(self, turn: Candidate) -> tuple[Candidate, ...]:
        key = turn.family.key
        if key not in self._without:
            self._without[key] = self._beside((turn,))
        return self._without[key]


def _same_line(a: Candidate, b: Candidate) -> bool:
    return abs(a.best.order / b.best.order - 1.0) < ONE_LINE
