"""How large an unknown force is: what lines gained or lost, passed back through the sensors' paths and the machine.

Of the paths only smooth gains are known and no phases: bounds by frequency can be had, a waveform and its work cannot.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import gaussian_filter1d

from signals.series import FloatArray

MODEL_DB = 3.0
"""Error of the linearised receptance at one line and channel, one deviation, beside the spread of gain and machines.
Sines on supports of simulated gearboxes came back within -0.8 to 2 dB (10 to 90 % of 197 lines), along one axis alone
3 dB off. With 2, 3 and 4 dB the true sum was in its band in 15 of 18, and 18 of 18 of machines kept apart."""
AS_WELL = 0.26
"""Likelihood over that of the best force from which on another one, or none, does as well: at 1.645 deviations, so that
what does as well is a 90 % band."""
UNHEARD, LOUDEST = 0.1, 4.0
"""Sizes that come into question: of the deviation in power that the least one makes at most, and of the largest power
that joins another one. No end of a band hangs on them: beyond them nothing changes."""
ACROSS = 0.01
"""Share of a channel's response down to which it hears a force in another direction."""
SIZES, PHASES = 160, 48
FINE = 4
"""Steps of a channel's table a deviation of its response."""
SURELY = 4.0
"""Deviations of its response beyond which a channel's table ends."""
OUTLIER = 1e-3
"""Likelihood that a channel has whatever the force: it may hear something else."""
MIXED, AS_WELL_HEARD = 0.2, 0.25
"""Share of a stronger force below which another line may be its mixing product, and share of a line's response from
which on another one is heard about as well. Of 35 simulated gearboxes with 96 sums, with shares of 0.05, 0.1 and 0.2:
76, 71 and 68 sums told, and of 234, 186 and 141 lines told 81, 51 and 27 that had none of the force; with 0.2 and
responses down to 1, 0.25, 0.1 and 0.01: 74, 68, 65 and 63 sums, and 36 of 154, 27 of 141, 26 of 137 and 26 of 132."""
PER_DB = float(np.log(10.0) / 10.0)


@dataclass(frozen=True, kw_only=True)
class Heard:
    """L lines of one operating point by C channels; powers in the recording's unit squared.

    `test`, `before` (C, L): less the noise, `before` of the baseline. `deviation` (C, L): of their difference, by drift
    of a sound machine and by noise. `response` (W, C, L): by 1 N rms in each of W ways a force may act there (its
    direction), NaN where the channel does not tell it; `spread_db` (C, L): its deviation over machines that may be this
    one, with the gain's.
    """

    test: FloatArray
    before: FloatArray
    deviation: FloatArray
    response: FloatArray
    spread_db: FloatArray


@dataclass(frozen=True, kw_only=True)
class Squares:
    """Mean square of the force at L lines, N^2, with the ends of its 90 % band; NaN where no channel tells it.

    `low` is 0, and `best` with it, where none would do as well; `rose`: where it would not, whatever made the line.
    """

    best: FloatArray
    low: FloatArray
    high: FloatArray
    rose: np.ndarray


def force_squares(heard: Heard) -> Squares:
    """The likelihood of the force's mean square F^2 at each line: all that do nearly as well as the best are its band.

    What it brings to a channel joins what was there, of power P, by a phase that nobody knows, the same for none of the
    channels: T = P + F^2 R + 2 F sqrt(P R) cos p, p uniform, R the response with its error (spread, `MODEL_DB`), T with
    that of drift and noise. A line that rose, or fell, tells a force; one that stayed bounds it. Each size acts in the
    way that suits it best, the same for all channels: no direction is more likely than another, and an average over all
    would rule out those along one axis. `best` is the middle of the likelihood in the band, over the logarithm.
    """
    usable, known, grid, likely = _likelihood(heard)
    found = np.full((3, usable.shape[1]), np.nan)
    if known.size:
        found[:, known] = _band(grid, likely)
    rose = np.nan_to_num(found[0]) > 0.0
    squares = Squares(low=found[0], best=found[1], high=found[2], rose=rose)
    return mixed(squares, np.where(usable, heard.response.max(axis=0), 0.0))


def likely_squares(heard: Heard) -> FloatArray:
    """(L,): log likelihood of the best force at each line over that of one that nobody hears; 0 where no channel tells
    it. Channels that do not hear the place speak for none."""
    usable, known, _, likely = _likelihood(heard)
    found = np.zeros(usable.shape[1])
    if known.size:
        found[known] = likely.max(axis=0) - likely[0]
    return found


def _likelihood(heard: Heard) -> tuple[np.ndarray, np.ndarray, FloatArray, FloatArray]:
    """Which channels tell which lines (C, L), the lines that any tells, logarithms of the sizes that come into question
    and their log likelihoods in the best way, (SIZES, known lines) each."""
    usable = np.isfinite(heard.response).all(axis=0) & (heard.response > 0.0).any(axis=0)
    usable &= np.isfinite(heard.test + heard.before + heard.spread_db) & (heard.deviation > 0.0)
    known = np.flatnonzero(usable.any(axis=0))
    if not known.size:
        return usable, known, np.zeros((SIZES, 0)), np.zeros((SIZES, 0))
    ends = _ends(heard, usable)[:, known]
    grid = ends[0] + np.linspace(0.0, 1.0, SIZES)[:, None] * (ends[1] - ends[0])
    likely = np.zeros((heard.response.shape[0], SIZES, usable.shape[1]))
    for c, own in enumerate(usable):
        if own.any():
            likely[:, :, own] += _of_channel(heard, c, own, grid[:, np.isin(known, np.flatnonzero(own))])
    return usable, known, grid, likely[:, :, known].max(axis=0)


