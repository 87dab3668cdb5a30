"""`python -m learn.sim2real.other_bearing`: what is said where the bearing that is stated is not the one that turns.

Measured recordings of bearings of known size at the true speed, whole and in windows of ten turns: under their own
bearing and under six others, of which those with a race's order within 3 % of the true one are left out.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from learn.assess import answered
from learn.elsewhere import REACH, elsewhere
from learn.looked import Looked
from learn.model import Model, default_model, load
from learn.orders import FaultOrders, of_ratio
from learn.real.load import BEARINGS, RECORDINGS, Case, available, case, index
from learn.remarks import UNSURE
from learn.sim2real.answers import units
from learn.sim2real.pools import pool_of
from sideband_datasets.recipe.bearings import CLASSES

OTHERS = ((7, 0.24), (8, 0.2), (8, 0.25), (9, 0.18), (10, 0.17), (12, 0.14))
"""Balls, ratio of diameters."""
OWN, OTHER = "its own", "another"
HEALTHY = CLASSES[0]


@dataclass(frozen=True, kw_only=True)
class Said:
    """Of one unit under one bearing; `sure`: called healthy with nothing that says to look again."""

    kind: str
    sound: bool
    under: str
    told: bool
    healthy: bool
    sure: bool


def others(own: FaultOrders) -> list[FaultOrders]:
    """Bearings none of whose races has an order near one of this."""
    tried = [of_ratio(*one) for one in OTHERS]
    return [o for o in tried if min(abs(o.outer / own.outer - 1), abs(o.inner / own.inner - 1)) > REACH]


def said(one: Case, model: Model) -> list[Said]:
    """All units of a recording under all bearings."""
    assert one.orders is not None
    found = []
    for unit in units(one):
        for under, orders in ((OWN, one.orders), *((OTHER, o) for o in others(one.orders))):
            channels = tuple(unit.channels)
            seen = Looked(channels=channels, rate_hz=one.rate_hz, speed_hz=one.speed_hz, orders=orders, doubt=0.0)
            answer = answered(seen, model)
            told = elsewhere(seen.long, [orders]) is not None
            healthy = answer.label == HEALTHY
            found.append(
                Said(
                    kind=unit.kind,
                    sound=one.label == HEALTHY,
                    under=under,
                    told=told,
                    healthy=healthy,
                    sure=healthy and not told and answer.probabilities[HEALTHY] >= UNSURE,
                )
            )
    return found


def table_of(found: Sequence[Said]) -> str:
    """Counts by what was looked at."""
    lines = ["| | bearing | n | foreign impacts told | called healthy | surely so |", "|---|---|---|---|---|---|"]
    for kind in ("recording", "window"):
        for sound in (True, False):
            for under in (OWN, OTHER):
                some = [s for s in found if (s.kind, s.sound, s.under) == (kind, sound, under)]
                counts = [sum(getattr(s, name) for s in some) for name in ("told", "healthy", "sure")]
                what = f"{kind}s, {'sound' if sound else 'faulty'}"
                lines.append(f"| {what} | {under} | {len(some)} | {' | '.join(map(str, counts))} |")
    return "\n".join(lines)


def main(argv: Sequence[str] | None = None) -> int:
    """Print the table."""
    parser = argparse.ArgumentParser(prog="learn.sim2real.other_bearing", description=__doc__)
    parser.add_argument("--model", type=Path, default=None, help="another than the shipped one")
    parser.add_argument("--processes", type=int, default=2)
    given = parser.parse_args(argv)
    if not available():
        print(f"skipped: there are no recordings at {RECORDINGS}")
        return 0
    model = load(given.model) if given.model is not None else default_model()
    cases = [case(entry) for entry in index() if entry["dataset"] in BEARINGS]
    work = partial(said, model=model)
    with pool_of(given.processes) as pool:
        parts = list(pool.map(work, cases) if pool is not None else map(work, cases))
    print(table_of([one for part in parts for one in part]))
    return 0


if __name__ == "__main__":
    sys.exit(main())
