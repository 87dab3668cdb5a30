"""When a value is out of the ordinary: against the median and spread of baselines, and against fixed limits.

All values are levels in dB (20 log10). The limit over `n` baselines is median + factor(n) * 1.4826 MAD, where 1.4826
MAD estimates the standard deviation of a Gaussian (P. J. Rousseeuw and C. Croux, J. Am. Stat. Assoc. 88 (1993)
1273-1283). Median and MAD of few recordings are themselves uncertain, so the factor grows as there are fewer: one more
recording of the same Gaussian lies beyond the limit with the probability stated, on average over the baselines. The
factors were found by integrating that probability over 2 million draws of n baselines; a test draws others.
"""

from __future__ import annotations

import bisect
import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from jobs.health.words import Severity

LEAST_BASELINES = 8
"""From fewer no alarm is given: with five, the limit would stand 33 deviations away."""
WARNING_CHANCE, ALARM_CHANCE = 1e-3, 1e-4
"""Probability, per value, that a recording like the baselines is told a warning or an alarm."""
MAD_TO_SIGMA = 1.4826
COUNTS = (8, 10, 12, 14, 16, 20, 24, 32, 48, 64, 100)
WARNING_FACTORS = (9.52, 7.46, 6.38, 5.71, 5.26, 4.71, 4.38, 4.00, 3.67, 3.51, 3.35)
ALARM_FACTORS = (17.91, 12.71, 10.20, 8.70, 7.76, 6.66, 6.02, 5.30, 4.70, 4.43, 4.15)
LEVEL_RISE_DB = 2.0
"""About a quarter: less is no news, however alike the baselines are."""
FAMILY_WARNING_DB, FAMILY_ALARM_DB = 6.0, 12.0
"""Twice and four times the amplitude."""


@dataclass(frozen=True, kw_only=True)
class Baseline:
    """Median and 1.4826 MAD of `recordings` values, dB."""

    recordings: int
    median_db: float
    sigma_db: float

    def limit_db(self, factors: Sequence[float], rise_db: float) -> float:
        """Beyond it a value is out of the ordinary, and by a rise that matters."""
        factor = factors[bisect.bisect_right(COUNTS, self.recordings) - 1]
        return self.median_db + max(factor * self.sigma_db, rise_db)


@dataclass(frozen=True, kw_only=True)
class Judged:
    """A value against its baseline; `severity` is None within the ordinary. `warning` and `alarm` are limits in the
    unit of the value."""

    rise_db: float
    warning: float
    alarm: float
    severity: Severity | None


def baseline_of(values: Sequence[float]) -> Baseline | None:
    """Of values above zero; None where fewer than 8 are left."""
    levels = np.array([decibel(v) for v in values if v > 0 and math.isfinite(v)])
    if levels.size < LEAST_BASELINES:
        return None
    median = float(np.median(levels))
    sigma = MAD_TO_SIGMA * float(np.median(np.abs(levels - median)))
    return Baseline(recordings=int(levels.size), median_db=median, sigma_db=sigma)


def judge(value: float, baseline: Baseline, *, family: bool) -> Judged:
    """Against the spread; a family of lines must besides have risen by 6 dB (12 dB: alarm), others by 2 dB."""
    warning, alarm = _limits(baseline, family)
    rise_db = (decibel(value) if value > 0 else -math.inf) - baseline.median_db
    severity: Severity | None = "alarm" if value > alarm else "warning" if value > warning else None
    return Judged(rise_db=rise_db, warning=warning, alarm=alarm, severity=severity)


@lru_cache(maxsize=16_384)
def _limits(baseline: Baseline, family: bool) -> tuple[float, float]:
    """Of warning and alarm, in the unit of the values."""
    rises = (FAMILY_WARNING_DB, FAMILY_ALARM_DB) if family else (LEVEL_RISE_DB, LEVEL_RISE_DB)
    return (
        amplitude(baseline.limit_db(WARNING_FACTORS, rises[0])),
        amplitude(baseline.limit_db(ALARM_FACTORS, rises[1])),
    )


def decibel(value: float) -> float:
    """20 log10."""
    return 20 * math.log10(value)


def amplitude(level_db: float) -> float:
    """Inverse of `decibel`."""
    return float(10 ** (level_db / 20))


SPREAD_RULE = (
    "20 log10 of the value beyond median + factor x 1.4826 MAD of at least 8 baseline recordings of the same channel "
    "at like speed (3 %) and torque (10 %); the factor depends on their number so that a recording of the same "
    "Gaussian is told a warning with probability 1e-3 and an alarm with 1e-4, per value"
)
LEVEL_RULE = f"{SPREAD_RULE}; and at least 2 dB above the median"
FAMILY_RULE = f"{SPREAD_RULE}; and at least 6 dB (alarm: 12 dB) above the median"