def mixed(squares: Squares, response: FloatArray) -> Squares:
    """The same with nothing as the least at lines that may come of others: stiffness that varies over a turn and
    contacts mix lines, which a receptance does not.

    Others are those that rose, and those that stayed as far as a force may hide there, where a channel hears them about
    as well, `response` (C, L): what is hardly heard has a large upper end that says nothing.
    """
    rose, best, low = squares.rose, squares.best.copy(), squares.low.copy()
    strongest = float(np.max(best[rose], initial=0.0))
    hidden = np.where(rose, 0.0, np.nan_to_num(squares.high))
    for k in np.flatnonzero(rose):
        as_well = (response >= AS_WELL_HEARD * response[:, [k]]) & (response[:, [k]] > 0.0)
        other = float(np.max(hidden[as_well.any(axis=0)], initial=strongest))
        if squares.best[k] <= MIXED**2 * other:
            best[k] = low[k] = 0.0
    return Squares(best=best, low=low, high=squares.high, rose=rose)


def _least(before: FloatArray, deviation: FloatArray) -> FloatArray:
    """Power that changes another one, `before`, by no more than `UNHEARD` of its deviation whatever the phases."""
    change = UNHEARD * deviation
    return np.asarray((change / (np.sqrt(before + change) + np.sqrt(before))) ** 2)


def _ends(heard: Heard, usable: np.ndarray) -> FloatArray:
    """(2, L): logarithms of F^2 that no channel can hear in any way, and that is more than any of them did."""
    with np.errstate(divide="ignore", invalid="ignore"):
        error, response = _error(heard.spread_db), heard.response.max(axis=0)
        quiet = _least(heard.before, heard.deviation) / response
        loud = LOUDEST * (heard.test + heard.before + heard.deviation) / (ACROSS * response)
        least = np.where(usable, np.log(quiet) - SURELY * error, np.inf).min(axis=0)
        most = np.where(usable, np.log(loud) + SURELY * error, -np.inf).max(axis=0)
    return np.stack([least, most])


def _error(spread_db: FloatArray) -> FloatArray:
    return np.asarray(PER_DB * np.hypot(spread_db, MODEL_DB))


def _of_channel(heard: Heard, channel: int, own: np.ndarray, grid: FloatArray) -> FloatArray:
    """(W, SIZES, own lines): log likelihood of one channel, read from its table over what the force brings to it."""
    test, before, deviation = (a[channel, own] for a in (heard.test, heard.before, heard.deviation))
    error = _error(heard.spread_db[channel, own])
    top = np.log(LOUDEST * (test + before + deviation)) + 2.0 * SURELY * error
    depth = (top - np.log(_least(before, deviation))) / error + SURELY
    steps = np.arange(int(np.ceil(FINE * depth.max())) + 1)[:, None]
    brought = np.exp(top - steps * error / FINE)
    table = _table(test, before, deviation, brought, 0.5 * error / FINE)
    table = np.log(gaussian_filter1d(table, FINE, axis=0, mode="nearest") + OUTLIER)
    log_response = np.log(heard.response[:, channel, own] + 1e-300)
    place = (top - log_response[:, None, :] - grid) * FINE / error
    place = np.clip(place, 0.0, steps.size - 1.001)
    below = place.astype(int)
    line = np.arange(test.size)
    share = place - below
    return np.asarray((1.0 - share) * table[below, line] + share * table[below + 1, line])


def _table(
    test: FloatArray, before: FloatArray, deviation: FloatArray, brought: FloatArray, blur: FloatArray
) -> FloatArray:
    """(steps, L): likelihood of the logarithm of the test's power, whatever the phase, by what is brought, (steps, L).

    `blur`: deviation of what is brought, in logarithm, by which a step reaches the next.
    """
    level = np.log(test + deviation)
    total = np.zeros(brought.shape)
    for phase in np.cos(np.pi * (np.arange(PHASES) + 0.5) / PHASES):
        crossed = 2.0 * np.sqrt(before * brought) * phase
        made = np.maximum(before + brought + crossed, 0.0) + deviation
        scatter = np.hypot(deviation, blur * (brought + 0.5 * np.abs(crossed))) / made
        total += np.exp(-0.5 * ((np.log(made) - level) / scatter) ** 2) / (scatter * PHASES)
    return total


def _band(grid: FloatArray, likely: FloatArray) -> FloatArray:
    """(3, L): lower end, middle and upper end of F^2, N^2."""
    ratio = np.exp(likely - likely.max(axis=0))
    found = np.zeros((3, grid.shape[1]))
    for k in range(grid.shape[1]):
        sizes, own = grid[:, k], ratio[:, k]
        inside = np.flatnonzero(own >= AS_WELL)
        first, last = int(inside[0]), int(inside[-1])
        found[2, k] = np.exp(_crossed(sizes, own, last, min(last + 1, SIZES - 1)))
        if first > 0:
            share = np.cumsum(own[first : last + 1])
            found[0, k] = np.exp(_crossed(sizes, own, first, first - 1))
            found[1, k] = np.exp(
                np.interp(0.5 * share[-1], share - 0.5 * own[first : last + 1], sizes[inside[0] : last + 1])
            )
    return found


def _crossed(sizes: FloatArray, ratio: FloatArray, inside: int, outside: int) -> float:
    """Logarithm of the size between two of the grid at which the likelihood passes `AS_WELL`."""
    fall = ratio[inside] - ratio[outside]
    share = (ratio[inside] - AS_WELL) / fall if fall > 0.0 else 0.0
    return float(sizes[inside] + share * (sizes[outside] - sizes[inside]))
