"""Aliases: lines folded at the sampling rate, which move against the speed.

A line of order k beyond Nyquist appears at |k f - m f_s|: as the shaft turns faster by df it moves by +-k df, with k
of tens or hundreds, which no mechanism of the machine does at so low a frequency. Two tests: in one record whose
speed wanders, the frequency of the line is compared with the angle of the shaft; over records at several speeds,
lines are matched with the places where the orders of the meshes fold to.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reconcile.gate.findings import Finding
from reconcile.speed.excess import line_excess
from signals.recording import Recording
from signals.series import FloatArray

WITHIN = np.arange(-2, 3)[:, np.newaxis]
PRESENT_DB = 15.0
GROWN_DB = 8.0
HARMONICS = 24
MOST_FOLDS = 8
CONTROLS = 200
CHANCE = 0.005
MIN_SEPARATION = 3.0
"""Bins by which a folded line must be away from every line of the machine."""


def alias_findings(
    records: Sequence[tuple[Recording, float]],
    labels: Sequence[str],
    mesh_orders: Sequence[float],
    baselines: Sequence[tuple[Recording, float]],
    *,
    seed: int = 0,
) -> tuple[Finding, ...]:
    """`alias` for each channel. `records`: (recording, speed of the shaft in Hz); `mesh_orders`: teeth of its gears.

    The statistic is the mean growth (over the baseline nearest in speed; else the level, both dB over the floor) at
    the folded places over all records; 200 sets of shifted places say what chance reaches.
    """
    if not mesh_orders or not records:
        return ()
    rng = np.random.default_rng(seed)
    found = []
    for name in records[0][0].names:
        if any(name not in r.names for r, _ in records):
            continue
        best = max((_tested(records, baselines, name, z, rng) for z in mesh_orders), key=lambda t: (-t[0], t[1]))
        chance, growth, order, places = best
        if chance <= CHANCE and growth > GROWN_DB and len(places) >= 2:
            where = ", ".join(f"{hz:.5g} Hz at {speed:.4g} Hz" for hz, speed in places[:6])
            found.append(
                Finding(
                    kind="alias",
                    channel=name,
                    recording=labels[0],
                    detail=f"lines where multiples of order {order:g} fold to, {growth:.0f} dB above chance",
                    severity=float(min(1.0, growth / 40)),
                    where=where,
                    fault=True,
                )
            )
    return tuple(found)


def folded_hz(order: float, speed_hz: float, sampling_rate_hz: float) -> FloatArray:
    """Where the multiples of an order beyond Nyquist appear, shape (lines,), Hz."""
    true = order * speed_hz * np.arange(1, HARMONICS + 1)
    true = true[(true > sampling_rate_hz / 2) & (true < MOST_FOLDS * sampling_rate_hz)]
    return np.asarray(np.abs(true - np.rint(true / sampling_rate_hz) * sampling_rate_hz), dtype=np.float64)


def _tested(
    records: Sequence[tuple[Recording, float]],
    baselines: Sequence[tuple[Recording, float]],
    name: str,
    order: float,
    rng: np.random.Generator,
) -> tuple[float, float, float, list[tuple[float, float]]]:
    """(chance, growth in dB, order, places found) of a mesh order's folded lines in one channel."""
    growths: list[FloatArray] = []
    controls: list[FloatArray] = []
    places: list[tuple[float, float]] = []
    for recording, speed in records:
        level, resolution = _levels(recording, name)
        hz = _clear(folded_hz(order, speed, recording.sampling_rate_hz)[:8], order, speed, resolution)
        near = min(baselines, key=lambda b: abs(b[1] - speed), default=None)
        before = _levels(near[0], name) if near is not None and name in near[0].names else None
        growth = _growth(level, resolution, before, hz)
        growths.append(growth)
        places += [(float(f), speed) for f, g in zip(hz, growth, strict=True) if g > GROWN_DB]
        shift = rng.uniform(0.02, 0.2, (CONTROLS, 1)) * rng.choice([-1.0, 1.0], (CONTROLS, 1))
        shifted = np.abs(hz * (1 + shift)) + resolution * 5
        controls.append(np.stack([_growth(level, resolution, before, row) for row in shifted]))
    values = np.concatenate(growths)
    if values.size == 0:
        return 1.0, 0.0, order, []
    mean = float(np.mean(values))
    chance = np.mean(np.concatenate(controls, axis=1), axis=1)
    share = (1 + float(np.sum(chance >= mean))) / (1 + CONTROLS)
    return share, mean - float(np.median(chance)), order, places


def _levels(recording: Recording, name: str) -> tuple[FloatArray, float]:
    """Power over the floor, dB (0 in the noise), and resolution, Hz."""
    excess, resolution = line_excess(recording.series(name))
    return np.maximum(10 * np.log10(excess + 1e-12) - 8.0, 0.0), resolution


def _growth(
    level: FloatArray, resolution: float, before: tuple[FloatArray, float] | None, hz: FloatArray
) -> FloatArray:
    """Level at `hz` less that of the baseline at the same frequency, dB, shape (lines,)."""
    now = _at(level, resolution, hz)
    return now if before is None else np.maximum(now - _at(before[0], before[1], hz), -10.0)


def _at(level: FloatArray, resolution: float, hz: FloatArray) -> FloatArray:
    """Largest level within two bins, shape (lines,)."""
    place = np.clip(np.rint(hz / resolution).astype(np.int64), 2, level.size - 3)
    return np.asarray(np.max(level[place + WITHIN], axis=0), dtype=np.float64)


def _clear(hz: FloatArray, order: float, speed: float, resolution: float) -> FloatArray:
    """Without places near the machine's own lines (multiples of the mesh with five sidebands, shaft harmonics)."""
    mesh = order * speed
    nearest = np.rint(hz / speed) * speed
    own = (np.abs(hz - nearest) < MIN_SEPARATION * resolution) & (
        (hz < 12 * speed) | (np.abs(nearest - np.rint(nearest / mesh) * mesh) < 5.5 * speed)
    )
    return hz[~own & (hz > 10 * resolution)]
