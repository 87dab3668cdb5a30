"""Labelled peaks of one channel, from a response or from a stored result."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from jobs.results import ResultReader
from jobs.stretch import unsteady
from signals.export import labels_document
from signals.labels.families import kinematic_lines
from signals.labels.machine import machine_kinematics
from signals.labels.match import MAX_UNEXPLAINED, label_peaks
from signals.labels.types import LabelSet
from signals.series import Series
from signals.spectra.amplitude import amplitude_spectrum
from signals.spectra.envelope import envelope_spectrum
from sim.assembly.assemble import assemble
from sim.core.spec import MachineSpec

REFERENCE = "f_r1"
LABELLED = ("acceleration", "angular_acceleration")
"""Quantities whose lines are labelled, the best first."""
MIN_SAMPLES = 256


@dataclass(frozen=True, kw_only=True)
class Predicted:
    """What the lines are predicted from."""

    machine: MachineSpec
    seed: int
    bases_hz: Mapping[str, float]
    step_s: float | None = None
    """Step of the simulation, if it is known."""


@dataclass(frozen=True, kw_only=True)
class ChannelLabels:
    """Labels of both spectra of a channel."""

    amplitude: LabelSet
    envelope: LabelSet


def moves(series: Series) -> bool:
    """Whether there is anything to look at."""
    return series.samples.size >= MIN_SAMPLES and float(series.samples.std()) > 0


def no_labels(bases_hz: Mapping[str, float], reason: str) -> dict[str, object]:
    """The document of a channel without labels; `reason` says why and what would help."""
    return {"frequencies": dict(bases_hz), "peaks": [], "envelope": None, "reason": reason}


def why_unlabelled(series: Series, known: Predicted) -> str:
    """Why a channel cannot be labelled; empty when it can."""
    if REFERENCE not in known.bases_hz:
        return "nothing turns in this machine, so there are no kinematic lines to look for"
    if series.samples.size < MIN_SAMPLES:
        return f"the analysed stretch has {series.samples.size} samples, labels need {MIN_SAMPLES}: simulate longer"
    if not moves(series):
        return f"{series.name} does not move"
    return unsteady(series, known.machine, known.seed)


def label_sets(series: Series, known: Predicted, max_unexplained: int = MAX_UNEXPLAINED) -> ChannelLabels | None:
    """Labels of the amplitude and of the envelope spectrum; None where there is nothing to label."""
    if why_unlabelled(series, known):
        return None
    kinematics = machine_kinematics(known.machine, known.bases_hz)
    lines = [
        *kinematic_lines(kinematics, known.bases_hz, max_frequency_hz=math.inf),
        *assemble(known.machine, seed=known.seed).lines,
    ]
    amplitude, envelope = (
        label_peaks(
            spectrum,
            lines,
            known.bases_hz,
            kinematics=kinematics,
            reference=REFERENCE,
            max_unexplained=max_unexplained,
            step_hz=1.0 / known.step_s if known.step_s else None,
        )
        for spectrum in (amplitude_spectrum(series), envelope_spectrum(series))
    )
    return ChannelLabels(amplitude=amplitude, envelope=envelope)


def label_channel(series: Series, known: Predicted, max_unexplained: int = MAX_UNEXPLAINED) -> dict[str, object]:
    """Labels of the amplitude spectrum, and of the envelope spectrum under `envelope`."""
    found = label_sets(series, known, max_unexplained)
    if found is None:
        return no_labels(known.bases_hz, why_unlabelled(series, known))
    return {**labels_document(found.amplitude), "envelope": labels_document(found.envelope)}


def label_stored(
    reader: ResultReader, channel: str, machine: MachineSpec, max_unexplained: int = MAX_UNEXPLAINED
) -> dict[str, object]:
    """The same for a channel of a stored result; raises UnknownArtefact for an unknown channel."""
    about = reader.channel(channel)
    summary = reader.document("summary")
    bases, start_s = summary.get("frequencies", {}), summary.get("analysed_from_s", 0.0)
    assert isinstance(bases, dict) and isinstance(start_s, int | float)
    rate = reader.manifest.sampling_rate_hz
    first = round(start_s * rate)
    series = Series(
        samples=reader.signal(channel, first, reader.manifest.samples),
        sampling_rate_hz=rate,
        unit=about.unit,
        name=channel,
        quantity=about.quantity,
        start_s=first / rate,
    )
    quality = summary.get("quality")
    step_s = quality.get("step_s") if isinstance(quality, Mapping) else None
    known = Predicted(
        machine=machine,
        seed=reader.manifest.seed,
        bases_hz=bases,
        step_s=step_s if isinstance(step_s, float) else None,
    )
    return label_channel(series, known, max_unexplained)
