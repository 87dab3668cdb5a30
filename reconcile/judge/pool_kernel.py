"""The loop that whitens changes and adds them up by family, compiled: as arrays each step would pass through memory."""

from __future__ import annotations

import math

from sim.core.compiled import exact


@exact
def family_sums(changes, rows, sigma, family, counts, dead, found):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Whiten `rows` of `changes` (n, P * C * F) by `sigma` (P * C * F,) and pool them into `found` (k, names, 3, C).

    `family` (F,) is the number of each feature's family, negative where it has none; `counts` (names,) how many are of
    each; `found` must be zero. What is not finite counts as no change.
    """
    names, channels = found.shape[1], found.shape[3]
    size = family.size
    points = sigma.size // (channels * size)
    rise, square = [0.0] * names, [0.0] * names
    for i in range(rows.size):
        row = changes[rows[i]]
        for point in range(points):
            for channel in range(channels):
                for k in range(names):
                    rise[k] = 0.0
                    square[k] = 0.0
                first = (point * channels + channel) * size
                for f in range(size):
                    k = family[f]
                    if k < 0:
                        continue
                    value = row[first + f]
                    z = value / sigma[first + f] if math.isfinite(value) else 0.0
                    beyond = max(abs(z) - dead, 0.0)
                    rise[k] += z
                    square[k] += beyond * beyond
                for k in range(names):
                    length = math.sqrt(square[k] / counts[k])
                    found[i, k, 0, channel] += rise[k] / counts[k] * math.sqrt(counts[k])
                    found[i, k, 1, channel] += length
                    found[i, k, 2, channel] = max(found[i, k, 2, channel], length)
        for k in range(names):
            for channel in range(channels):
                found[i, k, 0, channel] /= points
                found[i, k, 1, channel] /= points
