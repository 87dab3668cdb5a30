"""Condition indicators of a gear from its mean turn.

FM0, FM4: R. M. Stewart, "Some useful data analysis techniques for gearbox diagnostics", Proc. Meeting on the
Applications of Time Series Analysis, ISVR, Southampton, 1977. M6A, M8A: H. R. Martin, "Statistical moment analysis as a
means of surface damage detection", Proc. 7th International Modal Analysis Conference, 1989, 1016-1021. NA4: see
`signals.gear.runs`. All as collected in Lebold et al. (2000), see `signals.synchronous.separate`. All are
dimensionless and do not change with the scale of the signal or the angle at which the turn begins.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import fft

from signals.gear.runs import quasi_kurtosis
from signals.series import FloatArray
from signals.synchronous.average import SynchronousAverage
from signals.synchronous.separate import GearSignals, separate
from sim.core.errors import Problem, SpecError

SILENT = 1e-9
"""A difference or residual below this share of the mean turn is rounding: it has no shape to speak of."""


@dataclass(frozen=True, kw_only=True)
class PartIndicators:
    """Size (unit of the signal) and shape of a part of the mean turn; None where nothing but rounding is left."""

    rms: float
    peak_to_peak: float
    crest_factor: float | None
    kurtosis: float | None


@dataclass(frozen=True, kw_only=True)
class GearIndicators:
    """Indicators of the gears on one shaft. A Gaussian difference signal has FM4 3, M6A 15, M8A 105.

    `runs` is the number of runs NA4 and NB4 average over, this one included; with one run NA4 is the kurtosis of the
    residual. `noise_share` is the noise left by averaging over the RMS of the difference signal: near 1 the indicators
    are those of the noise, and more turns are needed. None stands for what is rounding only.
    """

    unit: str
    shaft: str
    teeth: tuple[int, ...]
    revolutions: int
    runs: int
    fm0: float | None
    fm4: float | None
    m6a: float | None
    m8a: float | None
    na4: float | None
    nb4: float | None
    noise_share: float | None
    average: PartIndicators
    residual: PartIndicators
    difference: PartIndicators
    channel: str = ""


def gear_indicators(
    average: SynchronousAverage,
    *,
    teeth: Sequence[int],
    earlier: Sequence[SynchronousAverage] = (),
    shaft_orders: int = 2,
    sidebands: int = 1,
) -> GearIndicators:
    """All indicators of a mean turn. `earlier`: mean turns of former runs, same shaft, sensor and operating point."""
    now, *before = [
        separate(turn, teeth=teeth, shaft_orders=shaft_orders, sidebands=sidebands) for turn in (average, *earlier)
    ]
    for i, turn in enumerate(earlier):
        if turn.unit != average.unit:
            message = "is in another unit than this run"
            problem = Problem(field=f"earlier[{i}].unit", message=message, given=turn.unit, allowed=average.unit)
            raise SpecError(problem)
    quiet = SILENT * float(np.sqrt(np.mean(average.samples**2)))
    shaped = _rms(now.difference) > quiet
    left = _rms(now.residual) > quiet
    envelope = mesh_envelope(now)
    return GearIndicators(
        unit=average.unit,
        shaft=average.shaft,
        teeth=now.teeth,
        revolutions=average.revolutions,
        runs=1 + len(before),
        fm0=fm0(now),
        fm4=normalised_moment(now.difference, 4) if shaped else None,
        m6a=normalised_moment(now.difference, 6) if shaped else None,
        m8a=normalised_moment(now.difference, 8) if shaped else None,
        na4=quasi_kurtosis(now.residual, [b.residual for b in before]) if left else None,
        nb4=quasi_kurtosis(envelope, [mesh_envelope(b) for b in before]) if _rms(envelope) > quiet else None,
        noise_share=average.noise_rms / _rms(now.difference) if shaped else None,
        average=_part(average.samples, quiet),
        residual=_part(now.residual, quiet),
        difference=_part(now.difference, quiet),
        channel=average.channel,
    )


def fm0(signals: GearSignals) -> float | None:
    """Peak to peak of the mean turn over the sum of the amplitudes of all mesh harmonics (Stewart 1977).

    Rises when a tooth's impact adds to the peak while the mesh does not change, or when the mesh harmonics give way.
    """
    x = signals.average.samples
    spectrum = np.abs(fft.rfft(x)) * (2 / x.size)
    orders = sorted({k for z in signals.teeth for k in range(z, (x.size + 1) // 2, z)})
    total = float(np.sum(spectrum[orders]))
    return float(np.ptp(x)) / total if total > SILENT * _rms(x) else None


def normalised_moment(signal: FloatArray, power: int) -> float | None:
    """Central moment over that power of the standard deviation: 4 FM4, 6 M6A, 8 M8A of the difference signal."""
    centred = signal - np.mean(signal)
    deviation = _rms(centred)
    return float(np.mean((centred / deviation) ** power)) if deviation > 0 else None


def mesh_envelope(signals: GearSignals) -> FloatArray:
    """Envelope of the mean turn in the band around the strongest of the first two mesh harmonics, (m,), for NB4.

    The band reaches half a tooth order to each side, so it holds as many sidebands as fit between two harmonics;
    a part of an order at its edges is not shared out.
    """
    x = signals.average.samples
    transform = fft.rfft(x)
    candidates = [(k * z, z) for z in signals.teeth for k in (1, 2) if k * z + z // 2 < transform.size - 1]
    if not candidates:
        candidates = [(min(signals.teeth), min(signals.teeth))]
    centre, z = max(candidates, key=lambda c: abs(transform[c[0]]))
    analytic = np.zeros(x.size, dtype=np.complex128)
    reach = (z - 1) // 2
    low, high = max(1, centre - reach), min(centre + reach, (x.size - 1) // 2)
    analytic[low : high + 1] = 2 * transform[low : high + 1]
    return np.asarray(np.abs(fft.ifft(analytic)), dtype=np.float64)


def _rms(x: FloatArray) -> float:
    return float(np.sqrt(np.mean((x - np.mean(x)) ** 2)))


def _part(x: FloatArray, quiet: float) -> PartIndicators:
    deviation = _rms(x)
    moving = deviation > quiet
    return PartIndicators(
        rms=deviation,
        peak_to_peak=float(np.ptp(x)),
        crest_factor=float(np.max(np.abs(x - np.mean(x)))) / deviation if moving else None,
        kurtosis=normalised_moment(x, 4) if moving else None,
    )
