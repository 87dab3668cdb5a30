"""What the page draws: spectra with and without the answer, changed features, ranking, energy over a shaft's turn."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reconcile.calibrate.chain import band_centres_hz
from reconcile.judge.changes import Changes, Lens
from reconcile.judge.scatter import evidence_intervals
from reconcile.machine.setting import Found, Setting
from reconcile.observe.features import Layout
from reconcile.observe.observation import PointData
from reconcile.observe.watch import WatchList
from reconcile.verdict import LineChange
from signals.series import FloatArray

MOST_LINES = 15
STANDS_OUT = 3.0
TURN_BINS = 72
FOLLOWS = {
    "f_o": "outer ring of bearing",
    "f_i": "inner ring of bearing",
    "f_b": "balls of bearing",
    "f_c": "cage of bearing",
    "f_m": "mesh",
    "f_r": "shaft",
}


def _reference(one: PointData, lens: Lens, channel: int, part: slice) -> FloatArray:
    if one.baseline is not None:
        return np.asarray(10.0 * np.log10(np.maximum(one.baseline.total[channel], 1e-300)))
    return np.asarray(lens.nominal[channel, part])


def spectra(
    data: Sequence[PointData],
    lens: Sequence[Lens],
    fitted_db: FloatArray | None,
    layout: Layout,
    channels: Sequence[str],
) -> list[dict[str, object]]:
    """Third-octave spectra of the first operating point, every channel: observed, without and with the answer."""
    part = layout.slices()["total"]
    found = []
    for c, name in enumerate(channels):
        before = _reference(data[0], lens[0], c, part)
        observed = 10.0 * np.log10(np.maximum(data[0].test.total[c], 1e-300))
        change = None if fitted_db is None else fitted_db[c * layout.size : (c + 1) * layout.size][part]
        found.append(
            {
                "channel": f"{name}, {data[0].point.speed_hz:g} Hz",
                "frequency_hz": band_centres_hz().tolist(),
                "observed_db": observed.tolist(),
                "before_db": before.tolist(),
                "after_db": (before + (0.0 if change is None else change)).tolist(),
            }
        )
    return found


def line_changes(
    data: Sequence[PointData], changes: Changes, layout: Layout, watched: WatchList, channels: Sequence[str]
) -> tuple[LineChange, ...]:
    """Watched lines that changed by more than three of their deviations, the largest first."""
    known = np.isfinite(changes.null).any(axis=0)
    drift = np.full(known.size, np.nan)
    drift[known] = np.nanstd(changes.null[:, known], axis=0)
    z = changes.observed / np.sqrt(changes.measured**2 + drift**2 + 1.0)
    rows: list[tuple[float, LineChange]] = []
    for p, one in enumerate(data):
        for c, name in enumerate(channels):
            start = changes.starts[p] + c * layout.size
            for i, line in enumerate(watched.lines):
                value = z[start + i]
                if np.isfinite(value) and abs(value) > STANDS_OUT:
                    found = LineChange(
                        label=line.label,
                        frequency_hz=float(one.lines_hz[i]),
                        change_db=float(changes.observed[start + i]),
                        channel=name,
                        locked_to=locked_to(line.orders),
                    )
                    rows.append((abs(float(value)), found))
    rows.sort(key=lambda row: -row[0])
    return tuple(found for _, found in rows[:MOST_LINES])


def locked_to(orders: object) -> str:
    """What a line's frequency follows: `mesh`, `bearing N`, or a shaft."""
    bases = list(orders) if isinstance(orders, dict) else []
    for prefix, word in FOLLOWS.items():
        for base in bases:
            if base.startswith(prefix):
                return f"{word} {base[3:]}".strip()
    return ""


def ranking(setting: Setting, found: Found, named: str | None) -> list[dict[str, object]]:
    """The best ten candidates with their evidence and its 90 % interval."""
    screen = found.screen
    intervals = evidence_intervals(found.views, setting.changes, screen.evidence, setting.seed)
    order = np.argsort(-screen.evidence)[:10]
    return [
        {
            "label": screen.names[k],
            "score": float(screen.evidence[k]),
            "low": float(intervals[0, k]),
            "high": float(intervals[1, k]),
            "named": screen.names[k] == named,
        }
        for k in map(int, order)
    ]


def turn_map(data: Sequence[PointData], channels: Sequence[str]) -> dict[str, object]:
    """Energy of the upper half of the spectrum folded on the drive shaft's turn, in dB over the baseline's mean."""
    now, before = data[0].spectra
    rows = []
    for c in range(len(channels)):
        fold = _folded(now.samples[c], now.rate_hz, now.speed_hz)
        rest = _folded(before.samples[c], before.rate_hz, before.speed_hz) if before else fold
        level = 10.0 * np.log10(fold / rest.mean())
        rows.append(level.tolist())
    angle = (np.arange(TURN_BINS) + 0.5) * 360.0 / TURN_BINS
    return {
        "shaft": "drive shaft, one row a sensor",
        "angle_deg": angle.tolist(),
        "order": [float(k + 1) for k in range(len(channels))],
        "value": rows,
    }


def _folded(samples: FloatArray, rate_hz: float, speed_hz: float) -> FloatArray:
    rough = np.diff(samples)
    turn = (np.arange(rough.size) * speed_hz / rate_hz) % 1.0
    bins = np.minimum((turn * TURN_BINS).astype(int), TURN_BINS - 1)
    energy = np.bincount(bins, weights=rough**2, minlength=TURN_BINS)
    return np.asarray(energy / np.maximum(np.bincount(bins, minlength=TURN_BINS), 1) + 1e-300)
