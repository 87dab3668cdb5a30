"""How much a reconciliation may simulate beyond the atlas."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True, kw_only=True)
class Budget:
    """How much is simulated beyond the atlas, on machines that agree with the baseline: the best `terms` at all sites,
    more of the best `candidates`, then the `effects` best near their best draws in each of `rounds`, on `members`
    machines each, which are then fitted to the observation together with the effect in so many `assimilations`.
    Where no known effect is adequate force laws are tried at the likeliest `supports` bearings, after the best
    `broader` effects at a place that have few draws got all of them: one not met at its size looks like none. Beside
    the best effect so many of those that add most to it are simulated (`pairs`; `seconds` where it does not strike, or
    the teeth tell what stands beside its impacts)."""

    name: Literal["quick", "full"]
    terms: int
    candidates: int
    effects: int
    rounds: int
    supports: int
    broader: int
    members: int
    assimilations: int
    pairs: int
    seconds: int


QUICK = Budget(
    name="quick",
    terms=10,
    candidates=4,
    effects=3,
    rounds=1,
    supports=0,
    broader=0,
    members=8,
    assimilations=1,
    pairs=2,
    seconds=6,
)
FULL = Budget(
    name="full",
    terms=20,
    candidates=12,
    effects=4,
    rounds=1,
    supports=2,
    broader=6,
    members=16,
    assimilations=2,
    pairs=6,
    seconds=10,
)
BUDGETS = {"quick": QUICK, "full": FULL}
