"""How large the effect is: the sizes of the draws near the observation, weighted by how near they are."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from reconcile.atlas.candidates import size_parameter
from reconcile.judge.space import Fitted
from reconcile.machine.library import Catalogued
from reconcile.verdict import Severity
from signals.series import FloatArray
from sim.core.params import Param
from sim.terms import REGISTRY

LEAST_SPREAD = 0.3
"""Standard deviation of the logarithm below which no size is claimed: half of the sizes named in the proof were off by
more than a fifth, and with 0.08 four of nine intervals held the truth."""
TELLS = 0.6
"""The same from which levels hardly tell a size: the draws near the observation are then spread over most that are
sought."""
SURE = 0.1
"""Standard deviation beside `LEAST_SPREAD` below which no way of measuring a size counts as surer than another."""
COVER = 1.645
"""Normal quantile of a 90 % interval."""


def _weights(squared: FloatArray, scale: float) -> FloatArray:
    log = -0.5 * (squared - squared.min()) / scale
    weights = np.exp(log)
    return np.asarray(weights / weights.sum())


def parameter_of(name: str) -> Param:
    """The parameter that says how large `effect@site` is; ValueError for an effect that is not registered."""
    term = REGISTRY.get(name.split("@", maxsplit=1)[0])
    if term is None:
        raise ValueError(name)
    return size_parameter(term)


def estimated_severity(fitted: Fitted, known: Catalogued, name: str, observed: FloatArray) -> Severity:
    """Weighted mean and 90 % interval of the logarithm of the size over the points of the effect's path."""
    size = parameter_of(name)
    owner = fitted.paths.names.index(name)
    rows = np.flatnonzero((fitted.paths.owner == owner) & (fitted.paths.low >= 0))
    squared = fitted.paths.distances(fitted.place(observed))[rows]
    values = np.array([_size(known, fitted, int(k), size.name) for k in rows])
    scale = max(fitted.overdispersion, float(np.partition(squared, min(2, squared.size - 1))[:3].mean()) * 0.1)
    return weighted_severity(size, values, evened(values, _weights(squared, scale)))


def evened(values: FloatArray, weights: FloatArray) -> FloatArray:
    """Weights (n,) of sizes (n,) by the share of the scale that each stands for: draws crowd where the search went,
    which says nothing of how large an effect is."""
    logs = np.log(np.maximum(values, 1e-300))
    crowd = np.exp(-0.5 * ((logs[:, None] - logs[None, :]) / LEAST_SPREAD) ** 2).sum(axis=1)
    return np.asarray(weights / crowd / (weights / crowd).sum())


def weighted_severity(size: Param, values: FloatArray, weights: FloatArray) -> Severity:
    """Weighted mean and 90 % interval of the logarithm of sizes (n,); `weights` (n,) sum to 1."""
    logs = np.log(np.maximum(values, 1e-300))
    mean = float(weights @ logs)
    steps: FloatArray = np.diff(np.sort(logs))
    grid = float(np.median(steps)) if steps.size else 0.3
    return severity_of(size, mean, float(np.sqrt(weights @ (logs - mean) ** 2 + LEAST_SPREAD**2 + (0.5 * grid) ** 2)))


def severity_of(size: Param, mean: float, spread: float) -> Severity:
    """A size from the mean and the standard deviation of its logarithm, with a 90 % interval within its bounds."""
    low, high = np.exp(mean - COVER * spread), np.exp(mean + COVER * spread)
    return Severity(
        name=size.name,
        value=float(np.exp(mean)),
        unit=size.unit,
        low=max(float(low), size.low),
        high=min(float(high), size.high),
    )


def joined(one: Severity, other: Severity | None) -> Severity:
    """A size by levels and the same by what is heard of the effect: the latter, where levels hardly tell, else both as
    they are sure but for `LEAST_SPREAD`, which both have; what they differ by is in the interval."""
    if other is None or _spread(one) > TELLS:
        return other or one
    own = np.array([_spread(one), _spread(other)]) ** 2 - LEAST_SPREAD**2
    sure = 1.0 / np.maximum(own, SURE**2)
    weights = sure / sure.sum()
    logs = np.log([one.value, other.value])
    mean = float(weights @ logs)
    spread = float(np.sqrt(1.0 / float(sure.sum()) + LEAST_SPREAD**2 + weights @ (logs - mean) ** 2))
    low, high = np.exp(mean - COVER * spread), np.exp(mean + COVER * spread)
    return replace(
        one, value=float(np.exp(mean)), low=max(float(low), min(one.low, other.low)),
        high=min(float(high), max(one.high, other.high)),
    )  # fmt: skip


def _spread(one: Severity) -> float:
    """Standard deviation of the logarithm by the interval, whose ends may be those of the parameter."""
    return float(np.log(one.high / max(one.low, 1e-300)) / (2.0 * COVER)) if one.high > 0.0 else np.inf


def _size(known: Catalogued, fitted: Fitted, point: int, name: str) -> float:
    first, second = int(fitted.paths.low[point]), int(fitted.paths.high[point])
    sizes = [abs(known.terms[k].parameters[name]) for k in (first, second)]
    return float(np.sqrt(max(sizes[0] * sizes[1], 1e-300)))
