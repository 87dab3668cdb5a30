"""Tooth faults against a baseline: sidebands of one shaft around the mesh grow, and the mean turn shows where.

A local tooth fault modulates the mesh once a turn of its gear: sidebands at many multiples of that shaft's order rise
(P. D. McFadden, "Detecting fatigue cracks in gears by amplitude and phase demodulation of the meshing vibration",
J. Vib. Acoust. 108 (1986) 165-170). Load, mounting and transfer path change mesh lines and the sidebands beside them
alike; so each sideband is held against the mesh line it surrounds, and what counts is modulation that has grown. A
speed that wanders modulates the mesh as well, at no multiple of a shaft: in short recordings it reaches the sidebands
of slow shafts, but then also the places half-way between them, above which they must stand.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from reconcile.kinematics.families import Ties
from reconcile.kinematics.lines import OrderLines, at_half_of_speeds, level_changes, matched, order_lines
from reconcile.kinematics.observe import Observation
from reconcile.observe.turn import LocalEnergy, local_energy, prominence, window_of
from reconcile.verdict import AngleWindow
from signals.series import FloatArray

MESHES = 5
SIDEBANDS = 8
GROWTH_DB = 6.0
HALF_WIDTH = 0.3
"""Over which a line's power is summed, share of the smallest distance of sidebands."""
ERRORS = 4.0
MIN_LINES = 8
NEAR_DB = 3.0
"""Up to which two gears of a mesh have grown alike."""
CONTRAST_DB = 6.0
CONTRAST_WIDTH = 0.1
"""Share of the distance of sidebands to each side of a place: nothing of the sideband itself reaches half-way."""
MIN_MULTIPLES = 3
"""A tooth is short against a turn: runout and a speed that wanders reach the first multiple, seldom the second."""


@dataclass(frozen=True, kw_only=True)
class GearEvidence:
    """Growth of the sidebands of a gear's shaft against their mesh lines in the channel that shows it most."""

    mesh: str
    shaft: str
    gear: str
    channel: str
    growth_db: float
    error_db: float
    mesh_growth_db: float
    lines: int
    window: AngleWindow | None
    label: str
    contrast_db: float
    """Of the sidebands over the places half-way between them, in this test."""
    multiples: int
    """Of the shaft, at which sidebands have grown."""
    own_db: float = float("nan")
    """Growth of those that no sideband of the other gear's shaft is near, if there are any, else of all; NaN where none
    is there."""
    seldom: bool = False
    """Whether it has grown, but at fewer than half of the speeds."""

    @property
    def grown(self) -> bool:
        """Whether the growth is that of a fault."""
        firm = self.lines >= MIN_LINES and self.growth_db > ERRORS * self.error_db and not self.seldom
        local = self.multiples >= MIN_MULTIPLES and self.contrast_db > CONTRAST_DB
        return firm and local and self.growth_db > GROWTH_DB


def gear_evidence(
    tests: Sequence[Observation], baselines: Sequence[Observation], ties: Ties
) -> tuple[GearEvidence, ...]:
    """One entry a mesh and shaft, the strongest growth first; empty without a baseline at the same speed."""
    found: dict[tuple[str, str], list[tuple[float, GearEvidence]]] = {}
    for test in tests if ties.meshes else ():
        best: dict[tuple[str, str], GearEvidence] = {}
        base = matched(test, baselines)
        if base is None:
            continue
        for channel in (n for n in test.recording.names if n in base.recording.names):
            now, before = order_lines(test, channel), order_lines(base, channel)
            if now is None or before is None:
                continue
            for mesh in ties.meshes:
                for side in (0, 1):
                    one = _one(test, base, channel, (now, before), mesh, side, ties)
                    key = (one.mesh, one.shaft)
                    if key not in best or (one.grown, one.growth_db) > (best[key].grown, best[key].growth_db):
                        best[key] = one
        for key, one in best.items():
            found.setdefault(key, []).append((test.speed.speed_hz, one))
    return tuple(sorted(map(_of_most, found.values()), key=lambda g: (-g.grown, -g.growth_db)))


def of_own_lines(tied: Sequence[GearEvidence]) -> list[GearEvidence]:
    """Of gears in one mesh whose sidebands grew alike those that stay when the lines near the other's are left out:
    multiples of one shaft lie within the width of another's, whatever the teeth."""
    best = max((g.own_db for g in tied if np.isfinite(g.own_db)), default=-np.inf)
    return [g for g in tied if not g.own_db < best - NEAR_DB] if best > GROWTH_DB / 2 else list(tied)


def _of_most(tests: Sequence[tuple[float, GearEvidence]]) -> GearEvidence:
    """The evidence of the test that shows it most; it has grown only where it has at half of the speeds."""
    first = max((one for _, one in tests), key=lambda g: (g.grown, g.growth_db))
    rare = first.grown and not at_half_of_speeds([(speed, one.grown) for speed, one in tests])
    return replace(first, seldom=True) if rare else first


