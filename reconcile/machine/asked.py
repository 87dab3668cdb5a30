"""What a second effect is asked of, beside a first that has been fitted together with the machine."""

from __future__ import annotations

from dataclasses import dataclass

from reconcile.atlas.bank import Mapper
from reconcile.judge.space import Fitted
from reconcile.machine.leftover import Leftover
from reconcile.machine.library import Catalogued
from reconcile.machine.second import strikes
from reconcile.machine.setting import Found, Setting

LEAST_GAIN = 30.0
"""Log likelihood that a second must add as simulated, beyond what the first gains by being moved as often. Features are
not independent, so this counts several times what evidence does. Right seconds of the proof add 30 and more, but for
one 28, wrong ones up to 28 (docs/decisions/reconcile-leftover.md)."""
BESIDE_PIT = 12.0
"""What it must add by the teeth's own lines, a fifth of the features: a right one adds 12.8, wrong ones up to 7.3."""
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
