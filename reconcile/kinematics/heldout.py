"""Does the named family predict what it was not fitted on? The log envelope order spectrum of another stretch.

Model: the baseline's spectrum (without one: noise), a smooth re-scaling over orders, and the comb of the family.
Rivals get the same data: the re-scaling alone, as many parameters spent on free lines, the comb of another family.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from reconcile.kinematics.combs import Stretch, Train, black_box, fitted, predicted, rescaled
from reconcile.kinematics.contrast import band_turns
from reconcile.kinematics.envelopes import order_depth
from reconcile.kinematics.evidence import Evidence
from reconcile.kinematics.families import Family
from reconcile.kinematics.observe import Observation
from reconcile.verdict import HeldOut
from signals.series import FloatArray

SEGMENTS = 5
WIDE = ((0.02, 0.5), (0.1, 0.97), (0.5, 0.97))
"""Bands tried besides that of the evidence, share of Nyquist."""
MIN_SEGMENT_TURNS = 8.0
LOWEST_ORDER = 0.25
MOST_HARMONICS = 8
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
    score: Stretch
    before: FloatArray
    held: str


def held_out(
    evidence: Evidence,
    placebo: Family | None,
    tests: Sequence[Observation],
    baselines: Sequence[Observation],
    rng: np.random.Generator,
    pair: float = 0.0,
) -> HeldOut | None:
    """Fit on the first test recording and predict the others; with one, fit on its first half (which is weaker).

    `pair`: distance of entry and exit of the spall over the period, 0 where it was not told. The band (that of the
    evidence or a wide one) is the one in which the comb helps most on the fitted part.
    """
    usable = [t for t in tests if evidence.channel in t.recording.names]
    if not usable:
        return None
    train = Train(family=evidence.family, order=evidence.order, pair=pair)
    best: tuple[float, Split, FloatArray] | None = None
    nyquist = min(t.recording.sampling_rate_hz for t in (*usable, *baselines)) / 2
    for band in (evidence.band_hz, *((a * nyquist, b * nyquist) for a, b in WIDE)):
        split = _split(evidence, band, usable, baselines) if band[1] < nyquist else None
        if split is None:
            continue
        parameters = fitted(train, split.fit, split.before)
        left = predicted(train, split.fit, split.before, parameters) - split.fit.log_power
        retuned = rescaled(split.fit, split.before)[0] - split.fit.log_power
        help_share = float(1 - np.mean(left**2) / np.mean(retuned**2))
        if best is None or help_share > best[0]:
            best = (help_share, split, parameters)
    return None if best is None else _compared(train, placebo, best[1], best[2], rng)


def _split(
    evidence: Evidence, band_hz: tuple[float, float], tests: Sequence[Observation], baselines: Sequence[Observation]
) -> Split | None:
    """The two parts in one band; None where they hold too few turns."""
    values, per_turn = band_turns(tests[0], evidence.channel, band_hz)
    if len(tests) > 1:
        other, other_per_turn = band_turns(tests[1], evidence.channel, band_hz)
        turns = min(values.size / per_turn, other.size / other_per_turn)
        parts = [(values, per_turn), (other, other_per_turn)]
        held = f"another recording, at {tests[1].speed.speed_hz:.4g} Hz"
    else:
        middle = values.size // 2
        turns = middle / per_turn
        parts = [(values[:middle], per_turn), (values[middle:], per_turn)]
        held = "a later time of the same record"
    length = turns / ((SEGMENTS + 1) / 2)
    if length < MIN_SEGMENT_TURNS:
        return None
    top = min(MOST_HARMONICS * evidence.order, 0.45 * per_turn)
    fit, score = (stretch(v, p, length, top) for v, p in parts)
    return Split(fit=fit, score=score, before=_before(evidence, band_hz, baselines, length, top, fit), held=held)


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


def _compared(
    train: Train, placebo: Family | None, split: Split, parameters: FloatArray, rng: np.random.Generator
) -> HeldOut:
    """Distances on the held-out stretch (brought to the fit's orders) of all models."""
    fit, before = split.fit, split.before
    actual = np.interp(fit.orders, split.score.orders, split.score.log_power)
    retuned = rescaled(fit, before)[0]
    errors = {
        "before": before - actual,
        "after": predicted(train, fit, before, parameters) - actual,
        "retuned": retuned - actual,
        "box": black_box(fit, retuned) - actual,
    }
    if placebo is not None:
        wrong = Train(family=placebo, order=placebo.order)
        errors["placebo"] = predicted(wrong, fit, before, fitted(wrong, fit, before)) - actual
    size = {k: float(np.sqrt(np.mean(e**2))) * NATURAL for k, e in errors.items()}
    gain = {k: 1 - v / size["before"] for k, v in size.items()}
    low, high = _interval(errors["before"], errors["after"], fit, rng)
    return HeldOut(
        metric="log-spectral distance of the envelope order spectrum",
        unit="dB",
        before=size["before"],
        after=size["after"],
        gain=gain["after"],
        gain_low=low,
        gain_high=high,
        retuned=gain["retuned"],
        black_box=gain["box"],
        placebo=gain.get("placebo"),
        held=split.held,
    )


def _interval(before: FloatArray, after: FloatArray, fit: Stretch, rng: np.random.Generator) -> tuple[float, float]:
    """90 % interval of the gain: paired bootstrap over blocks of one order."""
    block = max(1, round(BLOCK_ORDERS / fit.step))
    count = max(1, before.size // block)
    one = np.array([np.mean(x**2) for x in np.array_split(before, count)])
    two = np.array([np.mean(x**2) for x in np.array_split(after, count)])
    picks = rng.integers(0, count, (BOOTSTRAPS, count))
    gains = 1 - np.sqrt(np.mean(two[picks], axis=1) / np.maximum(np.mean(one[picks], axis=1), 1e-300))
    low, high = np.percentile(gains, (5, 95))
    return float(low), float(high)
