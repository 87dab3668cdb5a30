"""How well a feature of one recording is known: standard deviations by the noise and the length of the record."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reconcile.calibrate.chain import Chain
from reconcile.observe.features import SHAPE_DB, SOFT, Scale
from reconcile.observe.phases import phase_deviations
from reconcile.observe.statistics import LOBE, LOBE_SCATTER, SHAPE_BANDS_HZ, Statistics, third_octaves
from reconcile.observe.watch import MESH_ORDERS, WatchList
from signals.series import FloatArray

UNSTEADY_DB = {"line": 1.0, "floor": 0.7, "total": 0.7, "depth": 1.0, "turn": 2.0, "kurtosis": 3.0, "skewness": 3.0}
"""What repeated recordings of a sound machine differ by beside noise and drift: speed wander left after tracking,
phases of balls, which moments of few impacts feel most. Set on the development nulls."""
UNSTEADY_PHASE_DB = 0.5
"""Of a phase between sensors: sound machines of the development split differ by a median of 0.2 to 0.4."""
LOW_SHAPE_DB = {"kurtosis": 12.0, "skewness": 18.0}
"""The same in the lowest band, where the moments are those of few lines and follow their phases."""
WANDER_DB, WANDER_FALL_HZ, NEAREST_HZ = 19.0, 6.4, 6.4
"""Sidebands of the mesh at a shaft's multiples rise and fall together with slow wander of the speed, the less the
farther they stand from it: by so much, falling to 1/e within so many Hz, and no more nearer than was measured. Between
recordings of 48 sound machines of the proof (one gearbox, its numbers drawn anew each time) their common level differs
by 7.3 dB 6.4 Hz from the line, 4.6 at 8.5, 3.3 at 11 to 13, 1.2 at 17 to 19 and 0.8 from 22 on, where single lines'
noise is all."""
OWN_WANDER_DB = 4.0
"""What one sideband differs from the others by so, at most."""
SMEAR_DB = 3.0
"""What is left of the wander takes from the highest watched mesh harmonic, on all sensors alike: as the square of the
order, since the phase of a harmonic errs in proportion to it."""
LEAST_WANDER_DB = 0.5
"""Below which it is nothing: from 23 Hz on."""
DB = 10.0 / np.log(10.0)
MEDIAN_LOSS = 1.44
"""Standard deviation of the logarithm of a median of exponentials over that of their mean: 1/ln 2."""


def measured_db(
    seen: Statistics,
    chain: Chain,
    lines_hz: FloatArray,
    scale: Scale,
    phased: Sequence[int],
    fallen: FloatArray | float = 0.0,
) -> FloatArray:
    """(C, F): deviations of the soft features. A line of power P in noise n varies by sqrt(2 P n + n^2).

    `fallen` (C, L), unit^2/Hz: what fell upon the lines beside the sensors' noise.
    """
    noise = (chain.line_noise(lines_hz) + fallen) * seen.resolution_hz
    lobe, scatter = LOBE * noise, LOBE_SCATTER * noise
    power = np.maximum(seen.line - lobe, 0.0)
    line = DB * np.sqrt(2.0 * power * noise + scatter**2) / (seen.line + SOFT * lobe)
    widths = np.diff(third_octaves())
    band = np.broadcast_to(DB / np.sqrt(widths * seen.duration_s), seen.floor.shape)
    shapes = np.array([high - low for low, high in SHAPE_BANDS_HZ])
    deep = np.broadcast_to((2.0 * seen.resolution_hz / shapes)[None, :, None], seen.depth.shape)
    depth = DB * np.sqrt(2.0 * seen.depth * deep + (LOBE_SCATTER * deep) ** 2) / (seen.depth + SOFT * LOBE * deep)
    still = np.broadcast_to(scale.turn_noise, seen.turn.shape)
    turn = DB * np.sqrt(2.0 * seen.turn * still + still**2) / (seen.turn + SOFT * still)
    turn = turn.reshape(turn.shape[0], -1)
    moment = np.broadcast_to(SHAPE_DB * np.sqrt(12.0 / (shapes * seen.duration_s)), seen.kurtosis.shape)
    kept = list(phased)
    phase = phase_deviations(power[:, kept], lobe[:, kept])
    parts = [line, MEDIAN_LOSS * band, band, depth.reshape(depth.shape[0], -1), turn, moment, moment, phase]
    return np.concatenate(parts, axis=-1)


def unsteady_db(seen: Statistics, watched: WatchList, lines_hz: FloatArray) -> FloatArray:
    """(F,): deviation of one channel's features between repeated recordings, beside noise and drift."""
    sizes = {
        "line": seen.line.shape[1],
        "floor": seen.floor.shape[1],
        "total": seen.total.shape[1],
        "depth": seen.depth.shape[1] * seen.depth.shape[2],
        "turn": seen.turn.shape[1] * seen.turn.shape[2],
        "kurtosis": seen.kurtosis.shape[1],
        "skewness": seen.skewness.shape[1],
    }
    rows = {name: np.full(n, UNSTEADY_DB[name]) for name, n in sizes.items()}
    rows["phase"] = np.full(seen.phase.shape[1], UNSTEADY_PHASE_DB)
    for name, value in LOW_SHAPE_DB.items():
        rows[name][0] = value
    near = np.minimum(wander_db(watched, lines_hz), OWN_WANDER_DB)
    rows["line"] = np.maximum(rows["line"], near)
    return np.concatenate(list(rows.values()))


def wander_db(watched: WatchList, lines_hz: FloatArray) -> FloatArray:
    """(L,): deviation of sidebands so near to their mesh line that the speed's own slow wander makes some of them."""
    mesh = {w.label: hz for w, hz in zip(watched.lines, lines_hz, strict=True) if w.family == "mesh"}
    found = np.zeros(len(watched.lines))
    for i, line in enumerate(watched.lines):
        if line.family == "sideband":
            base, order = next((b, n) for b, n in line.orders.items() if not b.startswith("f_r"))
            away = abs(lines_hz[i] - mesh.get(f"{order:g}*{base}", np.inf))
            found[i] = WANDER_DB * np.exp(-max(away, NEAREST_HZ) / WANDER_FALL_HZ)
    return np.where(found < LEAST_WANDER_DB, 0.0, found)


def smear_pattern(watched: WatchList, features: int) -> FloatArray:
    """(F,): what one deviation of unsteadiness left after following the angle takes from the mesh, dB."""
    pattern = np.zeros(features)
    for i, line in enumerate(watched.lines):
        if line.family == "mesh":
            pattern[i] = SMEAR_DB * (max(line.orders.values()) / MESH_ORDERS) ** 2
    return pattern


def wander_patterns(watched: WatchList, lines_hz: FloatArray, features: int) -> FloatArray:
    """(shafts + 1, F): what one deviation of wander does around each shaft's sidebands of one channel, dB, and what
    is left of it takes from the mesh itself."""
    near = wander_db(watched, lines_hz)
    shafts = sorted({b for w in watched.lines if w.family == "sideband" for b in w.orders if b.startswith("f_r")})
    patterns = np.zeros((len(shafts), features))
    for row, shaft in enumerate(shafts):
        for i, line in enumerate(watched.lines):
            if shaft in line.orders:
                patterns[row, i] = near[i]
    return np.concatenate([patterns, smear_pattern(watched, features)[None]])
