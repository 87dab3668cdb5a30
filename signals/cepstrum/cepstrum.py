"""Cepstrum: the spectrum of the log spectrum. A family of lines f apart gathers at the quefrency 1/f and its multiples.

B. P. Bogert, M. J. R. Healy and J. W. Tukey, "The quefrency alanysis of time series for echoes", Proc. Symp. Time
Series Analysis (ed. M. Rosenblatt), Wiley, 1963, 209-243; R. B. Randall, "A history of cepstrum analysis and its
application to mechanical problems", Mech. Syst. Signal Process. 97 (2017) 3-19.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy import fft

from signals.series import FloatArray, Series
from signals.spectra.segments import hop_length, segment_length, segments
from signals.windows import window
from sim.core.errors import Problem, SpecError

CepstrumKind = Literal["real", "power"]
FLOOR = 1e-10
"""Amplitudes below this share of the largest (-200 dB) count as that: the logarithm of rounding is no information."""


@dataclass(frozen=True, kw_only=True)
class Cepstrum:
    """`values` (quefrencies,), nepers, over `quefrency_s` (quefrencies,), from 0 to half a segment.

    `real`: inverse transform of ln|X|; `power`: of ln|X|^2, twice that. An echo of relative size a after t reads a/2 at
    quefrency t in the real and a in the power cepstrum.
    """

    kind: CepstrumKind
    quefrency_s: FloatArray
    values: FloatArray
    window: str
    averages: int
    channel: str = ""

    @property
    def resolution_s(self) -> float:
        """Spacing of the quefrencies: one sample, s."""
        return float(self.quefrency_s[1])


def cepstrum(
    series: Series,
    *,
    kind: CepstrumKind = "real",
    segment_s: float | None = None,
    window_name: str = "hann",
    overlap: float = 0.5,
) -> Cepstrum:
    """Cepstrum of the series, or with `segment_s` the mean over segments of that length (memory is that of one).

    The mean of the series is taken out. The log spectra of segments are averaged, so that a line present in all of them
    counts and noise averages out; a segment should hold many periods of the quefrencies looked for.
    """
    length = series.samples.size if segment_s is None else _length(series, segment_s)
    win = window(window_name, length)
    frames = segments(series.samples, length, hop_length(length, overlap))
    mean = float(np.mean(series.samples))
    total = np.zeros(length // 2 + 1)
    for frame in frames:
        total += log_amplitude(np.abs(fft.rfft((frame - mean) * win.values)))
    values = fft.irfft(total / frames.shape[0], n=length)[: length // 2 + 1]
    return Cepstrum(
        kind=kind,
        quefrency_s=np.arange(length // 2 + 1, dtype=np.float64) / series.sampling_rate_hz,
        values=np.asarray(values * (2.0 if kind == "power" else 1.0), dtype=np.float64),
        window=window_name,
        averages=int(frames.shape[0]),
        channel=series.name,
    )


def log_amplitude(amplitude: FloatArray) -> FloatArray:
    """Natural logarithm, held at `FLOOR` of the largest amplitude; same shape.

    The first bin, where the mean was taken out, gets the level of the second: a hole there would lower all quefrencies.
    """
    largest = float(np.max(amplitude))
    found = np.log(np.maximum(amplitude, FLOOR * largest if largest > 0 else 1.0))
    found[0] = found[1]
    return np.asarray(found, dtype=np.float64)


def rahmonic(result: Cepstrum, frequency_hz: float, multiple: int = 1, reach: int = 2) -> float:
    """Largest value within `reach` samples of the quefrency of `multiple` periods of lines `frequency_hz` apart."""
    quefrency_s = multiple / frequency_hz if frequency_hz > 0 else np.inf
    place = quefrency_s / result.resolution_s
    if not place <= result.values.size - 1 or place < 1:
        raise SpecError(
            Problem(
                field="frequency_hz",
                message="has its quefrency outside the cepstrum",
                given=frequency_hz,
                allowed=f"{multiple / result.quefrency_s[-1]:.4g} to {multiple / result.resolution_s:.4g}",
                unit="Hz",
            )
        )
    low, high = max(1, round(place) - reach), min(result.values.size, round(place) + reach + 1)
    return float(np.max(result.values[low:high]))


def _length(series: Series, segment_s: float) -> int:
    if not (np.isfinite(segment_s) and segment_s > 0):
        problem = Problem(field="segment_s", message="must be positive", given=segment_s, allowed="above 0", unit="s")
        raise SpecError(problem)
    return segment_length(series, 1 / segment_s)
