"""Periodic impacts at an order no part has: something is there that the drawing does not know."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np

from reconcile.kinematics.comb_scores import scores
from reconcile.kinematics.contrast import contrast
from reconcile.kinematics.envelopes import Envelopes
from reconcile.kinematics.evidence import Evidence, family_evidence, logs
from reconcile.kinematics.families import Family, Ties
from reconcile.kinematics.observe import Observation
from signals.series import FloatArray

LOWEST = 0.3
LEAST_Z = 12.0
GROWTH_DB, BESIDE_DB = 10.0, 5.0
"""Growth over the baseline that it takes, and beside impacts once a turn that have been told already."""
LEAST_DEPTH = 0.3
MULTIPLES = (0.5, 1.0, 1.5, 2.0, 3.0, 4.0)
SLOW = 1.0
"""Order below which a short record resolves a comb by less than a part's own slip."""
LEAST_SPREAD = 0.7
"""Deviation of a band's scores that is taken at least."""
MOST = 12
"""Strongest orders that are looked at before giving up."""


@dataclass(frozen=True, kw_only=True)
class Foreign:
    """A comb at `order` of the reference shaft with its evidence and growth over the baseline."""

    order: float
    evidence: Evidence
    growth_db: float


def foreign_comb(
    test: Observation,
    baselines: Sequence[Observation],
    ties: Ties,
    seed: int,
    *,
    heard: Collection[str] = (),
    least_db: float = GROWTH_DB,
) -> Foreign | None:
    """The strongest comb that no part explains and the baseline does not have; None without a baseline.

    `heard`: families (by key) and meshes (by name) that are heard; only their lines with a sideband count as theirs.
    Those of all parts cover nearly all orders.
    """
    if not baselines:
        return None
    best: tuple[float, float] | None = None
    for e in test.channels:
        base, firm = firmness(e, ties)
        top = np.max(firm, axis=0)
        for place in np.argsort(-top)[: 40 * MOST]:
            if explained(float(base[place]), ties, test.doubt, heard=heard, step=e.order_step):
                continue
            if best is None or top[place] > best[0]:
                best = (float(top[place]), float(base[place]))
            break
    if best is None or best[0] < LEAST_Z:
        return None
    family = Family(kind="outer", site="", order=best[1], spacing=0.0, sidebands=0, slip=0.002)
    found = family_evidence(test.channels, ties, family, 0.0, np.random.default_rng((seed, 77)))
    growth = contrast(found, test, baselines, ties)
    if found.z < LEAST_Z or growth.growth_db is None:
        return None
    if growth.growth_db < least_db or growth.depth < LEAST_DEPTH:
        return None
    return Foreign(order=found.order, evidence=found, growth_db=growth.growth_db)


def firmness(e: Envelopes, ties: Ties) -> tuple[FloatArray, FloatArray]:
    """Orders (k,) up to 1.3 times the highest of a part, and how far the comb at each stands out of all of its band's,
    (bands, k), deviations."""
    highest = max(f.order for f in ties.families)
    values = logs(e, ties, shaft_lines=False)
    probe = Family(kind="outer", site="", order=1.0, spacing=0.0, sidebands=0, slip=0.0)
    base = np.arange(LOWEST, 1.3 * highest, e.order_step / probe.harmonics)
    table = scores(values, e, probe, base)
    centre = np.median(table, axis=1, keepdims=True)
    spread = np.maximum(1.4826 * np.median(np.abs(table - centre), axis=1, keepdims=True), LEAST_SPREAD)
    return base, np.asarray((table - centre) / spread)


def explained(
    order: float, ties: Ties, doubt: float, *, heard: Collection[str] | None = None, step: float = 0.0
) -> bool:
    """Whether an order is a multiple or a half of a part's, a multiple of a shaft's, or lies by a sideband of the
    family or of a shaft beside a multiple of one that is `heard` (families by key, meshes by name; None: all); `step`:
    what orders are resolved by, which counts below `SLOW`."""
    shafts = tuple(ties.shafts.values())
    rows = [
        (f.order, f.slip, (f.spacing, *shafts) if heard is None or f.key in heard else (0.0,)) for f in ties.families
    ]
    rows += [(m[1], 0.0, (0.0, *shafts) if heard is None or m[0] in heard else (0.0,)) for m in ties.meshes]
    rows += [(max(1.0, float(np.round(order / shaft))) * shaft, 0.0, (0.0,)) for shaft in shafts]
    for base, slip, shifts in rows:
        for multiple in MULTIPLES:
            target = base * multiple
            width = (slip + doubt + 0.003) * target + (step if target < SLOW else 0.0)
            for shift in (0.0, *shifts):
                if min(abs(order - target - shift), abs(order - target + shift)) < width:
                    return True
    return False
