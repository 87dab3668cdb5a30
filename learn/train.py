"""Training on simulated rows: scikit-learn fits, `model.Head` keeps the numbers.

Machines, not rows, are parted wherever something is chosen on rows that a fit has not seen.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence

import numpy as np
from scipy.optimize import minimize_scalar
from sklearn.exceptions import ConvergenceWarning
from sklearn.neural_network import MLPClassifier

from learn.model import CLIP, Head, Network
from learn.softmax import softmax
from signals.series import FloatArray

HIDDEN = (16,)
PENALTY = 10.0
ITERATIONS = 400
NETWORKS = 5
LEAST_SCALE = 1e-3


def fit_head(
    rows: FloatArray,
    labels: Sequence[str],
    machines: Sequence[int],
    features: tuple[str, ...],
    classes: tuple[str, ...],
    *,
    seed: int = 0,
    networks: int = NETWORKS,
    hidden: tuple[int, ...] = HIDDEN,
) -> Head:
    """Networks on everything, each from another start; the temperature from machines left out in turn.

    Without `hidden` units a network is a softmax regression, for which every start gives the same.
    """
    kinds = np.array([classes.index(x) for x in labels])
    owner = np.unique(np.asarray(machines), return_inverse=True)[1]
    mean, scale = np.mean(rows, axis=0), np.maximum(np.std(rows, axis=0), LEAST_SCALE)
    z = np.clip((rows - mean) / scale, -CLIP, CLIP)
    weights = _balanced(kinds, len(classes))
    found = tuple(_network(z, kinds, weights, seed + i, hidden) for i in range(networks))
    temperature = _temperature(z, kinds, owner, weights, seed, hidden)
    return Head(features=features, classes=classes, mean=mean, scale=scale, networks=found, temperature=temperature)


def _balanced(kinds: np.ndarray[tuple[int, ...], np.dtype[np.int64]], classes: int) -> FloatArray:
    counts = np.bincount(kinds, minlength=classes)
    return np.asarray(kinds.size / (classes * np.maximum(counts, 1)[kinds]), dtype=np.float64)


def _network(
    z: FloatArray,
    kinds: np.ndarray[tuple[int, ...], np.dtype[np.int64]],
    weights: FloatArray,
    seed: int,
    hidden: tuple[int, ...],
) -> Network:
    fitted = MLPClassifier(
        hidden_layer_sizes=hidden,
        activation="tanh",
        solver="lbfgs",
        alpha=PENALTY,
        max_iter=ITERATIONS,
        random_state=seed,
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ConvergenceWarning)  # stopped early on purpose: it regularises
        fitted.fit(z, kinds, sample_weight=weights)
    w, b = [np.asarray(c) for c in fitted.coefs_], [np.asarray(c) for c in fitted.intercepts_]
    if fitted.out_activation_ == "logistic":  # two classes: one output; the other's score is 0
        w[-1], b[-1] = np.hstack([0 * w[-1], w[-1]]), np.concatenate([0 * b[-1], b[-1]])
    return Network(weights=tuple(w), offsets=tuple(b))


def _temperature(
    z: FloatArray,
    kinds: np.ndarray[tuple[int, ...], np.dtype[np.int64]],
    owner: np.ndarray[tuple[int, ...], np.dtype[np.int64]],
    weights: FloatArray,
    seed: int,
    hidden: tuple[int, ...],
    folds: int = 4,
) -> float:
    """Temperature (C. Guo et al., ICML 2017) that makes left-out machines likeliest."""
    scores = np.zeros((z.shape[0], int(kinds.max()) + 1))
    for fold in range(folds):
        out = owner % folds == fold
        if not np.any(out) or np.unique(kinds[~out]).size <= kinds.max():
            return 1.0
        scores[out] = _network(z[~out], kinds[~out], weights[~out], seed, hidden).scores(z[out])

    def loss(log_t: float) -> float:
        p = softmax(scores / np.exp(log_t))[np.arange(kinds.size), kinds]
        return float(-np.mean(weights * np.log(np.maximum(p, 1e-12))))

    return float(np.exp(minimize_scalar(loss, bounds=(-1.5, 2.5), method="bounded").x))
