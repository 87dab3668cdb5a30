"""Faults that show against a baseline: gain, unit, swapped channels, a loose sensor.

A gain multiplies everything a channel hears by one number, a loose mount by a smooth function of frequency, lines and
noise alike, while the other channels hear what they heard. A defect adds: lines, modulation, impacts; it raises some
bands more than their lines, and its neighbours hear it too.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.optimize import linear_sum_assignment

from reconcile.gate.findings import Finding
from reconcile.gate.levels import Pair
from reconcile.gate.lines import FLOOR_SHARE, LEAST_LINES, common_unit_gains, denied, stayed
from reconcile.gate.loose import LEVEL_DB, QUIET_DB, loose_findings
from reconcile.gate.robust import robust_swap_order, robust_unit_gain
from reconcile.gate.units import edge_unit_gain, even_unit_gain, lowest_share, possible, unit_finding, unit_of
from signals.recording import Recording
from signals.series import FloatArray

GAIN_DB = 2.0
GAIN_SPREAD_DB = 1.0
"""Half of all bands within this of the median change: what repetition, load and a drift of a few per cent leave."""
LEAST_BESIDE, ALIKE_DB, LINES_DB = 2, 1.5, 4.0
"""Other channels, by how much their changes may differ (half of all bands), and strong lines may miss a gain that is
told beside them: 6 dB on a rotor are told within 0.1, by its lines within 1.2."""
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
    middles = [float(np.median(_all_bands(change, c))) for c in range(len(names))]
    common, edge = common_unit_gains(lines, floors, quantities), edge_unit_gain(change, quantities)
    for c, name in enumerate(names):
        gain, roughly = _gain(change, c), even_unit_gain(change, c, quantities)
        beside = _gain_beside(change, lines, c) if gain is None else None
        gain = gain if gain is not None else beside
        unit_gain = roughly if roughly is not None else robust_unit_gain(pairs, c)
        by_lines = unit_gain is None and common[c] is not None
        unit_gain = common[c] if by_lines else unit_gain
        by_edge = unit_gain is None and edge is not None
        unit_gain = edge if by_edge else unit_gain
        likely = gain if gain is not None else unit_gain
        if likely is not None and denied(likely, lines[c]):
            continue
        if gain is not None and stayed(gain, c, lines, middles):
            continue
        if gain is not None:
            one = _gain_finding(gain, change, c, name, quantities)
            found.append(replace(one, fault=True) if beside is not None else one)
        elif unit_gain is not None:
            unit = unit_of(unit_gain, np.inf, possible(quantities[c]))
            told = by_lines and lines[c].size >= LEAST_LINES
            seen, what = (lines[c], "strong lines") if told else (_all_bands(change, c), "bands")
            seen, what = (lowest_share(change, c), "bands that rose least") if by_edge else (seen, what)
            found.append(unit_finding(unit_gain, str(unit), name, seen, what))
        elif len(names) > 1:
            found += loose_findings(pairs, change, c, name)
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


def _gain_beside(change: Sequence[FloatArray], lines: Sequence[FloatArray], c: int) -> float | None:
    """That gain beside a level that all other channels share, dB, or None: a rattling bearing is louder in one record
    than in another by 2 dB throughout. Two other channels at least must say what it is; strong lines must agree."""
    if len(lines) < LEAST_BESIDE + 1:
        return None
    rest = [np.delete(d, c, axis=0) for d in change]
    if max(float(np.median(np.ptp(d, axis=0))) for d in rest) > ALIKE_DB:
        return None
    if max(abs(float(np.median(d))) for d in rest) > LEVEL_DB:
        return None
    gain = _gain([d - np.median(np.delete(d, c, axis=0), axis=0) for d in change], c)
    others = np.concatenate([one for k, one in enumerate(lines) if k != c])
    if gain is None or not lines[c].size or not others.size:
        return gain
    return gain if abs(float(np.median(lines[c]) - np.median(others)) - gain) <= LINES_DB else None


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
