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
from scipy import fft

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
ADDED_DB, MOST_DB = -50.0, -20.0
"""Over the level of the loudest recording of about one speed: far below what the engine was proved with (-10 to -30
dB); and at most over that of the quietest: what strikes may be a thousand times as loud as the sound machine was."""
ALIKE_DB = 10.0
"""Below the floor that a channel has in another recording a floor is none of a sensor: above it the channel has noise,
however little that is beside what a damaged part does."""
LEAST_BINS = 64
BLOCKS = 16
UNTOLD = ("alias", "loose_sensor")

_Floor = tuple[float, float, str]
"""Over its channel's level, dB, and by itself, dB; label of the recording."""


def noiseless(recordings: Sequence[Recording], labels: Sequence[str]) -> tuple[Finding, ...]:
    """A remark for every channel that has no noise in one of the recordings, nor that of another one."""
    floors: dict[str, list[_Floor]] = {}
    for recording, label in zip(recordings, labels, strict=True):
        for name, samples in zip(recording.names, recording.samples, strict=True):
            power = float(np.mean((samples - np.mean(samples)) ** 2))
            if 0.0 < power < np.inf:
                relative = floor_db(samples)
                floors.setdefault(name, []).append((relative, relative + float(10 * np.log10(power)), label))
    quietest = {name: _bare(seen) for name, seen in floors.items()}
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


def _bare(floors: Sequence[_Floor]) -> tuple[float, str]:
    """The lowest floor over its channel's level that no other recording shows to be a sensor's; 0 dB where all are."""
    sensed = [absolute for relative, absolute, _ in floors if relative >= NONE_DB]
    bare = [
        (relative, label)
        for relative, absolute, label in floors
        if relative < NONE_DB and all(absolute < other - ALIKE_DB for other in sensed)
    ]
    return min(bare, default=(0.0, ""))


def told(found: Sequence[Finding], bare: Collection[str]) -> tuple[Finding, ...]:
    """Without what cannot be told of channels that have no noise."""
    return tuple(f for f in found if not (f.kind in UNTOLD and f.channel in bare))


def with_floor(
    recordings: Sequence[Recording], speeds_hz: Sequence[float], bare: Collection[str]
) -> tuple[Recording, ...]:
    """Noise of `ADDED_DB` on the channels that have none, over the loudest recording of about the same speed, but at
    most `MOST_DB` over the quietest one."""
    levels = [{name: _level(r, name) for name in bare if name in r.names} for r in recordings]
    found = []
    for recording, speed in zip(recordings, speeds_hz, strict=True):
        near = [one for one, hz in zip(levels, speeds_hz, strict=True) if abs(hz / speed - 1.0) <= SAME_SPEED]
        heard = {n: [one[n] for one in near if one.get(n, 0.0) > 0.0] for n in bare if n in recording.names}
        added = {n: min(_times(max(own), ADDED_DB), _times(min(own), MOST_DB)) for n, own in heard.items() if own}
        found.append(_noisy(recording, added))
    return tuple(found)


def floor_db(samples: FloatArray) -> float:
    """Level of the floor between lines over that of the signal, dB; 0 for records too short to have one."""
    power = np.abs(fft.rfft((samples - np.mean(samples)) * np.hanning(samples.size))) ** 2
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


def _times(level: float, db: float) -> float:
    return float(level * 10 ** (db / 20))


def _noisy(recording: Recording, deviation: Mapping[str, float]) -> Recording:
    """White noise on each channel that has a deviation: the same bytes for the same samples, whatever else is sent."""
    if not deviation:
        return recording
    samples = recording.samples.copy()
    for name, one in deviation.items():
        row = recording.names.index(name)
        rng = np.random.default_rng([17, zlib.crc32(np.ascontiguousarray(samples[row]).tobytes())])
        samples[row] += one * rng.standard_normal(samples.shape[1])
    return replace(recording, samples=samples)
