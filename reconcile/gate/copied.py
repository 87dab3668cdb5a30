"""Channels that carry one signal: a copy, or a copy times a factor, is no second sensor.

Two sensors hear one machine through paths of their own and add noise of their own, so even where a slow strong line
makes them nearly alike the rest of their spectra is not. What is left of one beside the other is therefore looked at in
second differences, which take slow lines away.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reconcile.gate.findings import Finding
from reconcile.gate.levels import channel_levels
from reconcile.gate.noiseless import NONE_DB, floor_db
from signals.recording import Recording
from signals.series import FloatArray

LEFT_DB = -30.0
"""Of a channel's power, in second differences, that a copy may differ by: what rounding after a gain leaves. Of 391
pairs of channels of real recordings (two sensors and more), a rig, gearboxes and made machines none has less than -4.0
(-2.5 of the real ones)."""
LEAST_SAMPLES = 256
CLEARLY_DB = 2.0
"""By which a copy must be farther from its own baseline than the channel that it is of, on the mean of all bands."""
CLEAR_SHARE, LEAST_RMS_DB = 0.6, 1.0
"""Or, where few bands tell sensors apart (a resonance of the place): the root mean square deviations, of the channel's
over the copy's at most, and the copy's at least."""

Groups = tuple[tuple[str, ...], ...]


def copies(recording: Recording) -> Groups:
    """Names of channels that carry one signal, those of each signal together; none of simulations without noise, where
    two sensors on one body are rightly alike."""
    rows = {name: _moved(samples) for name, samples in zip(recording.names, recording.samples, strict=True)}
    found: list[list[str]] = []
    left = [name for name, row in rows.items() if row is not None]
    while left:
        first, *others = left
        same = [name for name in others if _left_db(rows[first], rows[name]) < LEFT_DB]
        if same and floor_db(recording.samples[recording.names.index(first)]) >= NONE_DB:
            found.append([first, *same])
        left = [name for name in others if name not in same]
    return tuple(tuple(group) for group in found)


def copy_findings(
    tests: Sequence[Recording], baselines: Sequence[Recording], labels: Sequence[str]
) -> tuple[Finding, ...]:
    """`copied` for each channel of a test that is to be left out, one of every group being kept; where the baselines
    carry one signal on the same channels too that is no fault of the tests, but told."""
    before = {frozenset(group) for one in baselines for group in copies(one)}
    found = []
    for test, label in zip(tests, labels, strict=True):
        for group in copies(test):
            kept, sure = _own(test, baselines, group)
            shared = any(set(group) <= old for old in before)
            said = f"the signal of {kept}" if sure else "one signal, whose is not told; the first is kept"
            for name in (n for n in group if n != kept):
                detail = f"{name} carries {said}" if sure else f"{kept} and {name} carry {said}"
                found.append(
                    Finding(
                        kind="copied",
                        channel=name,
                        recording=label,
                        detail=f"{detail}: a copy{_factor(test, name, kept)} is no second sensor"
                        + ("; in a baseline as well" if shared else ""),
                        severity=1.0,
                        fault=not shared,
                    )
                )
    return tuple(found)


def _own(test: Recording, baselines: Sequence[Recording], group: Sequence[str]) -> tuple[str, bool]:
    """The channel of a group whose own the signal is by the baselines' shapes of spectra, and whether that is clear."""
    base = next((b for b in baselines if all(n in b.names for n in group)), None)
    if base is None or base.sampling_rate_hz != test.sampling_rate_hz:
        return group[0], False
    apart = {name: _unlike(test, base, name) for name in group}
    first, second = sorted(apart, key=lambda name: (apart[name][0], name))[:2]
    (near, near_rms), (far, far_rms) = apart[first], apart[second]
    clear = far - near >= CLEARLY_DB or (far_rms >= LEAST_RMS_DB and near_rms < CLEAR_SHARE * far_rms)
    return (first, True) if clear else (group[0], False)


def _unlike(test: Recording, base: Recording, name: str) -> tuple[float, float]:
    """Mean and root mean square deviation, dB, of a channel's bands from its baseline's but for one gain."""
    now, then = channel_levels(test, name), channel_levels(base, name)
    _, a, b = np.intersect1d(now.band, then.band, assume_unique=True, return_indices=True)
    change = np.concatenate([now.floor_db[a] - then.floor_db[b], now.mean_db[a] - then.mean_db[b]])
    off = np.abs(change - np.median(change)) if change.size else np.zeros(1)
    return float(np.mean(off)), float(np.sqrt(np.mean(off**2)))


def _factor(test: Recording, name: str, kept: str) -> str:
    x, y = (test.samples[test.names.index(n)] for n in (kept, name))
    factor = float(np.dot(np.diff(x, 2), np.diff(y, 2)) / np.dot(np.diff(x, 2), np.diff(x, 2)))
    return "" if abs(factor - 1.0) < 1e-3 else f" times {factor:.3g}"


def _moved(samples: FloatArray) -> FloatArray | None:
    """Second differences (n - 2,) of unit size; None of what is too short, not finite or does not move."""
    if samples.size < LEAST_SAMPLES or not np.all(np.isfinite(samples)):
        return None
    change = np.diff(samples, 2)
    size = float(np.linalg.norm(change))
    return change / size if size > 0.0 else None


def _left_db(one: FloatArray | None, other: FloatArray | None) -> float:
    """What is left of one beside the other, dB of its power."""
    if one is None or other is None:
        return 0.0
    return 10.0 * float(np.log10(max(1.0 - float(np.dot(one, other)) ** 2, 1e-12)))
