"""A family over all test recordings: whether its lines are there, have risen, and are deep."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from reconcile.kinematics.contrast import Contrast
from reconcile.kinematics.evidence import Evidence
from reconcile.kinematics.families import Family

LEVEL = 0.01
GROWTH_DB = 6.0
"""Depth of modulation must have doubled, and by more than two standard errors."""
ERRORS = 2.0
LEAST_DEPTH = 0.15
ALONE_DEPTH = 0.5
"""Depth that sound bearings do not show (0.34 was the most seen): asked for where there is no baseline, and of a
defect that is named: shallower ones have risen, but a damaged ball raises the lines of both races as well."""
UNBASED_DEPTH, STRIKES, FLAT = 0.6, 2.0, 0.2
"""Depth, and excess kurtosis or flatness of its lines, of a band that hears them, with no baseline. Balls that pass in
a sound bearing modulate what is heard smoothly: those of a simulated rig, where nothing else is, are 0.9 deep with a
kurtosis of 1.1 and a flatness of 0.12. Seeded races of three real rigs have a depth of 0.74 and a kurtosis of 2.9 at
least, equal blows that slip by 1 % a flatness of 0.26."""
TURN_ALONE_DEPTH = 1.0
"""Sound shafts modulate too; only impacts reach this."""
LEAST_Z = 5.0
"""Robust standard deviations of the controls that a named family stands above them, whatever its tail says."""
DEFECTS = ("outer", "inner", "ball")


@dataclass(frozen=True, kw_only=True)
class Candidate:
    """A family over all test recordings. `chance` is Fisher's combination after Holm over all families."""

    family: Family
    evidence: tuple[Evidence, ...]
    contrasts: tuple[Contrast, ...]
    chance: float
    centred: bool = True
    """Whether no sideband of it is deeper than the line itself, where that was asked."""
    driven: bool = False
    """Whether its lines are those of blows that keep step with a shaft (`reconcile.kinematics.in_step`)."""
    of_turn: bool = False
    """Whether its lines are what impacts once a turn leave beside that turn's (`reconcile.kinematics.beside_turn`)."""

    @property
    def strongest(self) -> int:
        """Index of the test recording that shows it best."""
        return int(np.argmax([e.z for e in self.evidence]))

    @property
    def z(self) -> float:
        """Root mean square of the (positive) scores."""
        return float(np.sqrt(np.mean([max(e.z, 0.0) ** 2 for e in self.evidence])))

    @property
    def best(self) -> Evidence:
        """Evidence of the recording that shows it best."""
        return self.evidence[self.strongest]

    @property
    def read_in(self) -> tuple[tuple[tuple[str, tuple[float, float]], float], ...]:
        """Channels and bands in which its depth is read, with its order there: the firmest, and the deepest where that
        one is too shallow."""
        e = self.best
        firmest = (e.channel, e.band_hz), e.order
        if self.contrasts[self.strongest].depth >= ALONE_DEPTH or self._deepest(self.strongest) < ALONE_DEPTH:
            return (firmest,)
        deepest = max((e, *e.others), key=lambda one: one.deepest)
        return firmest, ((deepest.channel, deepest.deepest_hz), deepest.order)

    @property
    def growth_db(self) -> float | None:
        """Median growth of depth over the baselines."""
        values = [c.growth_db for c in self.contrasts if c.growth_db is not None]
        return float(np.median(values)) if values else None

    @property
    def based(self) -> bool:
        """Whether a baseline heard it in the same channels and bands."""
        return all(c.growth_db is not None for c in self.contrasts)

    @property
    def present(self) -> bool:
        """Whether its lines are there at all, in a sound machine or not."""
        return self.chance < LEVEL and self.z > LEAST_Z and self.centred and not (self.driven or self.of_turn)

    @property
    def depth(self) -> float:
        """Median over the tests."""
        return float(np.median([c.depth for c in self.contrasts]))

    @property
    def deep(self) -> bool:
        """Whether it is as deep as a defect of its own makes it."""
        return self.deepest >= ALONE_DEPTH

    @property
    def risen(self) -> bool:
        """Whether it is more than a baseline (or, without one, than a sound machine) shows."""
        votes = [
            self._alone(i)
            if c.growth_db is None
            else c.depth >= LEAST_DEPTH and c.growth_db > max(GROWTH_DB, ERRORS * c.error_db)
            for i, c in enumerate(self.contrasts)
        ]
        return 2 * sum(votes) > len(votes)

    @property
    def by_itself(self) -> bool:
        """Whether every recording shows by itself what no sound machine does."""
        return all(self._alone(i) for i in range(len(self.evidence)))

    def _alone(self, i: int) -> bool:
        """Whether test `i` shows by itself what no sound machine does: blows, with lines as deep as a defect makes
        them."""
        if self.family.kind == "turn":
            return self.contrasts[i].depth >= TURN_ALONE_DEPTH
        return self._deepest(i) >= UNBASED_DEPTH and self.strikes(i)

    def strikes(self, i: int) -> bool:
        """Whether blows are heard in test `i`, beyond noise whose strength varies."""
        e = self.evidence[i]
        deepest = max((e, *e.others), key=lambda one: one.deepest)
        return max([e.kurtosis, *(one.kurtosis for one in e.others)]) >= STRIKES or deepest.flatness >= FLAT

    def _deepest(self, i: int) -> float:
        e = self.evidence[i]
        return max([self.contrasts[i].depth, e.deepest, *(one.deepest for one in e.others)])

    @property
    def deepest(self) -> float:
        """Median over the tests of the largest depth that a band has."""
        return float(np.median([self._deepest(i) for i in range(len(self.evidence))]))
