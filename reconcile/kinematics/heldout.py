"""Does the named family predict what it was not fitted on? The log envelope order spectrum of other recordings.

Model: the baseline's spectrum (without one: noise), a smooth re-scaling over orders, and the comb of the family.
Rivals get the same data: the re-scaling alone, as many parameters spent on free lines or humps (the better of the two
on what is held out), the comb of another family.
Channel, band and order of the comb, of the rival family too, are searched on the fitted part alone.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from reconcile.kinematics.combs import Stretch, Train, fitted, predicted, rescaled
from reconcile.kinematics.contrast import band_turns
from reconcile.kinematics.envelopes import order_depth
from reconcile.kinematics.evidence import Evidence, family_evidence
from reconcile.kinematics.extent import spall_extent
from reconcile.kinematics.families import Family, Ties
from reconcile.kinematics.free_lines import black_boxes
from reconcile.kinematics.judge import HEARD_Z
from reconcile.kinematics.observe import Observation
from reconcile.kinematics.parted import LEAST_TURNS, Parted, parted
from reconcile.verdict import HeldOut
from signals.series import FloatArray

SEGMENTS = 5
WIDE = ((0.02, 0.5), (0.1, 0.97), (0.5, 0.97))
"""Bands tried besides that of the evidence, share of Nyquist."""
MOST_CHANNELS = 2
"""Channels tried: those that hear the family most firmly on the fitted part."""
LOWEST_ORDER = 0.25
MOST_HARMONICS = 8
MOST_PAIR = 0.5
"""Of the period, up to which two impulses of one ball are a pair."""
BOOTSTRAPS = 400
BLOCK_ORDERS = 1.0
NATURAL = 20 / np.log(10) / 2
"""dB a unit of natural logarithm of power."""
AVERAGED = 3
"""Neighbouring bins whose power is averaged: the scatter of single bins is no property of a machine."""


@dataclass(frozen=True, kw_only=True)
class Split:
    """What is fitted, what is predicted, what is expected where nothing is missing (bins,), in one band."""

    fit: Stretch
    score: tuple[Stretch, ...]
    before: FloatArray


@dataclass(frozen=True, kw_only=True)
class Fit:
    """The comb in the channel and band in which it helps most on the fitted part: `helps`, share of what is left."""

    train: Train
    channel: str
    split: Split
    parameters: FloatArray
    helps: float


def held_out(
    family: Family,
    placebo: Family | None,
    tests: Sequence[Observation],
    baselines: Sequence[Observation],
    ties: Ties,
    rng: np.random.Generator,
    seed: int,
) -> HeldOut | None:
    """Fit on the first test recording and predict all others; with one, fit on its first half (which is weaker).

    None where the parts are too short, or no channel is in all of them.
    """
    parts = parted(tests, ties, seed)
    if parts is None:
        return None
    best = best_fit(family, parts, baselines, ties, rng)
    if best is None:
        return None
    wrong = None if placebo is None else _in_channel(placebo, best.channel, parts.fit, ties, rng)
    return _compared(best, wrong, parts.told, rng)


def best_fit(
    family: Family, parts: Parted, baselines: Sequence[Observation], ties: Ties, rng: np.random.Generator
) -> Fit | None:
    """The family fitted, searched on the fitted part alone: its order in each channel, and of the band that hears it
    there and the wide ones that in which the comb helps most."""
    fit = parts.fit
    nyquist = min(t.recording.sampling_rate_hz for t in (fit, *parts.held, *baselines)) / 2
    best: Fit | None = None
    for evidence in _searched(family, fit, ties, rng)[:MOST_CHANNELS]:
        train = _train(evidence, fit, ties)
        for band in (evidence.band_hz, *((a * nyquist, b * nyquist) for a, b in WIDE)):
            split = _split(evidence, band, parts, baselines) if band[1] < nyquist else None
            if split is None:
                continue
            parameters = fitted(train, split.fit, split.before)
            left = predicted(train, split.fit, split.before, parameters) - split.fit.log_power
            retuned = rescaled(split.fit, split.before)[0] - split.fit.log_power
            helps = float(1 - np.mean(left**2) / np.mean(retuned**2))
            if best is None or helps > best.helps:
                best = Fit(train=train, channel=evidence.channel, split=split, parameters=parameters, helps=helps)
    return best


def _searched(family: Family, fit: Observation, ties: Ties, rng: np.random.Generator) -> list[Evidence]:
    """The family in each channel of the fitted part, the firmest first."""
    found = family_evidence(fit.channels, ties, family, fit.doubt, rng, certain_z=HEARD_Z)
    return [found, *found.others]


def _in_channel(family: Family, channel: str, fit: Observation, ties: Ties, rng: np.random.Generator) -> Train:
    """Another family as it is found in the same channel of the fitted part."""
    found = next(e for e in _searched(family, fit, ties, rng) if e.channel == channel)
    return _train(found, fit, ties)


def _train(evidence: Evidence, fit: Observation, ties: Ties) -> Train:
    """The comb at the order found; of pairs of impulses where entry and exit are told apart."""
    extent = spall_extent(evidence, fit, ties)
    pair = 0.0
    if extent is not None and extent.resolved:
        pair = extent.lag_s * evidence.order * fit.speed.speed_hz
    return Train(family=evidence.family, order=evidence.order, pair=pair if pair < MOST_PAIR else 0.0)


def _split(
    evidence: Evidence, band_hz: tuple[float, float], parts: Parted, baselines: Sequence[Observation]
) -> Split | None:
    """The parts in one band of a channel; None where no other part has the channel, or they hold too few turns."""
    held = [t for t in parts.held if evidence.channel in t.recording.names]
    if not held:
        return None
    (values, per_turn), *others = (band_turns(t, evidence.channel, band_hz) for t in (parts.fit, *held))
    turns = min(v.size / p for v, p in ((values, per_turn), *others))
    if turns < LEAST_TURNS:
        return None
    length = turns / ((SEGMENTS + 1) / 2)
    top = min(MOST_HARMONICS * evidence.order, 0.45 * per_turn)
    fit = stretch(values, per_turn, length, top)
    score = tuple(stretch(v, p, length, top) for v, p in others)
    return Split(fit=fit, score=score, before=_before(evidence, band_hz, baselines, length, top, fit))


def stretch(values: FloatArray, per_turn: int, length_turns: float, top_order: float) -> Stretch:
    """Mean power of half-overlapping segments of `length_turns`, from `LOWEST_ORDER` to `top_order`."""
    size = int(length_turns * per_turn)
    starts = range(0, values.size - size + 1, max(1, size // 2))
    power = np.mean([order_depth(values[s : s + size], per_turn)[0] ** 2 for s in starts], axis=0)
    orders = np.arange(power.size) * per_turn / size
    kept = (orders >= LOWEST_ORDER) & (orders <= top_order)
    smooth = np.convolve(power, np.ones(AVERAGED) / AVERAGED, mode="same")
    return Stretch(log_power=np.log(smooth[kept] + 1e-12), orders=orders[kept])


def _before(
    evidence: Evidence,
    band_hz: tuple[float, float],
    baselines: Sequence[Observation],
    length: float,
    top: float,
    fit: Stretch,
) -> FloatArray:
    """Log power (bins,) expected where nothing is missing: the baseline's, else noise of the same mean depth."""
    rows = []
    for b in baselines:
        if evidence.channel in b.recording.names:
            values, per_turn = band_turns(b, evidence.channel, band_hz)
            if values.size / per_turn >= length:
                one = stretch(values, per_turn, length, top)
                rows.append(np.interp(fit.orders, one.orders, one.log_power))
    if rows:
        return np.asarray(np.mean(rows, axis=0), dtype=np.float64)
    return np.full(fit.orders.size, float(np.median(fit.log_power)))


