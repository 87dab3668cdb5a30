"""Stage 1: machines of the kind that agree with the baseline, by an iterated ensemble smoother.

Healthy machines drawn from the specification's uncertainty are moved together towards the levels of single lines in the
baseline recordings (the teeth's; without teeth the shafts' and passing balls'): ensemble smoother with multiple data
assimilation, A. A. Emerick and A. C. Reynolds, Computers & Geosciences 55 (2013) 3-15, equations 1-4 with equal
inflation. The sensors' paths are unknown: they enter as correlated errors, smooth over frequency and the same at all
speeds.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from reconcile.atlas.bank import Bank
from reconcile.calibrate.uncertain import SPREAD, Offsets
from reconcile.observe.features import SOFT, Scale
from reconcile.observe.statistics import Statistics
from signals.series import FloatArray

ROUNDS = 2
PATH_DB = 6.0
"""Standard deviation of a sensor's path over frequency, and its common gain's."""
GAIN_DB = 10.0
PATH_OCTAVES = 0.5
MODEL_DB = 1.5
"""What the model itself is wrong by at a line: shapes of teeth, damping."""
STANDS_OUT_DB = 6.0
FARTHEST = 1.6
"""Parameters stay within this many times their declared spread."""
IDLE, CHANCE = 200, 0.95
"""Numbers without a part in the machines that are moved along, and the quantile of what they lose."""
DB = 10.0 / np.log(10.0)

Simulate = Callable[[Sequence[Offsets]], Sequence[Bank]]
"""Healthy machines with these offsets at every operating point."""


@dataclass(frozen=True, kw_only=True)
class Evidence:
    """What the baseline says: levels (n,) in dB, their line's place (point, channel, line) and frequency, Hz."""

    levels_db: FloatArray
    point: np.ndarray
    channel: np.ndarray
    line: np.ndarray
    frequency_hz: FloatArray
    repeat_db: FloatArray | float = 0.0
    """By what two recordings of one machine differ there, standard deviation (n,): a bearing that rattles under its
    load repeats its lines within several decibels, teeth within the model's error."""


@dataclass(frozen=True, kw_only=True)
class Posterior:
    """`offsets`: machines that agree with the baseline. `banks`: how they behave at every point.

    `misfit`: median over machines of the mean squared standardised residual, before and after (1: within errors).
    `determined` (numbers,): share of each number's prior variance that the baseline removed; `by_chance`: the share
    that it removes at most from 19 of 20 numbers without a bearing on the lines, as a few dozen machines correlate with
    hundreds of lines by chance. `strayed`: numbers whose mean left the declared spread. `left_db` (n,): by what the
    baseline's lines, `evidence`, stand above these machines', in the middle and without what all lines of a channel
    have in common.
    """

    offsets: tuple[Offsets, ...]
    banks: tuple[Bank, ...]
    misfit: tuple[float, float]
    determined: FloatArray
    by_chance: float
    strayed: np.ndarray
    evidence: Evidence
    left_db: FloatArray


def line_evidence(
    recorded: Sequence[Statistics], scales: Sequence[Scale], lines_hz: Sequence[FloatArray], own: np.ndarray
) -> Evidence:
    """The machine's own lines (`own`: mask (L,)) that stand out of the noise of the baselines."""
    levels, points, channels, lines, frequencies = [], [], [], [], []
    for p, (seen, scale, hz) in enumerate(zip(recorded, scales, lines_hz, strict=True)):
        power = np.nan_to_num(seen.line - scale.line_noise)
        out = own[None, :] & (power > SOFT * 10.0 ** (STANDS_OUT_DB / 10.0) * scale.line_noise)
        c, i = np.nonzero(out)
        levels.append(DB * np.log(power[out]))
        points.append(np.full(c.size, p))
        channels.append(c)
        lines.append(i)
        frequencies.append(hz[i])
    return Evidence(
        levels_db=np.concatenate(levels),
        point=np.concatenate(points),
        channel=np.concatenate(channels),
        line=np.concatenate(lines),
        frequency_hz=np.concatenate(frequencies),
    )


def _shown(banks: Sequence[Bank], evidence: Evidence) -> FloatArray:
    """The same levels of simulated machines, (N, n); NaN where a machine did not run."""
    found = np.empty((banks[0].line.shape[0], evidence.levels_db.size))
    for k in range(evidence.levels_db.size):
        line = banks[evidence.point[k]].line[:, evidence.channel[k], evidence.line[k]]
        found[:, k] = DB * np.log(line + 1e-300)
    return found


