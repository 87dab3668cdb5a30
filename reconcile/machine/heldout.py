"""Stage 7: the fit on data it never saw, against retuning, an equal-parameter black box and placebos."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from reconcile.calibrate.chain import band_centres_hz
from reconcile.judge.changes import Changes, Lens
from reconcile.machine.library import Catalogued
from reconcile.machine.rivals import Split, black_box, forecast, levels, retuned
from reconcile.observe.features import SOFT, Layout
from reconcile.verdict import HeldOut, Placebo
from signals.series import FloatArray
from sim.terms import REGISTRY

STANDS_OUT_DB = 6.0
BLOCKS = 40
COPIES = 300
MANY = 6
"""Draws from which a placebo has had its chance."""
LATER = "a later time of the same record"


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


def _ceiling(before: FloatArray, ways: Sequence[Split], sigma: FloatArray) -> float:
    """Gain of a perfect prediction, after which drift and noise stay (`sigma` (F,), dB)."""
    stays = np.concatenate([sigma[w.score & np.isfinite(w.scored)] for w in ways])
    return _gain(before, stays)


def feature_frequencies(layout: Layout, lines_hz: Sequence[FloatArray], channels: int) -> FloatArray:
    """A frequency for every feature, (F,), Hz; shapes get the middle."""
    centres = band_centres_hz()
    rows = []
    for hz in lines_hz:
        rest = np.full(layout.size - hz.size - 2 * centres.size, 1000.0)
        rows.append(np.tile(np.concatenate([np.maximum(hz, 1.0), centres, centres, rest]), channels))
    return np.concatenate(rows)


def feature_channels(layout: Layout, points: int, channels: int) -> np.ndarray:
    """Number of the channel of every feature, (F,)."""
    return np.tile(np.repeat(np.arange(channels), layout.size), points)


def _distances(predicted: Sequence[FloatArray], ways: Sequence[Split]) -> tuple[list[FloatArray], list[FloatArray]]:
    """Of each held-out part the distance to no change and to what is predicted, over the features of which both are
    known: what a forecast says nothing of counts neither before nor after."""
    before, after = [], []
    for guess, way in zip(predicted, ways, strict=True):
        part = way.score & np.isfinite(way.scored) & np.isfinite(guess)
        before.append(np.asarray(way.scored[part]))
        after.append(np.asarray((way.scored - guess)[part]))
    return before, after


def _gain(before: FloatArray, after: FloatArray) -> float:
    return 1.0 - float(np.sqrt(np.mean(after**2)) / max(float(np.sqrt(np.mean(before**2))), 1e-12))


def _gain_of(predicted: Sequence[FloatArray], ways: Sequence[Split]) -> float | None:
    """None where nothing is predicted of what is scored."""
    before, after = (np.concatenate(parts) for parts in _distances(predicted, ways))
    return _gain(before, after) if before.size else None


def held_out(
    changes: Changes,
    known: Catalogued,
    name: str,
    *,
    spectral: np.ndarray,
    frequency: FloatArray,
    channel: np.ndarray | None = None,
    beside: str | None = None,
    drawn: FloatArray | None = None,
    seed: int,
) -> HeldOut:
    """Log-spectral distance before and after adding the effect, or it and another `beside` it, with a 90 %
    block-bootstrap interval of the gain. Placebos of a pair keep the first and put something else for the second.
    `drawn` (n, F): what both show together on simulated machines, else their draws are summed.

    `black_box` is the better of one curve for all sensors and one for each (`channel` (F,)) with as many numbers."""
    noise = np.nan_to_num(changes.measured, nan=10.0) ** 2
    drift = np.mean(np.nan_to_num(changes.null) ** 2, axis=0)
    sigma = np.sqrt(noise + drift + 1.0)
    ways, how = splits(changes, spectral)
    named = known if beside is None else with_drawn(known, name, drawn)
    named = with_sums(changes, known, name, beside) if beside is not None and drawn is None else named
    told, used = _told(named, named.library.groups[name], ways, spectral, sigma)
    before, after = _distances(told, ways)
    count = max(_parameters(name) + (0 if beside is None else _parameters(beside)), round(used))
    fits = [levels(w, spectral) for w in ways]
    tuned = _gain_of([retuned(changes.null, f, sigma) for f in fits], ways)
    boxes = [_gain_of([black_box(f, frequency, count, sigma, dealt) for f in fits], ways) for dealt in (None, channel)]
    first = np.concatenate(before)
    low, high = _interval(before, after, np.random.default_rng([seed, 5]))
    placebos = _placebos(changes, known, name, beside, ways, spectral, sigma)
    full = [p.gain for p in placebos if p.draws >= MANY] or [p.gain for p in placebos]
    return HeldOut(
        metric="log_spectral_distance",
        unit="dB",
        before=float(np.sqrt(np.mean(first**2))),
        after=float(np.sqrt(np.mean(np.concatenate(after) ** 2))),
        gain=_gain(first, np.concatenate(after)),
        gain_low=low,
        gain_high=high,
        retuned=tuned,
        black_box=max((box for box in boxes if box is not None), default=None),
        placebo=float(np.median(full)) if full else None,
        held=how,
        ceiling=_ceiling(first, ways, np.sqrt(noise + drift)),
        numbers=count,
        placebos=placebos,
        effects=(name,) if beside is None else (name, beside),
    )


def with_sums(changes: Changes, known: Catalogued, first: str, second: str) -> Catalogued:
    """The library in which the first effect's draws are what each of them and each of the second's show together."""
    library = known.library
    own, other = (library.changes[list(library.groups[name])] for name in (first, second))
    sums = np.concatenate([changes.both(one[None], other) for one in own])
    rows = tuple(range(len(library.changes), len(library.changes) + len(sums)))
    both = np.concatenate([library.changes, sums])
    return replace(known, library=replace(library, changes=both, groups={**library.groups, first: rows}))


def with_drawn(known: Catalogued, first: str, drawn: FloatArray | None) -> Catalogued:
    """The library in which the first effect's draws are these (n, F)."""
    if drawn is None:
        return known
    library = known.library
    rows = tuple(range(len(library.changes), len(library.changes) + len(drawn)))
    both = np.concatenate([library.changes, drawn])
    return replace(known, library=replace(library, changes=both, groups={**library.groups, first: rows}))


