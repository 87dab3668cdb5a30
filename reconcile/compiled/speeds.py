"""Compiled: values of combs over many speeds, and narrow lines over many changes of the speed.

As arrays, each of these steps would go through memory, at thousands of speeds.
"""

from __future__ import annotations

import numpy as np

from sim.core.compiled import exact


@exact
def add_combs(log, resolution_hz, speeds_hz, orders, weights, total):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Add to `total` (speeds,) what is in the bin nearest to each order times the speed, over the order's weight."""
    for k in range(orders.size):
        for i in range(speeds_hz.size):
            place = int(np.rint(orders[k] * speeds_hz[i] / resolution_hz))
            if 0 <= place < log.size:
                total[i] += log[place] / weights[k]


@exact
def read_at(parts, times, given, window, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """`out` (parts, n): each of `parts` (parts, n), given at rising times (n,), at other rising ones, times `window`;
    between samples straight, and held at the ends, as `np.interp` has it."""
    last, j = given.size - 1, 0
    for i in range(times.size):
        x = times[i]
        while j < last and given[j + 1] <= x:
            j += 1
        if j == last or x < given[0]:
            for p in range(parts.shape[0]):
                out[p, i] = parts[p, j] * window[i]
            continue
        beyond, width = x - given[j], given[j + 1] - given[j]
        for p in range(parts.shape[0]):
            slope = (parts[p, j + 1] - parts[p, j]) / width
            out[p, i] = (slope * beyond + parts[p, j]) * window[i]


@exact
def _middle(values, ordered):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN202
    """Median of an even number of values; `ordered` is scratch of their size."""
    for i in range(values.size):
        k = i
        while k > 0 and ordered[k - 1] > values[i]:
            ordered[k] = ordered[k - 1]
            k -= 1
        ordered[k] = values[i]
    half = values.size // 2
    return 0.5 * (ordered[half - 1] + ordered[half])


@exact
def narrow_lines(power, left_out, block, strong, reach, beside):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """How many bins are above `strong` times the median of the block of bins around them, the largest of `reach` to
    either side, and more than `beside` times those at the ends; none of `left_out` (bins,), nor near the ends."""
    blocks, found = power.size // block, 0
    scratch = np.empty(block)
    for b in range(blocks):
        first, last = b * block, (b + 1) * block if b < blocks - 1 else power.size
        most = power[first]
        for i in range(first, last):
            most = max(most, power[i])
        high = 0  # where more than half are that high, so is the median, and nothing is strong
        for i in range(first, first + block):
            high += power[i] * (strong - 1.0) >= most
        if high > block // 2:
            continue
        level = strong * _middle(power[first : first + block], scratch)
        for i in range(max(first, 2 * reach), min(last, power.size - reach)):
            if not power[i] > level or left_out[i]:
                continue
            ends = max(power[i - reach], power[i + reach])
            found += power[i] == power[i - reach : i + reach + 1].max() and power[i] > beside * ends
    return found
