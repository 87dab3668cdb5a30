"""JSON-ready documents of results: plain numbers, lists and texts, every quantity with its unit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict

from signals.features import Features, LineAmplitude
from signals.labels.types import LabelledPeak, LabelSet
from signals.series import FloatArray
from signals.spectra.types import Band, OrderSpectrum, Spectrogram, Spectrum

Document = dict[str, object]


def labels_document(labels: LabelSet) -> Document:
    """`frequencies` (Hz), `peaks`, and the settings that decided about them."""
    return {
        "frequencies": {base: float(hz) for base, hz in labels.frequencies_hz.items()},
        "reference": labels.reference,
        "channel": labels.channel,
        "spectrum": {
            "kind": labels.kind,
            "unit": labels.unit,
            "scaling": labels.scaling,
            "window": labels.window,
            "resolution_hz": labels.resolution_hz,
            "band": _band(labels.band),
        },
        "bound": asdict(labels.bound),
        "matching": asdict(labels.matching),
        "floor": asdict(labels.floor),
        "found": labels.found,
        "unexplained": labels.unexplained,
        "truncated": labels.truncated,
        "false_match": asdict(labels.false_match),
        "peaks": [_peak(p) for p in labels.peaks],
    }


def spectrum_document(spectrum: Spectrum | OrderSpectrum) -> Document:
    """A spectrum with its axis, values and everything needed to read them."""
    facts = {k: v for k, v in vars(spectrum).items() if isinstance(v, str | int | float)}
    if isinstance(spectrum, OrderSpectrum):
        return {**facts, "kind": "order", "order": _list(spectrum.order), "values": _list(spectrum.values)}
    axis, values = _list(spectrum.frequency_hz), _list(spectrum.values)
    return {**facts, "band": _band(spectrum.band), "frequency_hz": axis, "values": values}


def spectrogram_document(result: Spectrogram) -> Document:
    """A spectrogram; `values` is a list of frequency rows over time."""
    facts = {k: v for k, v in vars(result).items() if isinstance(v, str | int | float)}
    rows = [_list(row) for row in result.values]
    return {**facts, "time_s": _list(result.time_s), "frequency_hz": _list(result.frequency_hz), "values": rows}


def features_document(features: Features, lines: Sequence[LineAmplitude] = ()) -> Document:
    """Features and line amplitudes."""
    return {**asdict(features), "lines": [asdict(line) for line in lines]}


def _peak(peak: LabelledPeak) -> Document:
    return {k: list(v) if isinstance(v, tuple) else v for k, v in vars(peak).items()}


def _band(band: Band | None) -> Document | None:
    return None if band is None else {**asdict(band), "impulsive": band.impulsive}


def _list(values: FloatArray) -> list[float]:
    return [float(v) for v in values]