def _errors(evidence: Evidence) -> FloatArray:
    """Covariance (n, n) of path, gain and model, dB^2."""
    octaves = np.log2(evidence.frequency_hz)
    same = evidence.channel[:, None] == evidence.channel[None, :]
    path = PATH_DB**2 * np.exp(-0.5 * ((octaves[:, None] - octaves[None, :]) / PATH_OCTAVES) ** 2)
    own = np.broadcast_to(MODEL_DB**2 + np.square(evidence.repeat_db), octaves.shape)
    return np.asarray(np.where(same, path + GAIN_DB**2, 0.0) + np.diag(own))


def _misfit(residual: FloatArray, errors: FloatArray) -> float:
    solved = np.linalg.solve(errors, residual.T)
    return float(np.median(np.sum(residual.T * solved, axis=0)) / residual.shape[1])


def calibrated(
    start: Sequence[Offsets], banks: Sequence[Bank], evidence: Evidence, simulate: Simulate, *, seed: int
) -> Posterior | None:
    """Moved machines; None where the baseline has too few lines to say anything."""
    count = evidence.levels_db.size
    if count < 3:
        return None
    rng = np.random.default_rng([seed, 11])
    errors = _errors(evidence)
    theta = np.array([o.values for o in start])
    prior = theta.var(axis=0)
    idle = _idle(theta, [seed, 12])
    still = idle.var(axis=0)
    shown = _shown(banks, evidence)
    good = np.asarray(np.isfinite(shown).all(axis=1))
    before = _misfit(evidence.levels_db - shown[good], errors)
    for _ in range(ROUNDS):
        idle = _moved(idle, shown, good, evidence, ROUNDS * errors, np.random.default_rng([seed, 13]))
        theta = _moved(theta, shown, good, evidence, ROUNDS * errors, rng)
        banks = tuple(simulate([Offsets(values=row) for row in theta]))
        shown = _shown(banks, evidence)
        good = np.asarray(np.isfinite(shown).all(axis=1) & np.all([b.alive for b in banks], axis=0))
        if good.sum() < 4:
            return None
    kept = np.flatnonzero(good)
    offsets = tuple(Offsets(values=theta[k]) for k in kept)
    return Posterior(
        offsets=offsets,
        banks=tuple(b.at(kept, range(b.band.shape[1])) for b in banks),
        misfit=(before, _misfit(evidence.levels_db - shown[good], errors)),
        determined=_removed(theta, prior),
        by_chance=float(np.quantile(_removed(idle, still), CHANCE)),
        strayed=np.abs(theta.mean(axis=0)) > SPREAD,
        evidence=evidence,
        left_db=_left(evidence.levels_db - shown[good], evidence.channel),
    )


def _idle(theta: FloatArray, seed: list[int]) -> FloatArray:
    """Numbers (N, `IDLE`) spread as those of the machines, which have no part in them."""
    rng = np.random.default_rng(seed)
    return np.asarray(rng.permuted(np.resize(theta.T, (IDLE, theta.shape[0])), axis=1).T)


def _removed(theta: FloatArray, prior: FloatArray) -> FloatArray:
    return np.asarray(1.0 - theta.var(axis=0) / np.maximum(prior, 1e-12))


def _left(residual: FloatArray, channel: np.ndarray) -> FloatArray:
    """Median over machines of residuals (N, n), without the median of each channel, (n,)."""
    middle = np.median(residual, axis=0)
    common = {c: np.median(middle[channel == c]) for c in np.unique(channel)}
    return np.asarray(middle - np.array([common[c] for c in channel]))


def _moved(
    theta: FloatArray,
    shown: FloatArray,
    good: np.ndarray,
    evidence: Evidence,
    errors: FloatArray,
    rng: np.random.Generator,
) -> FloatArray:
    """One assimilation of the levels, within what the specification allows."""
    return np.asarray(
        np.clip(smoothed(theta, shown, good, evidence.levels_db, errors, rng), -FARTHEST * SPREAD, FARTHEST * SPREAD)
    )


def smoothed(
    theta: FloatArray,
    shown: FloatArray,
    good: np.ndarray,
    observed: FloatArray,
    errors: FloatArray,
    rng: np.random.Generator,
) -> FloatArray:
    """One assimilation: members `theta` (N, p) that show `shown` (N, n), those that are `good`, moved towards the
    `observed` (n,), each with an error of its own drawn from `errors` (n, n)."""
    mean = shown[good].mean(axis=0)
    a, b = theta[good] - theta[good].mean(axis=0), shown[good] - mean
    gain = np.linalg.solve(b.T @ b / (good.sum() - 1) + errors, b.T @ a / (good.sum() - 1))
    noise = rng.standard_normal((theta.shape[0], errors.shape[0])) @ np.linalg.cholesky(errors).T
    away = observed + noise - np.where(good[:, None], shown, mean)
    return np.asarray(theta + away @ gain)