def _compared(best: Fit, wrong: Train | None, told: str, rng: np.random.Generator) -> HeldOut:
    """Distances on the held-out stretches (brought to the fit's orders) of all models, over all of them together."""
    fit, before = best.split.fit, best.split.before
    actual = np.stack([np.interp(fit.orders, s.orders, s.log_power) for s in best.split.score])
    retuned = rescaled(fit, before)[0]
    models: dict[str, FloatArray] = {
        "before": before,
        "after": predicted(best.train, fit, before, best.parameters),
        "retuned": retuned,
    }
    boxes = black_boxes(fit, before)
    models |= {f"box{i}": box for i, box in enumerate(boxes)}
    if wrong is not None:
        models["placebo"] = predicted(wrong, fit, before, fitted(wrong, fit, before))
    errors: Mapping[str, FloatArray] = {k: v - actual for k, v in models.items()}
    size = {k: float(np.sqrt(np.mean(e**2))) * NATURAL for k, e in errors.items()}
    gain = {k: 1 - v / size["before"] for k, v in size.items()}
    low, high = gain_interval(errors["before"], errors["after"], fit, rng)
    return HeldOut(
        metric="log-spectral distance of the envelope order spectrum",
        unit="dB",
        before=size["before"],
        after=size["after"],
        gain=gain["after"],
        gain_low=low,
        gain_high=high,
        retuned=gain["retuned"],
        black_box=max(gain[f"box{i}"] for i in range(len(boxes))),
        placebo=gain.get("placebo"),
        held=told,
    )


def gain_interval(before: FloatArray, after: FloatArray, fit: Stretch, rng: np.random.Generator) -> tuple[float, float]:
    """90 % interval of the gain: paired bootstrap over blocks of one order and over recordings, errors (recordings,
    bins). What a model does at an order it does in all recordings, so their blocks are drawn together."""
    block = max(1, round(BLOCK_ORDERS / fit.step))
    recordings, bins = before.shape
    count = max(1, bins // block)
    one, two = (
        np.stack([np.mean(x**2, axis=1) for x in np.array_split(e, count, axis=1)], axis=1) for e in (before, after)
    )
    rows = rng.integers(0, recordings, (BOOTSTRAPS, recordings, 1))
    picks = rng.integers(0, count, (BOOTSTRAPS, 1, count))
    left = [np.mean(e[rows, picks], axis=(1, 2)) for e in (one, two)]
    gains = 1 - np.sqrt(left[1] / np.maximum(left[0], 1e-300))
    low, high = np.percentile(gains, (5, 95))
    return float(low), float(high)
