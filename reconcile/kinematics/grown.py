"""A defect that the baseline has already: has it grown?"""

from __future__ import annotations

from collections.abc import Sequence

from reconcile.kinematics.candidate import ALONE_DEPTH, Candidate
from reconcile.kinematics.extent import Extent, spall_extent
from reconcile.kinematics.families import Ties
from reconcile.kinematics.observe import Observation

RATIO = 1.3
"""Of two resolved lengths (the place of the strike is the same in both, so their ratio is better known than either)."""


def old_defects(every: Sequence[Candidate]) -> tuple[Candidate, ...]:
    """Bearing families as deep in the baselines as only a defect makes them."""
    return tuple(
        c
        for c in every
        if c.family.kind in ("outer", "inner")
        and c.present
        and all(x.before is not None and min(x.before, x.depth) >= ALONE_DEPTH for x in c.contrasts)
    )


def grown_defect(
    old: Sequence[Candidate], tests: Sequence[Observation], baselines: Sequence[Observation], ties: Ties
) -> tuple[Candidate, Extent, Extent] | None:
    """(family, extent now, extent before) of an old defect whose entry and exit moved apart."""
    for c in old:
        now = spall_extent(c.best, tests[c.strongest], ties)
        heard = [b for b in baselines if c.best.channel in b.recording.names]
        before = [x for b in heard if (x := spall_extent(c.best, b, ties)) is not None]
        if now is None or not now.resolved or not before:
            continue
        last = max(before, key=lambda x: x.degrees)
        if now.degrees > RATIO * last.degrees if last.resolved else now.low_deg > last.high_deg:
            return c, now, last
    return None
