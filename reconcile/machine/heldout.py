"""Stage 7: the fit on data it never saw, against retuning, an equal-parameter black box and placebos."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from reconcile.calibrate.chain import band_centres_hz
from reconcile.judge.changes import Changes, Lens
from reconcile.machine.library import Catalogued
from reconcile.observe.features import SOFT, Layout
from reconcile.verdict import HeldOut
from signals.series import FloatArray
from sim.terms import REGISTRY

NEAREST = 16
"""Draws a forecast is made of."""
MODEL_VARIANCE = 8.0
"""Of a feature, in squared deviations of measurement and drift: what no draw of the effect has. On sixteen development
cases 2, 8 and 25 gave much the same gains."""
FARTHEST = 25.0
"""Squared deviations of one feature that count at most."""
STANDS_OUT_DB = 6.0
BLOCKS = 40
COPIES = 300
RETUNE_RIDGE = 3.0
LATER = "a later time of the same record"


@dataclass(frozen=True, kw_only=True)
class Split:
    """One way to hold out: masks (F,) of the features fitted and scored, and the test's change in each part."""

    fit: np.ndarray
    score: np.ndarray
    fitted: FloatArray
    scored: FloatArray


def splits(changes: Changes, spectral: np.ndarray) -> tuple[tuple[Split, ...], str]:
    """Each operating point in turn; with only one, the second half of its time. `spectral` (F,): levels of lines
    and bands, which the distance is taken over."""
    points = len(changes.starts) - 1
    if points == 1:
        early, late = changes.halves
        return (Split(fit=np.isfinite(early), score=spectral, fitted=early, scored=late),), LATER
    found = []
    for p in range(points):
        held = np.zeros(changes.observed.size, dtype=bool)
        held[changes.starts[p] : changes.starts[p + 1]] = True
        found.append(Split(fit=~held, score=held & spectral, fitted=changes.observed, scored=changes.observed))
    return tuple(found), "each operating point in turn, fitted on the others"


def spectral_mask(layout: Layout, seen_through: Sequence[Lens]) -> np.ndarray:
    """Levels of all third octaves, and of the lines that a healthy machine shows above its noise, (F,).

    Chosen without the test: lines that are noise before and after would hide every gain.
    """
    parts = layout.slices()
    rows = []
    for lens in seen_through:
        noise = 10.0 * np.log10(SOFT * lens.scale.line_noise + 1e-300)
        mask = np.zeros((noise.shape[0], layout.size), dtype=bool)
        mask[:, parts["line"]] = lens.nominal[:, parts["line"]] > noise + STANDS_OUT_DB
        mask[:, parts["total"]] = True
        rows.append(mask.ravel())
    return np.concatenate(rows)


def _prediction(changes: FloatArray, rows: Sequence[int], split: Split, sigma: FloatArray) -> FloatArray:
    """Change (F,) that the draws forecast for all features from the fitted ones: their weighted mean, and their
    departures from it in the linear combination that the fitted part asks for (ensemble Kalman analysis in the space of
    the members, G. Evensen, Ocean Dynamics 53 (2003) 343-367, section 4)."""
    drawn = changes[np.asarray(rows)]
    part = split.fit & np.isfinite(split.fitted) & np.isfinite(drawn).all(axis=0)
    away = (drawn[:, part] - split.fitted[part]) / sigma[part]
    distance = np.mean(np.minimum(away**2, FARTHEST), axis=1)
    best = np.argsort(distance)[:NEAREST]
    weights = 1.0 / np.maximum(distance[best], 1e-6)
    mean = weights @ drawn[best] / weights.sum()
    left = np.clip((split.fitted - mean)[part] / sigma[part], -(FARTHEST**0.5), FARTHEST**0.5)
    apart = drawn[best] - mean
    seen = apart[:, part] / sigma[part] / max(best.size - 1, 1) ** 0.5
    gain = np.linalg.solve(seen @ seen.T + MODEL_VARIANCE * np.eye(best.size), seen @ left)
    return np.asarray(mean + gain @ apart / max(best.size - 1, 1) ** 0.5)


def _levels(split: Split, spectral: np.ndarray) -> Split:
    """To fit an effect: levels of lines and bands alone, which are what is scored, where the fitted part has any."""
    levels = split.fit & spectral & np.isfinite(split.fitted)
    return replace(split, fit=levels) if levels.any() else split


def _ceiling(before: FloatArray, ways: Sequence[Split], sigma: FloatArray) -> float:
    """Gain of a perfect prediction, after which drift and noise stay (`sigma` (F,), dB)."""
    stays = np.concatenate([sigma[w.score & np.isfinite(w.scored)] for w in ways])
    return _gain(before, stays)


def _retuned(null: FloatArray, split: Split, sigma: FloatArray) -> FloatArray:
    """The best mixture of parameter drifts: ridge regression on the healthy pairs."""
    part = split.fit & np.isfinite(split.fitted) & np.isfinite(null).all(axis=0)
    a, b = (null[:, part] / sigma[part]).T, split.fitted[part] / sigma[part]
    ridge = RETUNE_RIDGE * np.eye(null.shape[0]) * max(float(np.mean(a**2)) * a.shape[0] * 1e-3, 1e-9)
    weights = np.linalg.solve(a.T @ a + ridge, a.T @ b)
    return np.asarray(weights @ np.nan_to_num(null))


