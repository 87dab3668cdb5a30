"""Sines taken out of a recording: fitted in blocks, within which a source's phase is taken as steady."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from signals.recording import Recording
from signals.series import FloatArray

BLOCK_S = 1.0


def without_sines(
    recording: Recording, lines_hz: Mapping[str, Sequence[float]], *, block_s: float = BLOCK_S
) -> Recording:
    """The recording with sines at each channel's lines (frequency refined on the data) fitted and subtracted."""
    samples = recording.samples.copy()
    time = np.arange(samples.shape[1]) / recording.sampling_rate_hz
    blocks = max(1, int(recording.duration_s / block_s))
    for row, name in enumerate(recording.names):
        for hz in lines_hz.get(name, ()):
            fine = _refined(samples[row], time, hz, 1 / recording.duration_s)
            carrier = np.exp(-2j * np.pi * fine * time)
            for part in np.array_split(np.arange(time.size), blocks):
                line = 2 * np.mean((samples[row][part] - np.mean(samples[row][part])) * carrier[part])
                samples[row][part] -= np.real(line * np.conj(carrier[part]))
    return replace(recording, samples=samples)


def _refined(samples: FloatArray, time: FloatArray, hz: float, width_hz: float) -> float:
    """Frequency within half a bin that holds most, Hz."""
    trial = hz + width_hz * np.linspace(-0.6, 0.6, 13)
    turned = np.hanning(time.size) * samples * np.exp(-2j * np.pi * trial[0] * time)
    step = np.exp(-2j * np.pi * (trial[1] - trial[0]) * time)
    level = [abs(np.sum(turned))]
    for _ in trial[1:]:
        turned *= step
        level.append(abs(np.sum(turned)))
    return float(trial[int(np.argmax(level))])
