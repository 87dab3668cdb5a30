"""Another filter before the converter: above some frequency all channels lost, or gained, alike at all speeds.

What a machine does to lines and floor differs from sensor to sensor and from speed to speed; one filter setting of the
recorder does the same to all of them, and nothing below its corner.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from functools import reduce

import numpy as np
import scipy
from scipy import fft

from reconcile.gate.findings import Finding
from reconcile.gate.levels import Pair
from signals.recording import Recording
from signals.series import FloatArray

LEAST_DB = 10.0
"""At the highest band: a filter of second order an octave above its corner."""
FLAT_DB = 1.5
"""Below the corner; what is no more is undone, the rest cannot be: the noise of the converter lies over it."""
ALIKE_DB, ALIKE_SHARE = 1.5, 0.15
"""By which channels, lines, floor and speeds may differ, at least or as a share of the change."""
MOST = 0.8
"""Of all channels, lines and floor, speeds: single lines drift by 10 dB between two recordings of a sound machine."""
LEAST_BANDS = 6
"""An octave that passes."""
HEARD = 0.42
"""Share of the sampling rate up to which lines are looked at."""
FINEST = 20
"""Largest denominator of the ratio of rates."""


def filter_findings(pairs: Sequence[Pair]) -> tuple[Finding, ...]:
    """`filter_change` where all channels (two at least) changed by one curve from a corner on."""
    shared = reduce(np.intersect1d, [p.band for p in pairs]) if pairs else np.zeros(0)
    if not shared.size or any(len(p.names) < 2 or p.names != pairs[0].names for p in pairs):
        return ()
    places = [np.searchsorted(p.band, shared) for p in pairs]
    own = np.concatenate(
        [(p.test - p.baseline)[:, :, at].reshape(-1, shared.size) for p, at in zip(pairs, places, strict=True)]
    )
    curve = np.median(own, axis=0)
    passed = _passed(curve)
    if passed < LEAST_BANDS or passed == curve.size or abs(float(curve[-1])) < LEAST_DB:
        return ()
    allowed, apart = np.maximum(ALIKE_DB, ALIKE_SHARE * np.abs(curve)), np.abs(own - curve)
    most, half = np.quantile(apart, MOST, axis=0), np.median(apart, axis=0)
    if np.any((most > 2.0 * allowed)[passed:]) or np.any((half > allowed)[passed:]):
        return ()
    hz = pairs[0].centre_hz[places[0]]
    detail = f"all channels changed alike above {hz[passed - 1]:.4g} Hz, by {curve[-1]:+.0f} dB at {hz[-1]:.4g} Hz, "
    detail += "lines and noise at every speed: another filter, or sensors of another kind; nothing above is compared"
    return (
        Finding(
            kind="filter_change",
            channel="",
            recording="all tests",
            detail=detail,
            severity=float(min(1.0, abs(float(curve[-1])) / 40)),
            where=f"above {hz[passed - 1]:.4g} Hz",
            fault=True,
            transfer_db=tuple(zip(map(float, hz[:passed]), map(float, curve[:passed]), strict=True)),
        ),
    )


def _passed(curve: FloatArray) -> int:
    """Bands that pass: all before the last one within `FLAT_DB`, after which the change only grows."""
    flat = np.flatnonzero(np.abs(curve) <= FLAT_DB)
    if not flat.size or np.any(np.abs(curve[: flat[-1]]) > 2.0 * FLAT_DB):
        return 0
    beyond = np.sign(curve[-1]) * np.diff(curve[flat[-1] :])
    return int(flat[-1]) + 1 if np.all(beyond > -ALIKE_DB) else 0


def below_the_corner(recordings: Sequence[Recording], finding: Finding, *, undone: bool) -> list[Recording]:
    """The recordings at a rate whose heard part ends where the filter begins, what it did below that taken back
    from those that are `undone`."""
    hz, change_db = np.asarray(finding.transfer_db).T
    return [_below(one, hz, change_db if undone else np.zeros(hz.size)) for one in recordings]


def _below(recording: Recording, hz: FloatArray, change_db: FloatArray) -> Recording:
    samples, rate = recording.samples, recording.sampling_rate_hz
    gain = 10 ** (-np.interp(np.fft.rfftfreq(samples.shape[1], 1 / rate), hz, change_db) / 20)
    samples = fft.irfft(fft.rfft(samples, axis=1) * gain, samples.shape[1], axis=1)
    ratio = Fraction(float(hz[-1]) / HEARD / rate).limit_denominator(FINEST)
    if 0 < ratio < 1:
        samples = scipy.signal.resample_poly(samples, ratio.numerator, ratio.denominator, axis=1)
        rate *= float(ratio)
    return replace(recording, sampling_rate_hz=rate, samples=np.asarray(samples))
