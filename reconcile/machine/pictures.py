"""What the page draws: spectra with and without the answer, changed features, ranking, energy over a shaft's turn."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace

import numpy as np
from scipy.ndimage import uniform_filter1d

from reconcile.calibrate.chain import band_centres_hz
from reconcile.judge.changes import Lens
from reconcile.judge.scatter import evidence_intervals
from reconcile.judge.screen import Screen
from reconcile.machine.setting import Found, Setting
from reconcile.machine.weigh import variants
from reconcile.observe.features import Layout
from reconcile.observe.observation import PointData
from reconcile.observe.steady import Steady
from reconcile.observe.watch import bases_at
from reconcile.verdict import AngleWindow, Cause, Report
from signals.series import FloatArray
from sim.core.spec import MachineSpec

MOST_RANKED = 10
TURN_BINS = 72
PITCH_BINS = 11
"""Of a pitch of the teeth: an odd number has a middle."""


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
    """Third-octave spectra of every operating point and channel: observed, without and with the answer."""
    part = layout.slices()["total"]
    found = []
    for p, one in enumerate(data):
        for c, name in enumerate(channels):
            before = _reference(one, lens[p], c, part)
            start = (p * len(channels) + c) * layout.size
            change = None if fitted_db is None else fitted_db[start : start + layout.size][part]
            shown = {
                "frequency_hz": band_centres_hz(),
                "observed_db": 10.0 * np.log10(np.maximum(one.test.total[c], 1e-300)),
                "before_db": before,
                "after_db": before + (0.0 if change is None else change),
            }
            lists = {key: np.round(values, 3).tolist() for key, values in shown.items()}
            found.append({"channel": name, **place_of(one), **lists})
    return found


def place_of(one: PointData) -> dict[str, float]:
    """The operating point, as pictures and lines tell it."""
    return {"speed_hz": one.point.speed_hz, "torque_ratio": one.point.torque_ratio}


def forms(screen: Screen) -> dict[str, str]:
    """Label of every form that counts under a stronger one of the same effect, and that one's label."""
    heads: list[str] = []
    found = {}
    for k in np.argsort(-screen.weights):
        name = screen.names[int(k)]
        head = next((h for h in heads if variants(h, name)), None)
        if head is None:
            heads.append(name)
        else:
            found[name] = head
    return found


def with_forms(causes: Sequence[Cause], screen: Screen) -> tuple[Cause, ...]:
    """The causes with those of their other forms that are among the best, as in `ranking`."""
    heads = forms(screen)
    best = [(screen.names[k], float(screen.evidence[k])) for k in _best(screen)]
    return tuple(
        replace(c, forms={n.split("@")[0]: score for n, score in best if heads.get(n) == f"{c.term}@{c.site}"})
        for c in causes
    )


def _best(screen: Screen) -> list[int]:
    return [int(k) for k in np.argsort(-screen.evidence)[:MOST_RANKED]]


def ranking(setting: Setting, found: Found, named: Collection[str]) -> list[dict[str, object]]:
    """The best ten candidates, and those that are `named` wherever they stand alone, with their evidence as the only
    effect and its 90 % interval."""
    screen = found.screen
    intervals = evidence_intervals(found.views, setting.changes, screen.evidence, setting.seed)
    best = _best(screen)
    shown = {screen.names[k] for k in best}
    heads = forms(screen)
    return [
        {
            "label": screen.names[k],
            "score": float(screen.evidence[k]),
            "low": float(intervals[0, k]),
            "high": float(intervals[1, k]),
            "named": screen.names[k] in named,
            "form_of": heads.get(screen.names[k], ""),
        }
        for k in (*best, *(screen.names.index(name) for name in named if name in screen.names and name not in shown))
    ]


def as_named(report: Report) -> Report:
    """The report whose ranking marks what its causes name: names may be taken back after it was drawn."""
    rows = report.pictures.get("ranking")
    if not isinstance(rows, list):
        return report
    told = {f"{c.term}@{c.site}" for c in report.causes if c.named}
    marked = [{**row, "named": row["label"] in told} for row in rows]
    return replace(report, pictures={**report.pictures, "ranking": marked})


def turn_maps(
    machine: MachineSpec, data: Sequence[PointData], channels: Sequence[str], window: AngleWindow | None
) -> list[dict[str, object]]:
    """Energy of the upper half of the spectrum folded on a shaft's turn, at every operating point, in dB over the
    baseline's mean: on the shaft of `window`, else on the drive shaft; where that carries a gear, mean of a pitch of
    its teeth, as every tooth has its own swell."""
    if machine.operating is None:
        return []
    shaft = window.shaft if window is not None else machine.operating.shaft
    turning = [s.name for s in machine.shafts]
    teeth = next((g.teeth for g in machine.gears if g.shaft == shaft), None)
    angle = (np.arange(TURN_BINS) + 0.5) * 360.0 / TURN_BINS
    maps = []
    for one in data:
        now, before = one.spectra
        ratio = bases_at(machine, now.speed_hz)[f"f_r{turning.index(shaft) + 1}"] / now.speed_hz
        rows = []
        for c in range(len(channels)):
            fold = _folded(now, c, ratio, teeth)
            rest = _folded(before, c, ratio, teeth) if before else fold
            rows.append(np.round(10.0 * np.log10(fold / rest.mean()), 3).tolist())
        maps.append(
            {
                "shaft": shaft,
                **place_of(one),
                "angle_deg": angle.tolist(),
                "rows": list(channels),
                "value": rows,
                "value_label": f"energy, dB over the mean of the {'baseline' if before else 'turn'}",
            }
        )
    return maps


def _folded(one: Steady, channel: int, ratio: float, teeth: int | None) -> FloatArray:
    """Mean energy (TURN_BINS,) over the turn of the shaft that makes `ratio` turns a turn of the drive shaft; with
    `teeth`, of a pitch of them."""
    rough = np.diff(one.samples[channel])
    turn = ratio * (one.start_turns + np.arange(rough.size) * one.speed_hz / one.rate_hz) % 1.0
    count = TURN_BINS if teeth is None else PITCH_BINS * teeth
    bins = np.minimum((turn * count).astype(int), count - 1)
    energy = np.bincount(bins, weights=rough**2, minlength=count)
    mean = energy / np.maximum(np.bincount(bins, minlength=count), 1) + 1e-300
    if teeth is None:
        return np.asarray(mean)
    even = uniform_filter1d(mean, PITCH_BINS, mode="wrap")
    at, middle = ((np.arange(n) + 0.5) / n for n in (TURN_BINS, count))
    return np.asarray(np.interp(at, middle, even, period=1.0))
