"""Scores to probabilities."""

from __future__ import annotations

import numpy as np

from signals.series import FloatArray


def softmax(scores: FloatArray) -> FloatArray:
    """Rows of exp(score) over their sum, (rows, classes)."""
    shifted = np.exp(scores - np.max(scores, axis=1, keepdims=True))
    return np.asarray(shifted / np.sum(shifted, axis=1, keepdims=True), dtype=np.float64)