def _black_box(split: Split, frequency: FloatArray, count: int) -> FloatArray:
    """`count` cosines over log frequency, fitted to the changes: a smooth spectral correction."""
    x = (np.log(frequency) - np.log(frequency).min()) / max(float(np.ptp(np.log(frequency))), 1e-9)
    basis = np.stack([np.cos(np.pi * k * x) for k in range(count)])
    part = split.fit & np.isfinite(split.fitted)
    weights, *_ = np.linalg.lstsq(basis[:, part].T, split.fitted[part], rcond=None)
    return np.asarray(weights @ basis)


def feature_frequencies(layout: Layout, lines_hz: Sequence[FloatArray], channels: int) -> FloatArray:
    """A frequency for every feature, (F,), Hz; shapes get the middle."""
    centres = band_centres_hz()
    rows = []
    for hz in lines_hz:
        rest = np.full(layout.size - hz.size - 2 * centres.size, 1000.0)
        rows.append(np.tile(np.concatenate([np.maximum(hz, 1.0), centres, centres, rest]), channels))
    return np.concatenate(rows)


def _distance(change: FloatArray, predicted: FloatArray, split: Split) -> FloatArray:
    part = split.score & np.isfinite(change) & np.isfinite(predicted)
    return np.asarray((change - predicted)[part])


def _gain(before: FloatArray, after: FloatArray) -> float:
    return 1.0 - float(np.sqrt(np.mean(after**2)) / max(float(np.sqrt(np.mean(before**2))), 1e-12))


def held_out(
    changes: Changes, known: Catalogued, name: str, *, spectral: np.ndarray, frequency: FloatArray, seed: int
) -> HeldOut:
    """Log-spectral distance before and after adding the effect, with a 90 % block-bootstrap interval of the gain."""
    noise = np.nan_to_num(changes.measured, nan=10.0) ** 2
    drift = np.mean(np.nan_to_num(changes.null) ** 2, axis=0)
    sigma, both = np.sqrt(noise + 1.0), np.sqrt(noise + drift + 1.0)
    ways, how = splits(changes, spectral)
    groups = known.library.groups
    term, site = name.split("@", maxsplit=1)[0], name.split("@")[1]
    parameters = len(REGISTRY.get(term).params) if REGISTRY.get(term) is not None else 2  # type: ignore[union-attr]
    wrong = [n for n in groups if n != name and (n.split("@")[0] == term) != (n.split("@")[1] == site)]
    before, after, retuned, box = [], [], [], []
    placebos: list[list[FloatArray]] = [[] for _ in wrong]
    for way in ways:
        nothing = np.zeros(changes.observed.size)
        before.append(_distance(way.scored, nothing, way))
        after.append(
            _distance(way.scored, _prediction(known.library.changes, groups[name], _levels(way, spectral), both), way)
        )
        retuned.append(_distance(way.scored, _retuned(changes.null, way, sigma), way))
        box.append(_distance(way.scored, _black_box(way, frequency, parameters), way))
        for k, other in enumerate(wrong):
            guess = _prediction(known.library.changes, groups[other], _levels(way, spectral), both)
            placebos[k].append(_distance(way.scored, guess, way))
    first = np.concatenate(before)
    low, high = _interval(before, after, np.random.default_rng([seed, 5]))
    gains = [_gain(first, np.concatenate(p)) for p in placebos if np.concatenate(p).size == first.size]
    return HeldOut(
        metric="log_spectral_distance",
        unit="dB",
        before=float(np.sqrt(np.mean(first**2))),
        after=float(np.sqrt(np.mean(np.concatenate(after) ** 2))),
        gain=_gain(first, np.concatenate(after)),
        gain_low=low,
        gain_high=high,
        retuned=_gain(first, np.concatenate(retuned)),
        black_box=_gain(first, np.concatenate(box)),
        placebo=float(np.median(gains)) if gains else None,
        held=how,
        ceiling=_ceiling(first, ways, np.sqrt(noise + drift)),
    )


def _interval(
    before: Sequence[FloatArray], after: Sequence[FloatArray], rng: np.random.Generator
) -> tuple[float, float]:
    """Blocks of neighbouring features are drawn with replacement."""
    blocks = [
        (b, a)
        for one, other in zip(before, after, strict=True)
        if one.size == other.size
        for b, a in zip(np.array_split(one, BLOCKS), np.array_split(other, BLOCKS), strict=True)
        if b.size
    ]
    if not blocks:
        return float("nan"), float("nan")
    squares = np.array([[np.sum(b**2), np.sum(a**2)] for b, a in blocks])
    drawn = squares[rng.integers(0, len(blocks), (COPIES, len(blocks)))].sum(axis=1)
    gains = 1.0 - np.sqrt(drawn[:, 1] / np.maximum(drawn[:, 0], 1e-300))
    return float(np.quantile(gains, 0.05)), float(np.quantile(gains, 0.95))
