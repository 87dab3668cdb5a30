"""What a second effect is asked of, beside a first that has been fitted together with the machine."""

from __future__ import annotations

from dataclasses import dataclass

from reconcile.atlas.bank import Mapper
from reconcile.judge.space import Fitted
from reconcile.machine.leftover import Leftover
from reconcile.machine.library import Catalogued
from reconcile.machine.second import has_play, strikes
from reconcile.machine.setting import Found, Setting

LEAST_GAIN = 30.0
"""Log likelihood that a second must add as simulated, beyond what the first gains by being moved as often. Features are
not independent, so this counts several times what evidence does. Right seconds of the proof add 30 and more, but for
one 28, wrong ones up to 28 (docs/decisions/reconcile-leftover.md)."""
BESIDE_PIT = 12.0
"""What it must add by the teeth's own lines, a fifth of the features: a right one adds 12.8, wrong ones up to 7.3."""
PROMISING = 2.5
"""Log likelihood that a second effect must add by sums to be simulated: a clearance beside an unbalance added 3.6 so
and 64 simulated."""
PROMISING_BESIDE_PLAY = 20.0
"""The same beside a play, where each costs most and its own draws scatter most: right seconds of the proof added 27, 35
and 37 so; what added less than 8 came to 13, a gear's run-out beside a loose fit alone, 16 by sums, to 85 (bk069)."""
LEAD = 6.0
"""Log likelihood by which it must lead the other simulated ones,"""
LEAD_BESIDE_PLAY = 12.0
"""and beside a play, which does not repeat: beside a loose fit alone (e143 of the proof) a crack of a shaft added 36,
waves of a race 28 and a crack of another shaft 23."""
TEMPER = 4.0
"""Log likelihood that counts as one unit of evidence where sizes are weighed."""


@dataclass(frozen=True, kw_only=True)
class Asked:
    """Seconds beside the effect `first`: `every` draw, of the atlas and, from row `local` on, of machines that agree
    with the baseline; `view` of single lines in which both are fitted."""

    setting: Setting
    found: Found
    first: str
    every: Catalogued
    local: int
    left: Leftover
    view: Fitted
    members: int
    mapper: Mapper

    @property
    def beside_impacts(self) -> bool:
        """Whether the first is a pit."""
        return strikes(self.first)

    @property
    def least(self) -> float:
        """What a second must add."""
        return BESIDE_PIT if self.beside_impacts else LEAST_GAIN


def promising(first: str, second: str) -> float:
    """What a second effect must add by sums to be simulated beside the first."""
    return PROMISING_BESIDE_PLAY if has_play(first) and not strikes(second) else PROMISING


def least_lead(first: str) -> float:
    """By what the second beside it must lead the others that were simulated."""
    return LEAD_BESIDE_PLAY if has_play(first) else LEAD
