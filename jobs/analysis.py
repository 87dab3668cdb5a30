"""Features, spectra and labelled peaks of a response: `jobs.ports.Analyser` on `signals`.

The first acceleration, of a machine without one the first angular acceleration, is labelled here; other channels are
labelled when they are asked for (`jobs.labelling`).
"""

from __future__ import annotations

from dataclasses import asdict, replace

import numpy as np

from jobs.documents import ResultDocuments, SpectrumDocument
from jobs.labelling import LABELLED, MIN_SAMPLES, REFERENCE, Predicted, label_channel, moves, no_labels
from jobs.stretch import at_stretch, turned_angle_rad
from signals.export import features_document
from signals.features import features
from signals.recording import Recording, from_response
from signals.series import FloatArray, Series
from signals.spectra.amplitude import amplitude_spectrum, power_spectral_density
from signals.spectra.envelope import envelope_spectrum
from signals.spectra.order import order_spectrum
from signals.spectra.types import OrderSpectrum, Spectrum
from sim.core.errors import SpecError
from sim.core.response import Channel, Response
from sim.core.spec import ForceLoad, MachineSpec, TorqueLoad
from sim.core.speed import mean_ratio, warped_times

MIN_REVOLUTIONS = 2.0
SLOWEST = 0.05
"""Share of the nominal speed below which a changing speed has no order spectrum: its step in angle would be endless."""
VIBRATION = (*LABELLED, "velocity", "displacement", "angular_velocity", "angular_displacement")
PSD_SEGMENTS = 8


def analyse(response: Response, *, discard_transient: bool) -> ResultDocuments:
    """Everything that is kept beside the signals. Channels that are no vibration get features only."""
    start_s, notes = analysed_from(response, discard_transient)
    response = at_stretch(response, start_s)
    recording = from_response(response).select(start_s=start_s)
    gaps = [c.name for c in recording.channels if not _finite(recording, c)]
    if gaps:
        notes = [*notes, f"not analysed, as samples are missing: {', '.join(gaps)}"]
    moving = [c for c in recording.channels if c.quantity in VIBRATION and _finite(recording, c)]
    spectra: list[SpectrumDocument] = []
    for channel in moving:
        spectra += [_document(s) for s in channel_spectra(recording.series(channel.name), channel, response)]
    notes = [*notes, *_open_contacts(response)]
    peaks = _labels(response, recording)
    if response.quality.doubts:
        peaks = {**peaks, "doubts": [*response.quality.doubts]}
    if "reason" in peaks:
        notes = [*notes, f"no labels: {peaks['reason']}"]
    return ResultDocuments(summary=_summary(response, recording, start_s, notes), peaks=peaks, spectra=tuple(spectra))


def _labels(response: Response, recording: Recording) -> dict[str, object]:
    """Labels of the first channel of the best quantity there is."""
    ranked = [c for quantity in LABELLED for c in recording.channels if c.quantity == quantity]
    whole = [c for c in ranked if _finite(recording, c)]
    if ranked and not whole:
        return no_labels(response.bases_hz, "samples are missing in every channel that could be labelled")
    if not ranked:
        return no_labels(response.bases_hz, "no acceleration was recorded; ask for one, or for `all` channels")
    step_s = response.quality.step_s
    known = Predicted(machine=response.machine, seed=response.seed, bases_hz=response.bases_hz, step_s=step_s)
    return label_channel(recording.series(whole[0].name), known)


def _open_contacts(response: Response) -> list[str]:
    """A sentence for each contact that stayed open: what it was put in for did not happen."""
    advice = "a smaller gap, more load or more vibration would close it"
    return [f"{name} was never in contact: {advice}" for name, share in response.contact_share.items() if share == 0]


def _finite(recording: Recording, channel: Channel) -> bool:
    """Whether every sample is a number: a recorder may mark what it lost."""
    return bool(np.isfinite(recording.samples[recording.names.index(channel.name)]).all())


def analysed_from(response: Response, discard: bool) -> tuple[float, list[str]]:
    """Where the analysis begins, s, and notes. A record that is nearly all transient is analysed whole, and says so."""
    if not discard or rings_down(response.machine):
        return 0.0, []
    samples = response.signals.shape[1]
    first = int(response.quality.transient_end_s * response.sampling_rate_hz)
    if samples - first >= max(MIN_SAMPLES, samples // 4):
        return first / response.sampling_rate_hz, []
    return 0.0, ["the start-up transient takes most of the record; it is analysed whole: simulate longer"]


def rings_down(machine: MachineSpec) -> bool:
    """Whether nothing keeps a machine moving: its loads step on at t = 0, and what follows is all there is to see."""
    pushed = any(
        not isinstance(x, TorqueLoad) and not (isinstance(x, ForceLoad) and x.amplitude_n == 0.0) for x in machine.loads
    )
    return machine.operating is None and not pushed


def _rotation(series: Series, response: Response) -> float | FloatArray | None:
    """Speed of the first shaft, or its angle where the speed changes; None where it nearly stands or is too short."""
    speed = response.bases_hz.get(REFERENCE, 0.0)
    duration_s = series.samples.size / series.sampling_rate_hz
    if speed * duration_s < MIN_REVOLUTIONS:
        return None
    if response.speed[0] == 0:
        return speed
    slowest = float(np.min(warped_times(response.speed, series.start_s + np.linspace(0.0, duration_s, 1001))[1]))
    if slowest < SLOWEST:
        return None
    nominal = speed / mean_ratio(response.speed, series.start_s, series.start_s + duration_s)
    return turned_angle_rad(series, response.speed, nominal)


def channel_spectra(series: Series, channel: Channel, response: Response) -> list[Spectrum | OrderSpectrum]:
    """The spectra kept of one channel."""
    duration_s = series.samples.size / series.sampling_rate_hz
    found: list[Spectrum | OrderSpectrum] = [
        amplitude_spectrum(series),
        power_spectral_density(series, resolution_hz=PSD_SEGMENTS / duration_s),
    ]
    if channel.quantity in LABELLED and moves(series):
        found.append(envelope_spectrum(series))
    rotation = _rotation(series, response)
    if rotation is not None:
        found.append(order_spectrum(series, shaft=REFERENCE, rotation=rotation))
    return found


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
        "rings_down": rings_down(response.machine),
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
