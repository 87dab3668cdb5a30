"""Compiled: what lies at the lines of combs, added up in the order of the lines."""

from __future__ import annotations

import numpy as np

from sim.core.compiled import exact


@exact
def placed(base, multiples, beside, step, bins, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Nearest bins (trials, lines) of the lines base * multiple + beside; 0, where nothing is, of those outside."""
    for i in range(base.size):
        for k in range(multiples.size):
            place = (base[i] * multiples[k] + beside[k]) / step
            out[i, k] = int(np.rint(place)) if 0.0 < place < bins - 1 else 0


@exact
def summed(places, weights, values, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Weighted sums (trials, bands) of `values` (bins, bands) at the places (trials, lines)."""
    bands = values.shape[1]
    for i in range(places.shape[0]):
        for b in range(bands):
            out[i, b] = 0.0
        for k in range(weights.size):
            at, weight = places[i, k], weights[k]
            for b in range(bands):
                out[i, b] += weight * values[at, b]


@exact
def largest(places, weights, values, first, total, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Largest of those sums, (groups, bands), of trials from `first` (groups,) on; `total` (1, bands) is scratch."""
    bands = values.shape[1]
    for g in range(first.size):
        last = first[g + 1] if g + 1 < first.size else places.shape[0]
        for i in range(first[g], last):
            summed(places[i : i + 1], weights, values, total)
            for b in range(bands):
                one = total[0, b]
                if i == first[g] or one > out[g, b] or one != one:  # noqa: PLR0124 - no number stays none
                    out[g, b] = one