def sideband_orders(mesh_order: float, shaft: float, other: float, half_width: float = 1e-6) -> FloatArray:
    """k z +- m of a shaft, without those within `half_width` of the other shaft's; of a common multiple of both without
    none, if all are. (lines,)."""
    orders = [
        k * mesh_order + sign * m * shaft
        for k in range(1, MESHES + 1)
        for m in range(1, SIDEBANDS + 1)
        for sign in (-1, 1)
    ]
    values = np.asarray(orders)
    offset = np.abs(values - np.rint(values / mesh_order) * mesh_order)
    shared = np.abs(offset - np.rint(offset / other) * other) < half_width
    return np.sort(values[(values > 0) & ~shared]) if not np.all(shared) else np.sort(values[values > 0])


def _one(
    test: Observation,
    base: Observation,
    channel: str,
    lines: tuple[OrderLines, OrderLines],
    mesh: tuple[str, float, tuple[str, str], tuple[str, str]],
    side: int,
    ties: Ties,
) -> GearEvidence:
    name, order, shafts, gears = mesh
    ratio, other = ties.shafts[shafts[side]], ties.shafts[shafts[1 - side]]
    half = HALF_WIDTH * min(ratio, other)
    orders = sideband_orders(order, ratio, other)
    harmonics = np.arange(1.0, MESHES + 1.0) * order
    mesh_change = level_changes(*lines, harmonics, half)
    beside = np.clip(np.rint(orders / order).astype(np.int64) - 1, 0, MESHES - 1)
    growth = level_changes(*lines, orders, half) - mesh_change[beside]
    there = np.isfinite(growth)
    values = growth[there]
    apart = there & np.isin(orders, sideband_orders(order, ratio, other, half))
    mean = float(np.mean(values)) if values.size else 0.0
    error = float(np.std(values) / np.sqrt(values.size)) if values.size > 1 else 10.0
    teeth = round(order / ratio)
    window = None
    if values.size >= MIN_LINES and mean > GROWTH_DB / 2:
        window = _window(test, base, channel, shafts[side], ratio, teeth)
    return GearEvidence(
        mesh=name,
        shaft=shafts[side],
        gear=gears[side],
        channel=channel,
        growth_db=mean,
        error_db=max(error, 0.5),
        mesh_growth_db=float(np.nanmean(mesh_change)) if np.any(np.isfinite(mesh_change)) else 0.0,
        lines=int(values.size),
        window=window,
        label=test.label,
        multiples=int(np.unique(_multiples(orders, order, ratio)[there & (growth > GROWTH_DB)]).size),
        contrast_db=_contrast(lines[0], orders[there], (order, ratio, other)),
        own_db=float(np.mean(growth[apart])) if np.any(apart) else float("nan"),
    )


def _multiples(orders: FloatArray, mesh_order: float, ratio: float) -> FloatArray:
    """Of a shaft of `ratio`, by which sidebands at `orders` (n,) stand off their mesh line, (n,)."""
    return np.asarray(np.rint(np.abs(orders - np.rint(orders / mesh_order) * mesh_order) / ratio), dtype=np.float64)


def _contrast(now: OrderLines, orders: FloatArray, mesh: tuple[float, float, float]) -> float:
    """Mean of the sidebands at `orders` (n,) over the places half a distance to both sides of them, dB.

    `mesh`: orders of the mesh, of the shaft and of the other shaft; a place at whose multiple counts only where all do.
    """
    order, ratio, other = mesh
    half = CONTRAST_WIDTH * ratio
    power, _ = now.within(orders, half)
    beside = []
    for step in (-ratio / 2, ratio / 2):
        away = np.abs(orders + step - np.rint(orders / order) * order) / other
        level, _ = now.within(orders + step, half)
        beside.append(np.where(np.abs(away - np.rint(away)) * other > half, level, np.nan))
    places = np.array(beside)
    if not np.any(np.isfinite(places)):
        places = np.array([now.within(orders + step, half)[0] for step in (-ratio / 2, ratio / 2)])
    told = np.isfinite(power) & np.any(np.isfinite(places), axis=0)
    if not np.any(told):
        return 0.0
    levels = 10 * np.log10(places[:, told])
    return float(np.mean(10 * np.log10(power[told]) - np.nanmean(levels, axis=0)))


def _window(
    test: Observation, base: Observation, channel: str, shaft: str, ratio: float, teeth: int
) -> AngleWindow | None:
    """Where in the turn the residual gathers, if it does so more than in the baseline."""
    now, before = (_energy(x, channel, shaft, ratio, teeth) for x in (test, base))
    if now is None or not prominence(now, before):
        return None
    return window_of(now, shaft=shaft)


def _energy(observation: Observation, channel: str, shaft: str, ratio: float, teeth: int) -> LocalEnergy | None:
    e = observation.channel(channel)
    assert e is not None
    series = observation.recording.series(channel)
    return local_energy(series, shaft=shaft, rotation=e.angle_rad, ratio=ratio, teeth=teeth)
