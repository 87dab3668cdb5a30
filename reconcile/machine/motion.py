"""What an effect alone adds to the motion of a machine, and the sensors' path from there to the recorded samples."""

from __future__ import annotations

import numpy as np

from reconcile.atlas.run import SETTLE_S
from reconcile.calibrate.chain import Chain, band_centres_hz
from signals.series import FloatArray
from sim.core.errors import SidebandError
from sim.core.response import Response


def path_gain(chain: Chain, hz: FloatArray) -> FloatArray:
    """Amplitude gains (C, n) at frequencies (n,)."""
    at = np.log(np.maximum(hz, 1.0))
    return np.array([10.0 ** (np.interp(at, np.log(band_centres_hz()), row) / 20.0) for row in chain.gain_db])


def added_motion(one: Response | SidebandError, other: Response | SidebandError) -> FloatArray | None:
    """What an effect adds to the channels (C, n) of its machine; None where one does not run or nothing is added."""
    if not isinstance(one, Response) or not isinstance(other, Response):
        return None
    first = round(SETTLE_S * one.sampling_rate_hz)
    added = np.asarray(one.signals[:, first:]) - np.asarray(other.signals[:, first:])
    return added if bool(np.all(np.isfinite(added))) and float(np.abs(added).max()) > 0.0 else None