def _parameters(name: str) -> int:
    term = REGISTRY.get(name.split("@", maxsplit=1)[0])
    return len(term.params) if term is not None else 2


def _told(
    known: Catalogued, rows: Sequence[int], ways: Sequence[Split], spectral: np.ndarray, sigma: FloatArray
) -> tuple[list[FloatArray], float]:
    """What an effect forecasts of each held-out part, and the numbers it has used on average."""
    made = [forecast(known.library.changes, rows, levels(w, spectral), sigma) for w in ways]
    return [guess for guess, _ in made], float(np.mean([used for _, used in made]))


def _placebos(
    changes: Changes,
    known: Catalogued,
    name: str,
    beside: str | None,
    ways: Sequence[Split],
    spectral: np.ndarray,
    sigma: FloatArray,
) -> tuple[Placebo, ...]:
    """The right law at wrong places and wrong laws at the right place, the best first; of two effects, for the second,
    beside the first."""
    term, site = (beside or name).split("@")
    found = []
    for other, rows in known.library.groups.items():
        law, place = other.split("@")
        if other in (name, beside) or (law == term) == (place == site):
            continue
        summed = known if beside is None else with_sums(changes, known, name, other)
        drawn = rows if beside is None else summed.library.groups[name]
        gain = _gain_of(_told(summed, drawn, ways, spectral, sigma)[0], ways)
        if gain is not None:
            found.append(Placebo(term=law, site=place, gain=gain, draws=len(rows)))
    return tuple(sorted(found, key=lambda p: -p.gain))


def _interval(
    before: Sequence[FloatArray], after: Sequence[FloatArray], rng: np.random.Generator
) -> tuple[float, float]:
    """Blocks of neighbouring features are drawn with replacement."""
    blocks = [
        (b, a)
        for one, other in zip(before, after, strict=True)
        for b, a in zip(np.array_split(one, BLOCKS), np.array_split(other, BLOCKS), strict=True)
        if b.size
    ]
    if not blocks:
        return float("nan"), float("nan")
    squares = np.array([[np.sum(b**2), np.sum(a**2)] for b, a in blocks])
    drawn = squares[rng.integers(0, len(blocks), (COPIES, len(blocks)))].sum(axis=1)
    gains = 1.0 - np.sqrt(drawn[:, 1] / np.maximum(drawn[:, 0], 1e-300))
    return float(np.quantile(gains, 0.05)), float(np.quantile(gains, 0.95))
