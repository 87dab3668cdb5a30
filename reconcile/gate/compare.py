"""Faults that show against a baseline: gain, unit, swapped channels, a loose sensor.

A gain multiplies everything a channel hears by one number, a loose mount by a smooth function of frequency, lines and
noise alike, while the other channels hear what they heard. A defect adds: lines, modulation, impacts; it raises some
bands more than their lines, and its neighbours hear it too.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import reduce

import numpy as np
from scipy.optimize import linear_sum_assignment

from reconcile.gate.findings import Finding
from reconcile.gate.levels import Pair
from reconcile.gate.lines import FLOOR_SHARE, LEAST_LINES, common_unit_gains, denied
from reconcile.gate.robust import robust_swap_order, robust_unit_gain
from reconcile.gate.units import even_unit_gain, possible, unit_finding, unit_of
from signals.recording import Recording
from signals.series import FloatArray

GAIN_DB = 2.0
GAIN_SPREAD_DB = 1.0
"""Half of all bands within this of the median change: what repetition, load and a drift of a few per cent leave."""
QUIET_DB = 1.0
LOOSE_DB = 6.0
LOOSE_BAND_DB = 3.0
LOOSE_ROUGH_DB = 2.0
ROUGH_SHARE = 0.2
"""By which lines, floor and speeds may differ in their change, at least or as a share of the change."""
LOOSE_IMPACTS = 0.5
"""Growth of the kurtosis of the bands that changed: a filter makes no impacts."""
CREST_DB = 4.0
"""Growth of the mean over the quiet moments, a quarter of the wide bands above, that weighs as a kurtosis of one does
(impacts too dense for narrow bands to part them)."""
QUIET_SHARE = 0.2
OTHERS_SHARE = 0.3
"""By which, of its change, other channels may have changed for it to be remarked; a fault needs them quiet."""
SWAP_SHARE = 0.5
SWAP_DB = 3.0


def compared(pairs: Sequence[Pair], tests: Sequence[Recording]) -> tuple[Finding, ...]:
    """Findings that hold at every speed for which there is a baseline."""
    if not pairs:
        return ()
    names = pairs[0].names
    if any(p.names != names for p in pairs):
        return ()
    swaps = swapped(pairs, tests)
    if swaps:
        return swaps
    change = [p.test - p.baseline for p in pairs]
    found: list[Finding] = []
    quantities = [channel.quantity for channel in pairs[0].channels]
    lines = [np.concatenate([p.lines_db[c] for p in pairs]) for c in range(len(names))]
    floors = [float(np.percentile(_all_bands(change, c), FLOOR_SHARE)) for c in range(len(names))]
    common = common_unit_gains(lines, floors, quantities)
    for c, name in enumerate(names):
        gain, roughly = _gain(change, c), even_unit_gain(change, c, quantities)
        unit_gain = roughly if roughly is not None else robust_unit_gain(pairs, c)
        by_lines = unit_gain is None and common[c] is not None
        unit_gain = common[c] if by_lines else unit_gain
        likely = gain if gain is not None else unit_gain
        if likely is not None and denied(likely, lines[c]):
            continue
        if gain is not None:
            found.append(_gain_finding(gain, change, c, name, quantities))
        elif unit_gain is not None:
            unit = unit_of(unit_gain, np.inf, possible(quantities[c]))
            told = by_lines and lines[c].size >= LEAST_LINES
            seen, what = (lines[c], "strong lines") if told else (_all_bands(change, c), "bands")
            found.append(unit_finding(unit_gain, str(unit), name, seen, what))
        elif len(names) > 1:
            found += _loose(pairs, change, c, name)
    # all channels by one gain is a change of load or level unless it is a unit
    everywhere = len(found) == len(names) and len(names) > 1 and all(f.kind == "gain_change" for f in found)
    return () if everywhere else tuple(found)


def _gain(change: Sequence[FloatArray], c: int) -> float | None:
    """The one gain, dB, that all bands, lines and floor, of channel `c` changed by at all speeds, or None."""
    values = _all_bands(change, c)
    middle = float(np.median(values))
    quarter = float(np.subtract(*np.percentile(values, [75, 25]))) / 2
    edge = float(np.max(np.abs([np.median(d[c]) - middle for d in change])))
    tail = float(np.percentile(np.abs(values - middle), 95))
    loud = abs(middle) > GAIN_DB and quarter < GAIN_SPREAD_DB and edge < GAIN_SPREAD_DB
    return middle if loud and tail < max(3.0, 0.25 * abs(middle)) else None


def _all_bands(change: Sequence[FloatArray], c: int) -> FloatArray:
    """The changes, dB, of all bands of channel `c`, lines and floor, at all speeds."""
    return np.concatenate([d[c].ravel() for d in change])


def _gain_finding(gain: float, change: Sequence[FloatArray], c: int, name: str, quantities: Sequence[str]) -> Finding:
    unit = unit_of(gain, ratios=possible(quantities[c]))
    if unit is not None:
        return unit_finding(gain, unit, name, _all_bands(change, c))
    others = [float(np.median(np.abs(d[k]))) for d in change for k in range(len(quantities)) if k != c]
    quiet = bool(others) and max(others) < max(QUIET_DB, 0.3 * abs(gain))
    detail = f"all bands changed by {gain:+.1f} dB alike" + ("" if others else "; there is no other channel to compare")
    return Finding(
        kind="gain_change",
        channel=name,
        recording="all tests",
        detail=detail,
        severity=float(min(1.0, abs(gain) / 20)),
        fault=quiet,
        gain_db=gain,
    )


def _loose(pairs: Sequence[Pair], change: Sequence[FloatArray], c: int, name: str) -> list[Finding]:
    """A filter on one channel: bands changed, lines as the floor, alike at all speeds, no impacts, others quiet."""
    shared = reduce(np.intersect1d, [p.band for p in pairs])
    if not shared.size:
        return []
    places = [np.searchsorted(p.band, shared) for p in pairs]
    own = np.stack([d[c][:, at] for d, at in zip(change, places, strict=True)])
    curve = np.mean(own, axis=(0, 1))
    changed = np.abs(curve) > LOOSE_BAND_DB
    size = float(np.max(np.abs(curve)))
    if size < LOOSE_DB or not np.any(changed):
        return []
    rough = float(np.median(np.max(np.abs(own - curve)[:, :, changed], axis=(0, 1))))
    impacts = max(float(np.median(p.impacts[c, at][changed])) for p, at in zip(pairs, places, strict=True))
    crests = [float(np.percentile(p.crest_change[c], 75)) / CREST_DB for p in pairs if p.crest_change.size]
    impacts = max([impacts, *crests])  # records of a fraction of a second have none
    rest = [k for k in range(len(pairs[0].names)) if k != c]
    others = [d[k, 0, at][changed] for d, at in zip(change, places, strict=True) for k in rest]
    loudest = max(float(np.median(np.abs(o))) for o in others)
    if rough > max(LOOSE_ROUGH_DB, ROUGH_SHARE * size) or impacts > LOOSE_IMPACTS or loudest > OTHERS_SHARE * size:
        return []
    top = int(np.argmax(np.abs(curve)))
    centre_hz = pairs[0].centre_hz[places[0]]
    hz = float(centre_hz[top])
    detail = f"its transfer changed by up to {curve[top]:+.0f} dB around {hz:.4g} Hz, lines and noise alike; "
    quiet = loudest <= max(2 * QUIET_DB, QUIET_SHARE * size)
    detail += f"the other channels changed by {loudest:.1f} dB there"
    return [
        Finding(
            kind="loose_sensor",
            channel=name,
            recording="all tests",
            detail=detail,
            severity=float(min(1.0, size / 20)),
            where=f"{hz:.4g} Hz",
            fault=quiet,
            transfer_db=tuple(zip(map(float, centre_hz), map(float, curve), strict=True)),
        )
    ]


def swapped(pairs: Sequence[Pair], tests: Sequence[Recording]) -> tuple[Finding, ...]:
    """`swapped_channels` where exchanging channels of one unit makes the tests look like the baselines."""
    order = swap_order(pairs, tests)
    names = pairs[0].names
    return tuple(
        Finding(
            kind="swapped_channels",
            channel=name,
            recording="all tests",
            detail=f"looks like the baseline's {names[order[c]]}, not like its own",
            severity=1.0,
            fault=True,
        )
        for c, name in enumerate(names)
        if order[c] != c
    )


def swap_order(pairs: Sequence[Pair], tests: Sequence[Recording]) -> tuple[int, ...]:
    """For each channel of the tests the channel of the baselines whose signal it carries."""
    names = pairs[0].names
    n = len(names)
    same = tuple(range(n))
    if n < 2:
        return same
    cost = np.zeros((n, n))
    for p in pairs:
        gap = p.test[:, np.newaxis] - p.baseline[np.newaxis]
        cost += np.sqrt(np.mean(gap**2, axis=(2, 3))) / len(pairs)
    units = [tests[0].channels[tests[0].names.index(name)].unit for name in names]
    foreign = np.array([[a != b for b in units] for a in units])
    rows, columns = linear_sum_assignment(np.where(foreign, 1e6, cost))
    moved = [(i, j) for i, j in zip(rows, columns, strict=True) if i != j]
    if not moved:
        return robust_swap_order(pairs, foreign)
    now = float(np.mean([cost[i, j] for i, j in moved]))
    before = float(np.mean([cost[i, i] for i, _ in moved]))
    if now < SWAP_SHARE * before and now < SWAP_DB + 0.2 * before:
        return tuple(int(j) for j in columns)
    return robust_swap_order(pairs, foreign)
