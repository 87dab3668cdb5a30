"""Features, spectra and labelled peaks of a response: `jobs.ports.Analyser` on `signals`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, replace

from jobs.documents import ResultDocuments, SpectrumDocument
from signals.export import features_document, labels_document
from signals.features import features
from signals.labels.families import kinematic_lines
from signals.labels.machine import machine_kinematics
from signals.labels.match import label_peaks
from signals.recording import Recording, from_response
from signals.series import Series
from signals.spectra.amplitude import amplitude_spectrum, power_spectral_density
from signals.spectra.envelope import envelope_spectrum
from signals.spectra.order import order_spectrum
from signals.spectra.types import OrderSpectrum, Spectrum
from sim.assembly.assemble import assemble
from sim.core.errors import SpecError
from sim.core.response import Channel, Response

MIN_SAMPLES = 256
MIN_REVOLUTIONS = 2.0
VIBRATION = ("acceleration", "velocity", "displacement")
MAX_LABELLED = 8
PSD_SEGMENTS = 8
REFERENCE = "f_r1"


def analyse(response: Response, *, discard_transient: bool) -> ResultDocuments:
    """Everything that is kept beside the signals. Channels that are no vibration get features only."""
    start_s, notes = _start(response, discard_transient)
    recording = from_response(response).select(start_s=start_s)
    moving = [c for c in recording.channels if c.quantity in VIBRATION]
    spectra: list[SpectrumDocument] = []
    labels: dict[str, dict[str, object]] = {}
    for channel in moving:
        series = recording.series(channel.name)
        found = _spectra(series, channel, response)
        spectra += [document for document, _ in found]
        if channel.quantity == "acceleration" and len(labels) < MAX_LABELLED and REFERENCE in response.bases_hz:
            labels[channel.name] = _labels(response, [spectrum for _, spectrum in found])
    return ResultDocuments(
        summary=_summary(response, recording, start_s, notes), peaks=_peaks(response, labels), spectra=tuple(spectra)
    )


def _start(response: Response, discard: bool) -> tuple[float, list[str]]:
    """Where the analysis begins. A record that is nearly all transient is analysed whole, and says so."""
    if not discard:
        return 0.0, []
    samples = response.signals.shape[1]
    first = int(response.quality.transient_end_s * response.sampling_rate_hz)
    if samples - first >= max(MIN_SAMPLES, samples // 4):
        return first / response.sampling_rate_hz, []
    return 0.0, ["the start-up transient takes most of the record; it is analysed whole: simulate longer"]


def _spectra(
    series: Series, channel: Channel, response: Response
) -> list[tuple[SpectrumDocument, Spectrum | OrderSpectrum]]:
    duration_s = series.samples.size / series.sampling_rate_hz
    found: list[Spectrum | OrderSpectrum] = [
        amplitude_spectrum(series),
        power_spectral_density(series, resolution_hz=PSD_SEGMENTS / duration_s),
    ]
    if channel.quantity == "acceleration" and series.samples.size >= MIN_SAMPLES and series.samples.std() > 0:
        found.append(envelope_spectrum(series))
    speed = response.bases_hz.get(REFERENCE, 0.0)
    if speed * duration_s >= MIN_REVOLUTIONS:
        found.append(order_spectrum(series, shaft=REFERENCE, rotation=speed))
    return [(_document(spectrum), spectrum) for spectrum in found]


def _document(spectrum: Spectrum | OrderSpectrum) -> SpectrumDocument:
    meta: dict[str, object] = {k: v for k, v in vars(spectrum).items() if isinstance(v, str | int | float)}
    if isinstance(spectrum, OrderSpectrum):
        return SpectrumDocument(
            channel=spectrum.channel,
            kind="order",
            axis=spectrum.order,
            axis_unit="order",
            values=spectrum.values,
            unit=spectrum.unit,
            meta=meta,
        )
    if spectrum.band is not None:
        meta["band"] = asdict(spectrum.band)
    kind = {"density": "psd", "envelope": "envelope"}.get(spectrum.kind, "amplitude")
    return SpectrumDocument(
        channel=spectrum.channel,
        kind=kind,  # type: ignore[arg-type]
        axis=spectrum.frequency_hz,
        axis_unit="Hz",
        values=spectrum.values,
        unit=spectrum.unit,
        meta=meta,
    )


def _labels(response: Response, spectra: Sequence[Spectrum | OrderSpectrum]) -> dict[str, object]:
    """Labels of a channel's amplitude spectrum, and of its envelope's under `envelope`."""
    kinematics = machine_kinematics(response.machine, response.bases_hz)
    lines = [
        *kinematic_lines(kinematics, response.bases_hz, max_frequency_hz=response.sampling_rate_hz / 2.56),
        *assemble(response.machine, seed=response.seed).lines,
    ]
    documents: dict[str, dict[str, object]] = {}
    for spectrum in spectra:
        if isinstance(spectrum, Spectrum) and spectrum.kind in ("amplitude", "envelope"):
            labelled = label_peaks(spectrum, lines, response.bases_hz, kinematics=kinematics, reference=REFERENCE)
            documents[spectrum.kind] = labels_document(labelled)
    return {**documents["amplitude"], "envelope": documents.get("envelope")}


def _peaks(response: Response, labels: dict[str, dict[str, object]]) -> dict[str, object]:
    """The first labelled channel at the top, all of them under `by_channel`."""
    if not labels:
        return {"frequencies": dict(response.bases_hz), "peaks": [], "by_channel": {}}
    return {**next(iter(labels.values())), "by_channel": labels}


def _summary(response: Response, recording: Recording, start_s: float, notes: list[str]) -> dict[str, object]:
    quality = response.quality
    energy = quality.energy
    return {
        "machine": response.machine.name,
        "frequencies": dict(response.bases_hz),
        "derived": dict(response.derived),
        "warnings": [*response.warnings, *notes],
        "contact_share": dict(response.contact_share),
        "analysed_from_s": start_s,
        "features": {c.name: _features(recording, c) for c in recording.channels},
        "quality": {
            **{k: v for k, v in vars(quality).items() if k != "energy"},
            "energy": {
                **asdict(replace(energy)),
                "relative_residual": energy.relative_residual,
                "acceptable": energy.acceptable,
            },
        },
    }


def _features(recording: Recording, channel: Channel) -> dict[str, object] | None:
    try:
        return features_document(features(recording.series(channel.name)))
    except SpecError:
        return None
