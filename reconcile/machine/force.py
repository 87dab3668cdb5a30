"""How large an unknown force is: what lines gained or lost, passed back through the sensors' paths and the machine.

Of the paths only smooth gains are known and no phases: bounds by frequency can be had, a waveform and its work cannot.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from signals.series import FloatArray

MODEL_DB = 3.0
"""Error of the linearised receptance at one line and channel, one deviation, beside the spread of gain and machines.
Sines on supports of simulated gearboxes came back within -0.8 to 2 dB (10 to 90 % of 197 lines), along one axis alone
3 dB off. With 2, 3 and 4 dB the true sum was in its band in 15 of 18, and 18 of 18 of machines kept apart."""
TAIL = 0.05
"""Either side of a 90 % band."""
AS_WELL = 0.26
"""Likelihood of no force over that of the best one from which on none does as well: that at 1.645 deviations."""
UNHEARD, LOUDEST = 0.01, 4.0
"""Sizes that come into question: of the least deviation in power, and of the largest power."""
SIZES, PHASES = 96, 48
OUTLIER = 1e-3
"""Likelihood that a channel has whatever the force: it may hear something else."""
MIXED = 0.1
"""Share of the strongest force that may act at one point below which another line may be its mixing product. With 0.05,
0.1 and 0.2 of ten simulated gearboxes 21 of 62, 10 of 46 and 4 of 24 lines told had none of the force."""
PER_DB = float(np.log(10.0) / 10.0)


@dataclass(frozen=True, kw_only=True)
class Heard:
    """L lines of one operating point by C channels, A axes of the force; powers in the recording's unit squared.

    `test`, `before` (C, L): less the noise, `before` of the baseline. `deviation` (C, L): of their difference, by drift
    of a sound machine and by noise. `response` (A, C, L): by 1 N rms along the axis, NaN where the channel does not
    tell it; `spread_db` (A, C, L): its deviation over machines that may be this one.
    """

    test: FloatArray
    before: FloatArray
    deviation: FloatArray
    response: FloatArray
    spread_db: FloatArray


@dataclass(frozen=True, kw_only=True)
class Squares:
    """Mean square of the force at L lines, N^2, with the ends of its 90 % band; NaN where no channel tells it."""

    best: FloatArray
    low: FloatArray
    high: FloatArray


def force_squares(heard: Heard) -> Squares:
    """Along all axes together; an axis that no channel hears counts as nothing."""
    axes = [_along(heard, k) for k in range(heard.response.shape[0])]
    known = np.any([np.isfinite(one.best) for one in axes], axis=0)

    def total(name: str) -> FloatArray:
        return np.where(known, np.nansum([getattr(one, name) for one in axes], axis=0), np.nan)

    return mixed(Squares(best=total("best"), low=total("low"), high=total("high")))


def mixed(squares: Squares) -> Squares:
    """The same with nothing as the least at lines that may come of stronger ones: stiffness that varies over a turn and
    contacts mix them, which a receptance does not."""
    strongest = float(np.nanmax(squares.high, initial=0.0))
    least = np.where(np.nan_to_num(squares.best) > MIXED**2 * strongest, squares.low, np.minimum(squares.low, 0.0))
    return Squares(best=squares.best, low=least, high=squares.high)


def _along(heard: Heard, axis: int) -> Squares:
    """One axis: the posterior of the force's mean square F^2 at each line, its median and its 5 and 95 % points.

    What it brings to a channel joins what was there, of power P, by a phase that nobody knows, the same for none of the
    channels: T = P + F^2 R + 2 F sqrt(P R) cos p, p uniform, R the response with its error (spread, `MODEL_DB`), T with
    that of drift and noise. A line that rose, or fell, tells a force; one that stayed bounds it. Of sizes between what
    no channel could hear and what would be more than all of them did each is as likely in logarithm beforehand. Where
    no force at all would do as well the least is 0.
    """
    response = heard.response[axis]
    usable = np.isfinite(response) & (response > 0.0) & np.isfinite(heard.test + heard.before)
    usable &= heard.deviation > 0.0
    known = np.flatnonzero(usable.any(axis=0))
    found = np.full((3, response.shape[1]), np.nan)
    if known.size:
        test, before, deviation, spread = (
            np.where(usable, a, 0.0)[:, known]
            for a in (heard.test, heard.before, heard.deviation, heard.spread_db[axis])
        )
        error = PER_DB * np.hypot(spread, MODEL_DB)
        found[:, known] = _quantiles(test, before, deviation, np.where(usable, response, np.nan)[:, known], error)
    return Squares(best=found[1], low=found[0], high=found[2])


def _quantiles(
    test: FloatArray, before: FloatArray, deviation: FloatArray, response: FloatArray, error: FloatArray
) -> FloatArray:
    """(3, L): of F^2, N^2."""
    heard = (test + before + deviation) / response
    ends = np.log(UNHEARD * np.nanmin(deviation / response, axis=0)), np.log(LOUDEST * np.nanmax(heard, axis=0))
    grid = ends[0] + np.linspace(0.0, 1.0, SIZES)[:, None] * (ends[1] - ends[0])
    likely = np.zeros(grid.shape)
    for c in range(test.shape[0]):
        own = np.isfinite(response[c])
        likely[:, own] += _likely(
            test[c, own], before[c, own], deviation[c, own], np.exp(grid[:, own]) * response[c, own], error[c, own]
        )
    weights = np.exp(likely - likely.max(axis=0))
    share = np.cumsum(weights, axis=0) / weights.sum(axis=0)
    at = np.stack([np.argmax(share >= q, axis=0) for q in (TAIL, 0.5, 1.0 - TAIL)])
    found = np.exp(np.take_along_axis(grid, at, axis=0))
    found[0, weights[0] > AS_WELL] = 0.0
    return np.asarray(found)


def _likely(
    test: FloatArray, before: FloatArray, deviation: FloatArray, brought: FloatArray, error: FloatArray
) -> FloatArray:
    """(SIZES, L): log likelihood of one channel for what the force would bring to it, (SIZES, L).

    In the logarithm of the test's power, which the response's error enters by the share that the force has in it.
    """
    level, sound = np.log(test + deviation), (deviation / (test + deviation)) ** 2
    total = np.zeros(brought.shape)
    for phase in np.cos(np.pi * (np.arange(PHASES) + 0.5) / PHASES):
        crossed = 2.0 * np.sqrt(before * brought) * phase
        made = np.maximum(before + brought + crossed, 0.0) + deviation
        scatter = np.sqrt(sound + (error * (brought + 0.5 * np.abs(crossed)) / made) ** 2)
        total += np.exp(-0.5 * ((np.log(made) - level) / scatter) ** 2) / (scatter * PHASES)
    return np.asarray(np.log(total + OUTLIER))
