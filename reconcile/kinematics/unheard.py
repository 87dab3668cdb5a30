"""Whether a channel holds any line at all; and tests of noise alone where the sound machine was heard.

A sensor that hears noise alone cannot call a machine sound, nor louder, nor anything else.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import scipy
from scipy import fft

from reconcile.gate.findings import Finding, Gate, worst
from reconcile.gate.loose import transferred
from reconcile.gate.spoiled import HEARD
from reconcile.kinematics.envelopes import squared_envelope, whitened
from reconcile.speed.excess import line_excess, mains_bins, power_over_floor
from signals.recording import Recording
from signals.series import FloatArray, Series

CHANCE = 1e-4
"""Of a line that stands out of noise alone somewhere in a spectrum, about."""
SPREAD = 1.4
"""By which bins stand out further than exponential ones: the floor is estimated, and neighbours share a window."""
BAND = (0.01, 0.485)
"""Of the sampling rate: the envelope's."""
ENVELOPE_SHARE = 0.05
"""Of the sampling rate: up to where lines of the envelope are looked for."""
LOWEST_BIN, HIGHEST_BINS = 10, 50
"""Left out: there the floor is that of few neighbours."""
LEAST_S, LEAST_SAMPLES = 1.0, 16_384
"""Of shorter records too little is seen. Of 149 recordings (27 measured ones of machines, a rig, gearboxes, made ones)
every channel of every one holds a line; of their parts of 16384 samples one channel in 70 does not though the baseline
does, all of one motor in a third of a second."""
SURELY = 3.0
"""By which the line of the baseline must be higher than the highest of noise, in as long a part of it."""

COMMON_SEGMENT, COMMON_SHARE, COMMON_BINS = 512, 0.5, 8
"""Two channels share noise where so many bins are coherent by so much. Of noises of their own none is: the chance of
one bin is 0.5^(segments - 1), and 16384 samples hold some 60 segments (Carter, Proc. IEEE 75, 1987, p. 236). One tone
of a mains fills three or four; two loose rings that drowned all lines of the sensor above them had 9 and 22."""
SHAPE_BINS, SMOOTH = slice(20, 205), 9
"""Bins of a spectrum of so many samples in which its shape is compared, lines taken off by a running median."""
ALIKE, COLOURED_DB = 0.6, 0.3
"""Correlation of the shape (log power) with a baseline's, and deviation of both, from which it is the same machine's:
under the two loose rings 0.73 and 0.75, deviations of 0.5 to 1.9 dB; noise of made dead sensors is white, 0.15 dB."""


def line_strength(values: FloatArray, rate_hz: float) -> float:
    """Power of the highest line of the spectrum or of the envelope, away from the mains, over the highest that noise
    alone has: below 1 nothing stands out."""
    series = Series(samples=values, sampling_rate_hz=rate_hz, unit="", name="")
    excess, step_hz = line_excess(series)
    square, rate, _ = squared_envelope(whitened(values), BAND[0] * rate_hz, BAND[1] * rate_hz, rate_hz)
    centred = (square - np.mean(square)) * np.hanning(square.size)
    power = np.abs(fft.rfft(centred)) ** 2
    own_hz = rate / square.size
    envelope = power_over_floor(power)[: int(ENVELOPE_SHARE * rate_hz / own_hz)]
    return max(_highest(excess, step_hz), _highest(envelope, own_hz))


def _highest(excess: FloatArray, step_hz: float) -> float:
    part = slice(LOWEST_BIN, max(LOWEST_BIN, excess.size - HIGHEST_BINS))
    inside = excess[part][~mains_bins(excess.size, step_hz)[part]]
    return float(np.max(inside)) / (SPREAD * float(np.log(inside.size / CHANCE))) if inside.size else 0.0


def with_unheard(gate: Gate) -> Gate:
    """The gate with `noise` for each channel of a test that holds no line where the same channel of a baseline does;
    not usable where that is so of all of them.

    Asked of what the sensor gave, without the gate's undoing of a loose sensor's transfer, which makes lines of noise
    that has another shape; of noise alone no loudness of its bands is told.
    """
    if not gate.usable or not gate.baselines:
        return gate
    undone = [f for f in gate.findings if f.kind in HEARD and f.fault]
    tests = [transferred(one, undone, 1) for one in gate.tests]
    found: list[Finding] = []
    silent = []
    stuck = {f.channel for f in gate.findings if f.kind == "stuck" and f.fault}  # what it gives is told already
    for i, test in enumerate(tests, 1):
        moving = [name for name in test.names if name not in stuck]
        names = [name for name in moving if _lost(test, gate.baselines, name)]
        silent.append(len(names) == len(moving))
        found += [_finding(f"test {i}", name) for name in names]
    if not found:
        return gate
    deaf = {f.channel for f in found}
    shown = (*(f for f in gate.findings if f.kind not in HEARD or f.channel not in deaf), *found)
    return replace(gate, findings=shown, fault=worst(shown), usable=not all(silent))


