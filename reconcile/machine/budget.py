"""How much a reconciliation may simulate beyond the atlas."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True, kw_only=True)
class Budget:
    """How much is simulated beyond the atlas, on machines that agree with the baseline: the best `terms` at all sites,
    more of the best `candidates`, then the `effects` best near their best draws in each of `rounds`. Where
    no known effect is adequate force laws are tried at the likeliest `supports` bearings, after
    the best `broader` effects at a place that have few draws got all of them: one not met at its size looks like
    none."""

    name: Literal["quick", "full"]
    terms: int
    candidates: int
    effects: int
    rounds: int
    supports: int
    broader: int


QUICK = Budget(name="quick", terms=12, candidates=6, effects=3, rounds=1, supports=0, broader=0)
FULL = Budget(name="full", terms=100, candidates=20, effects=6, rounds=2, supports=2, broader=12)
BUDGETS = {"quick": QUICK, "full": FULL}
