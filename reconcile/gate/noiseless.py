"""Recordings without noise: a simulation sent as it came.

Whatever a sensor hears has a floor between its lines. Where there is none, digits of a decimal place that no sensor
has decide: lines folded at the filter of the simulator are an alias, and the skirts of strong lines a floor that a
loose sensor changed. So of such a channel neither is told; and before its lines are compared with those of healthy
machines it gets white noise, the same level in all recordings of about one speed, after gains and units are undone.
"""

from __future__ import annotations

import zlib
from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace

import numpy as np

from reconcile.gate.findings import Finding
from reconcile.gate.levels import SAME_SPEED
from reconcile.speed.excess import EXPONENTIAL_MEDIAN, running_median
from signals.recording import Recording
from signals.series import FloatArray

NONE_DB = -65.0
"""Floor, as the power of a whole record whose every bin held as little, over that of the channel: simulations of the
paper's machine have -68 to -97 dB, real recordings (`make proof-real`) at least -32, and made ones with noise that were
low-passed, integrated or rounded at least -51."""
QUIET_SHARE = 75.0
"""Percentile of the frequencies, evenly spaced by their logarithm, that must be so quiet: below the corner of a low
pass, and where an acceleration is integrated, there is noise."""
STEPS_PER_OCTAVE = 12
LOWEST_BIN = 8
ADDED_DB = -50.0
"""Over the level of the channel: far below what the engine was proved with (-10 to -30 dB)."""
LEAST_BINS = 64
BLOCKS = 16
UNTOLD = ("alias", "loose_sensor")


def noiseless(recordings: Sequence[Recording], labels: Sequence[str]) -> tuple[Finding, ...]:
    """A remark for every channel that has no noise in one of the recordings."""
    quietest: dict[str, tuple[float, str]] = {}
    for recording, label in zip(recordings, labels, strict=True):
        for name, samples in zip(recording.names, recording.samples, strict=True):
            quietest[name] = min(quietest.get(name, (0.0, label)), (floor_db(samples), label))
    return tuple(
        Finding(
            kind="noiseless",
            channel=name,
            recording=label,
            detail=f"{floor:.0f} dB between its lines, as in a simulation: noise of {ADDED_DB:.0f} dB is added to this "
            "channel in all recordings",
            severity=0.0,
        )
        for name, (floor, label) in quietest.items()
        if floor < NONE_DB
    )


def told(found: Sequence[Finding], bare: Collection[str]) -> tuple[Finding, ...]:
    """Without what cannot be told of channels that have no noise."""
    return tuple(f for f in found if not (f.kind in UNTOLD and f.channel in bare))


def with_floor(
    recordings: Sequence[Recording], speeds_hz: Sequence[float], bare: Collection[str]
) -> tuple[Recording, ...]:
    """Noise of `ADDED_DB` on the channels that have none, over the loudest recording of about the same speed."""
    levels = [{name: _level(r, name) for name in bare if name in r.names} for r in recordings]
    found = []
    for recording, speed in zip(recordings, speeds_hz, strict=True):
        near = [one for one, hz in zip(levels, speeds_hz, strict=True) if abs(hz / speed - 1.0) <= SAME_SPEED]
        loudest = {n: max(one[n] for one in near if n in one) for n in bare if n in recording.names}
        found.append(_noisy(recording, loudest))
    return tuple(found)


def floor_db(samples: FloatArray) -> float:
    """Level of the floor between lines over that of the signal, dB; 0 for records too short to have one."""
    power = np.abs(np.fft.rfft((samples - np.mean(samples)) * np.hanning(samples.size))) ** 2
    total = float(np.sum(power))
    if power.size < LEAST_BINS or not 0.0 < total < np.inf:
        return 0.0
    octaves = np.log2((power.size - 1) / LOWEST_BIN)
    places = LOWEST_BIN * 2.0 ** np.linspace(0.0, octaves, max(2, int(STEPS_PER_OCTAVE * octaves)))
    floor = running_median(power)[np.minimum(places.astype(np.int64), power.size - 1)] / EXPONENTIAL_MEDIAN
    high = float(np.percentile(floor, QUIET_SHARE))
    return float(10 * np.log10(max(high * power.size / total, 1e-30)))


def _level(recording: Recording, name: str) -> float:
    """Deviation of the channel, the median of blocks: one knock is no level."""
    samples = recording.samples[recording.names.index(name)]
    return float(np.median([np.std(block) for block in np.array_split(samples, BLOCKS)]))


def _noisy(recording: Recording, level: Mapping[str, float]) -> Recording:
    """White noise on each channel that has a level: the same bytes for the same samples, whatever else is sent."""
    if not level:
        return recording
    samples = recording.samples.copy()
    for name, one in level.items():
        row = recording.names.index(name)
        rng = np.random.default_rng([17, zlib.crc32(np.ascontiguousarray(samples[row]).tobytes())])
        samples[row] += 10 ** (ADDED_DB / 20) * one * rng.standard_normal(samples.shape[1])
    return replace(recording, samples=samples)
