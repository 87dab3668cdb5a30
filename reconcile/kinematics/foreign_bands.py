"""Impacts at an order of no part that are not firmest in the band in which they grew.

`reconcile.kinematics.foreign` compares with the baseline in the firmest band alone. What sounds there without defect
(a ripple, a bearing of another machine) hides blows that ring in another.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace

import numpy as np

from reconcile.kinematics.contrast import contrast
from reconcile.kinematics.envelopes import Envelopes
from reconcile.kinematics.evidence import family_evidence
from reconcile.kinematics.families import Family, Ties
from reconcile.kinematics.foreign import GROWTH_DB, LEAST_DEPTH, LEAST_Z, MOST, Foreign, explained, firmness
from reconcile.kinematics.observe import Observation


def foreign_in_a_band(
    test: Observation, baselines: Sequence[Observation], ties: Ties, seed: int, *, heard: Collection[str]
) -> Foreign | None:
    """The comb that no part explains and that is firm in a band in which it has grown, the one that grew most; None
    without one, or without a baseline. `heard` as in `foreign_comb`."""
    if not baselines or not ties.families:
        return None
    found = []
    for e in test.channels:
        for band, order in _firm(e, test, ties, heard):
            family = Family(kind="outer", site="", order=order, spacing=0.0, sidebands=0, slip=0.002)
            whole = family_evidence([e], ties, family, 0.0, np.random.default_rng((seed, 77)))
            if whole.z < LEAST_Z:
                continue
            seen = replace(whole, band_hz=e.band(band))
            growth = contrast(seen, test, baselines, ties)
            if growth.growth_db is not None and growth.growth_db >= GROWTH_DB and growth.depth >= LEAST_DEPTH:
                seen = replace(seen, depth=growth.depth)
                found.append(Foreign(order=whole.order, evidence=seen, growth_db=growth.growth_db))
    return max(found, key=lambda one: one.growth_db, default=None)


def _firm(e: Envelopes, test: Observation, ties: Ties, heard: Collection[str]) -> list[tuple[int, float]]:
    """(band, order) of the strongest comb of no part in each band that holds a firm one."""
    base, firm = firmness(e, ties)
    found = []
    for band, row in enumerate(firm):
        for place in np.argsort(-row)[: 40 * MOST]:
            if row[place] < LEAST_Z:
                break
            if not explained(float(base[place]), ties, test.doubt, heard=heard, step=e.order_step):
                found.append((band, float(base[place])))
                break
    return found
