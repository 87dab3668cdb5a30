"""Recordings without noise: a simulation sent as it came.

Whatever a sensor hears has a floor between its lines. Where there is none, digits of a decimal place that no sensor
has decide: lines folded at the filter of the simulator are an alias, and the skirts of strong lines a floor that a
loose sensor changed. Such a channel gets white noise in every recording alike, before anything is compared.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from reconcile.gate.findings import Finding
from reconcile.speed.excess import EXPONENTIAL_MEDIAN, running_median
from signals.recording import Recording
from signals.series import FloatArray

NONE_DB = -65.0
"""Floor, as the power of a whole record whose every bin held as little, over that of the channel: simulations of the
paper's machine have -71 to -107 dB, real recordings (`make proof-real`) at least -33."""
QUIET_SHARE = 75.0
"""Percentile of the bins that must be so quiet: behind a low pass there is noise below the corner."""
ADDED_DB = -50.0
"""Of the loudest record of the channel: far below what the engine was proved with (10 to 30 dB)."""
LEAST_BINS = 64


def with_floor(
    recordings: Sequence[Recording], labels: Sequence[str], seed: int
) -> tuple[list[Recording], tuple[Finding, ...]]:
    """The recordings, noise added to every channel that has none in one of them, and a remark for each such record."""
    found: list[Finding] = []
    for recording, label in zip(recordings, labels, strict=True):
        for name, samples in zip(recording.names, recording.samples, strict=True):
            floor = floor_db(samples)
            if floor < NONE_DB:
                detail = f"{floor:.0f} dB between its lines, as in a simulation: white noise {ADDED_DB:.0f} dB added"
                found.append(Finding(kind="noiseless", channel=name, recording=label, detail=detail, severity=0.0))
    bare = {f.channel for f in found}
    level = {name: max(_deviation(r, name) for r in recordings if name in r.names) for name in bare}
    return [_noisy(r, level, (seed, 17, k)) for k, r in enumerate(recordings)], tuple(found)


def floor_db(samples: FloatArray) -> float:
    """Level of the floor between lines over that of the signal, dB; 0 for records too short to have one."""
    power = np.abs(np.fft.rfft((samples - np.mean(samples)) * np.hanning(samples.size))) ** 2
    total = float(np.sum(power))
    if power.size < LEAST_BINS or total <= 0.0:
        return 0.0
    high = float(np.percentile(running_median(power), QUIET_SHARE)) / EXPONENTIAL_MEDIAN
    return float(10 * np.log10(max(high * power.size / total, 1e-30)))


def _deviation(recording: Recording, name: str) -> float:
    return float(np.std(recording.samples[recording.names.index(name)]))


def _noisy(recording: Recording, level: dict[str, float], seed: tuple[int, ...]) -> Recording:
    """White noise of `ADDED_DB` on each channel that has a level; the same bytes for the same recording and seed."""
    if not any(name in level for name in recording.names):
        return recording
    rng = np.random.default_rng(seed)
    noise = rng.standard_normal(recording.samples.shape)
    scale = np.array([10 ** (ADDED_DB / 20) * level.get(name, 0.0) for name in recording.names])
    return replace(recording, samples=recording.samples + scale[:, np.newaxis] * noise)