def deaf_limits(tests: Sequence[Recording], labels: Sequence[str]) -> list[str]:
    """What is to be known of channels that hold no line beside others that do, where no baseline says what there is to
    hear."""
    told = []
    for test, label in zip(tests, labels, strict=True):
        names = [c.name for c in test.channels if c.quantity != "force"]
        deaf = [name for name in names if _deaf(test, name) and not _shares_noise(test, name)]
        told += [
            f"no line stands out of noise on {name} of {label}: its sensor may not have heard the machine"
            for name in (deaf if len(deaf) < len(names) else ())
        ]
    return told


def with_lost(gate: Gate, lost: frozenset[str]) -> frozenset[str]:
    """Labels of the tests that are `lost`, with those of which every channel is noise, where others are left."""
    seen = {(f.recording, f.channel) for f in gate.findings if f.kind == "noise"}
    labels = [(f"test {i}", one.names) for i, one in enumerate(gate.tests, 1)]
    every = lost | {label for label, names in labels if all((label, name) in seen for name in names)}
    return every if any(label not in every for label, _ in labels) else lost


def _lost(test: Recording, baselines: Sequence[Recording], name: str) -> bool:
    if not _deaf(test, name):
        return False
    size = test.samples.shape[1]
    heard = [line_strength(_row(b, name)[:size], _rate(b)) for b in baselines if name in b.names]
    return bool(heard) and min(heard) >= SURELY and not _heard_with_another(test, baselines, name)


def _deaf(test: Recording, name: str) -> bool:
    """Whether the channel holds no line, in a record that is long enough to say so."""
    long = test.samples.shape[1] >= LEAST_SAMPLES and test.duration_s >= LEAST_S
    return long and line_strength(_row(test, name), _rate(test)) < 1.0


def _heard_with_another(test: Recording, baselines: Sequence[Recording], name: str) -> bool:
    """Whether the channel has the shape of a baseline's spectrum still and shares its noise with one that holds a line:
    what knocks without a rhythm (a loose ring) is noise, and both heard it. Of cross-talk, hum and other interference
    that a dead sensor shares with a sound one it has not the shape."""
    alike = any(same_shape(_row(test, name), _row(b, name)) for b in baselines if name in b.names)
    return alike and _shares_noise(test, name)


def _shares_noise(test: Recording, name: str) -> bool:
    """Whether noise of the channel is that of another, which holds a line."""
    return any(
        common_bins(_row(test, name), _row(test, other)) >= COMMON_BINS
        and line_strength(_row(test, other), _rate(test)) >= 1.0
        for other in test.names
        if other != name
    )


def same_shape(one: FloatArray, other: FloatArray) -> bool:
    """Whether two spectra without their lines are coloured, and coloured alike."""
    a, b = (_shape(values) for values in (one, other))
    if min(float(np.std(a)), float(np.std(b))) < COLOURED_DB:
        return False
    return float(np.corrcoef(a, b)[0, 1]) >= ALIKE


def _shape(values: FloatArray) -> FloatArray:
    _, power = scipy.signal.welch(values, nperseg=COMMON_SEGMENT)
    level = 10.0 * np.log10(np.maximum(power, 1e-300))
    return np.asarray(scipy.ndimage.median_filter(level, SMOOTH, mode="nearest")[SHAPE_BINS])


def common_bins(one: FloatArray, other: FloatArray) -> int:
    """Bins of the spectrum, of 1 / `COMMON_SEGMENT` of the sampling rate each, in which half of the power of one
    channel is that of another."""
    with np.errstate(invalid="ignore", divide="ignore"):  # a channel that holds one value
        _, shared = scipy.signal.coherence(one, other, nperseg=COMMON_SEGMENT)
    return int(np.sum(shared[LOWEST_BIN:-LOWEST_BIN] >= COMMON_SHARE))


def _row(one: Recording, name: str) -> FloatArray:
    return one.series(name).samples


def _rate(one: Recording) -> float:
    return one.sampling_rate_hz


def _finding(label: str, name: str) -> Finding:
    return Finding(
        kind="noise",
        channel=name,
        recording=label,
        detail="nothing stands out of noise, no line of the spectrum nor of the envelope, and in the baseline lines "
        "do: the sensor did not hear the machine",
        severity=1.0,
        fault=True,
    )
