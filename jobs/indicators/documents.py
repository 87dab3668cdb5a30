"""Each kind of indicator as a document: numbers, lists and texts, every quantity with its unit."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Literal

import numpy as np

from jobs.documents import FloatArray
from jobs.indicators.bounds import usual_alpha_hz
from jobs.indicators.subject import Rotation, Subject, without_tacho
from jobs.thinning import highest, min_max
from signals.cepstrum import cepstrum
from signals.cyclic import EnhancedEnvelope, cyclic_coherence, enhanced_envelope
from signals.gear import gear_indicators
from signals.kurtogram import kurtogram
from signals.synchronous import SynchronousAverage, synchronous_average
from sim.core.errors import Problem, SpecError, UnknownName

IndicatorKind = Literal["gear", "average", "cepstrum", "kurtogram", "cyclic"]
Document = dict[str, object]
MAX_POINTS = 4000
"""Points listed of a curve; of longer ones the extremes of each stretch stay."""
CEPSTRUM_SEGMENT_S = 2.0
MAX_EARLIER = 16
MULTIPLES = (1, 2, 3)


@dataclass(frozen=True, kw_only=True)
class _Asked:
    shaft: str | None
    earlier: Sequence[Subject]
    max_alpha_hz: float | None


def indicators(
    kind: str,
    subject: Subject,
    *,
    shaft: str | None = None,
    rotation: Rotation = "known",
    earlier: Sequence[Subject] = (),
    max_alpha_hz: float | None = None,
) -> Document:
    """The document of one kind. `shaft`: by base or name (default: each with a gear); `earlier`: former runs for NA4.

    `rotation` tacholess takes the angle from the vibration, of the shaft asked for or the first one with a gear.
    """
    if kind not in KINDS:
        raise UnknownName("indicator", kind, KINDS)
    if len(earlier) > MAX_EARLIER:
        problem = Problem(field="earlier", message="names too many runs", given=len(earlier), allowed=f"{MAX_EARLIER}")
        raise SpecError(problem)
    if rotation == "tacholess" and kind in ANGULAR:
        base = subject.shaft(shaft)
        subject, earlier = without_tacho(subject, base), [without_tacho(e, e.shaft(shaft)) for e in earlier]
    series = subject.series
    head: Document = {
        "kind": kind,
        "channel": series.name,
        "unit": series.unit,
        "start_s": series.start_s,
        "duration_s": series.duration_s,
    }
    if kind in ANGULAR:
        head["rotation"] = subject.rotation_basis
    asked = _Asked(shaft=shaft, earlier=earlier, max_alpha_hz=max_alpha_hz)
    return {**head, **_MAKERS[kind](subject, asked)}


def _mean_turn(subject: Subject, base: str) -> SynchronousAverage:
    ratio = subject.shafts[base].ratio
    return synchronous_average(subject.series, shaft=base, rotation=subject.rotation, ratio=ratio)


def _gear(subject: Subject, asked: _Asked) -> Document:
    geared = [base for base, info in subject.shafts.items() if info.teeth]
    bases = [subject.shaft(asked.shaft)] if asked.shaft is not None or not geared else geared
    found = []
    for base in bases:
        teeth = subject.shafts[base].teeth
        if not teeth:
            message = f"has no gear ({base}): give the teeth"
            raise SpecError(Problem(field="teeth", message=message, given=list(teeth), allowed="a number of teeth"))
        before = [_mean_turn(run, base) for run in asked.earlier]
        result = gear_indicators(_mean_turn(subject, base), teeth=teeth, earlier=before)
        found.append({**asdict(result), "component": subject.shafts[base].component})
    return {"shafts": found}


def _average(subject: Subject, asked: _Asked) -> Document:
    base = subject.shaft(asked.shaft)
    mean = _mean_turn(subject, base)
    angle, samples = _curve(np.linspace(0.0, 360.0, mean.samples.size, endpoint=False), mean.samples, both=True)
    return {
        "shaft": base,
        "component": subject.shafts[base].component,
        "revolutions": mean.revolutions,
        "mean_speed_hz": mean.mean_speed_hz,
        "samples_per_revolution": mean.samples_per_revolution,
        "rms": float(np.sqrt(np.mean(mean.samples**2))),
        "scatter_rms": mean.scatter_rms,
        "noise_rms": mean.noise_rms,
        "angle_deg": angle,
        "values": samples,
    }


def _cepstrum(subject: Subject, _asked: _Asked) -> Document:
    series = subject.series
    segment_s = CEPSTRUM_SEGMENT_S if series.duration_s > 2 * CEPSTRUM_SEGMENT_S else None
    found = cepstrum(series, kind="real", segment_s=segment_s)
    quefrency, values = _curve(found.quefrency_s[1:], found.values[1:])
    lines = []
    for base, hz in subject.bases_hz.items():
        if 0 < hz <= series.sampling_rate_hz / 4 and 1 / hz < found.quefrency_s[-1]:
            place = round(1 / hz / found.resolution_s)
            near = found.values[place - 1 : place + 2]
            around = found.values[max(1, place - 50) : place + 51]
            spread = float(np.median(np.abs(around - np.median(around)))) * 1.4826
            lines.append(
                {
                    "base": base,
                    "frequency_hz": hz,
                    "quefrency_s": 1 / hz,
                    "value": float(np.max(near)),
                    "over_scatter": float(np.max(near)) / spread if spread > 0 else None,
                }
            )
    return {
        "cepstrum": "real",
        "value_unit": "neper",
        "window": found.window,
        "averages": found.averages,
        "rahmonics": lines,
        "quefrency_s": quefrency,
        "values": values,
    }


def _kurtogram(subject: Subject, _asked: _Asked) -> Document:
    found = kurtogram(subject.series)
    levels: dict[int, Document] = {}
    for cell in found.cells:
        level = levels.setdefault(
            cell.parts,
            {
                "bands": cell.parts,
                "bandwidth_hz": cell.high_hz - cell.low_hz,
                "threshold": cell.threshold,
                "kurtosis": [],
            },
        )
        values = level["kurtosis"]
        assert isinstance(values, list)
        values.append(cell.kurtosis)
    return {"band": {**asdict(found.band), "impulsive": found.band.impulsive}, "levels": list(levels.values())}


def _cyclic(subject: Subject, asked: _Asked) -> Document:
    series = subject.series
    usual = usual_alpha_hz(subject.bases_hz, series.sampling_rate_hz)
    most = asked.max_alpha_hz if asked.max_alpha_hz is not None else usual
    found = enhanced_envelope(cyclic_coherence(series, max_alpha_hz=most))
    alpha, values = _curve(found.alpha_hz, found.values)
    return {
        "resolution_hz": found.resolution_hz,
        "band_hz": [found.low_hz, found.high_hz],
        "expected": found.expected,
        "threshold": found.threshold,
        "lines": _cyclic_lines(found, subject.bases_hz),
        "peaks": [{"alpha_hz": hz, "value": value} for hz, value in found.peaks()],
        "alpha_hz": alpha,
        "values": values,
    }


def _cyclic_lines(found: EnhancedEnvelope, bases_hz: Mapping[str, float]) -> list[Document]:
    """The first multiples of every base within the axis: the largest value within one step."""
    lines: list[Document] = []
    for base, hz in bases_hz.items():
        for k in MULTIPLES:
            near = np.flatnonzero(np.abs(found.alpha_hz - k * hz) <= found.resolution_hz)
            if hz > 0 and near.size:
                value = float(np.max(found.values[near]))
                lines.append(
                    {"label": f"{k}*{base}", "alpha_hz": k * hz, "value": value, "above": value > found.threshold}
                )
    return lines


def _curve(x: FloatArray, y: FloatArray, *, both: bool = False) -> tuple[list[float], list[float]]:
    if x.size > MAX_POINTS:
        x, y = (min_max if both else highest)(x, y, MAX_POINTS)
    return x.tolist(), y.tolist()


_MAKERS: Mapping[str, Callable[[Subject, _Asked], Document]] = {
    "gear": _gear,
    "average": _average,
    "cepstrum": _cepstrum,
    "kurtogram": _kurtogram,
    "cyclic": _cyclic,
}
KINDS = tuple(_MAKERS)
ANGULAR = ("gear", "average")
"""Kinds that need the angle of a shaft."""
