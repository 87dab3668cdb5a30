"""Indicators that compare a run with the ones before it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from signals.series import FloatArray


def quasi_kurtosis(signal: FloatArray, earlier: Sequence[FloatArray] = ()) -> float | None:
    """Fourth moment of `signal` over the square of the variance averaged over this run and all `earlier` ones.

    N sum (r - mean)^4 / (1/M sum_j sum_i (r_ij - mean_j)^2)^2 for equally long runs: it rises when a defect grows over
    several teeth, where a kurtosis falls again. NA4, of the residual signal: J. J. Zakrajsek, D. P. Townsend and
    H. J. Decker, "An analysis of gear fault detection methods as applied to pitting fatigue failure data", NASA
    TM-105950 (1993). NB4 is the same of the envelope of the mesh band. With no earlier run it is the kurtosis.
    """
    centred = signal - np.mean(signal)
    variance = float(np.mean([np.var(run) for run in (signal, *earlier)]))
    return None if variance == 0 else float(np.mean(centred**4) / variance**2)
