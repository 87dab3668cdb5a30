"""Entries of a label set, read from a spectrum and the meeting of its peaks with predicted lines."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from signals.floor import Floor
from signals.labels.canonical import Candidate
from signals.labels.combinations import INTERMODULATION
from signals.labels.evidence import Evidence
from signals.labels.families import MECHANISM
from signals.labels.rivals import Meeting
from signals.labels.types import LabelledPeak
from signals.peaks import FoundPeaks
from signals.spectra.types import Spectrum
from signals.windows import MAIN_LOBE_BINS


@dataclass(frozen=True, kw_only=True)
class Scene:
    """Everything a label is read from."""

    spectrum: Spectrum
    found: FoundPeaks
    noise: Floor
    meeting: Meeting
    evidence: Evidence
    unit_hz: float


def labelled(scene: Scene, i: int, candidate: Candidate) -> LabelledPeak:
    """The entry of a predicted line."""
    meeting, spectrum = scene.meeting, scene.spectrum
    label = _named(scene, candidate)
    peak = meeting.peak[i]
    if peak is None:
        reach_hz = MAIN_LOBE_BINS[spectrum.window] * spectrum.resolution_hz
        limit = _detection_limit(scene, candidate.frequency_hz)
        return replace(label, detection_limit=limit, masked_by=meeting.masked_by(i, reach_hz))
    word = scene.evidence.words[i]
    # what nothing speaks for does not put in doubt what something speaks for
    alternatives = tuple(
        label for label in meeting.alternatives[i] if word == "chance" or label not in scene.evidence.doubted
    )
    of_its_own = word in ("sum", "chance")
    if word == "sum" and candidate.mechanism == MECHANISM:
        # nothing excites the family, the sum of what is excited does
        label = replace(label, mechanism=INTERMODULATION, mechanisms=(INTERMODULATION,))
    return replace(
        label,
        status="ambiguous" if alternatives or word == "chance" else "present",
        evidence=word,
        measured_frequency_hz=float(scene.found.frequency_hz[peak]),
        amplitude=float(scene.found.amplitude[peak]),
        db_over_floor=float(scene.found.db_over_floor[peak]),
        alternatives=alternatives,
        chance_coincidence=float(scene.evidence.chance[i]) if of_its_own else meeting.chance[i],
    )


def above_nyquist(scene: Scene, candidate: Candidate) -> LabelledPeak:
    """The entry of a predicted line that the spectrum cannot show: nothing is said of its size."""
    return replace(_named(scene, candidate), status="above_nyquist")


def _named(scene: Scene, candidate: Candidate) -> LabelledPeak:
    """The entry of a predicted line before anything was measured."""
    return LabelledPeak(
        label=candidate.label,
        status="absent",
        frequency_hz=candidate.frequency_hz,
        order=candidate.frequency_hz / scene.unit_hz,
        unit=scene.spectrum.unit,
        scaling=scene.spectrum.scaling,
        component=candidate.component,
        components=candidate.components,
        family=candidate.family,
        mechanism=candidate.mechanism,
        mechanisms=candidate.mechanisms,
        aliases=candidate.aliases,
    )


def _detection_limit(scene: Scene, frequency_hz: float) -> float:
    """Amplitude that would have been seen: the threshold, or what stands there already if that is more."""
    nearest = round(frequency_hz / scene.spectrum.resolution_hz)
    seen = float(np.max(scene.spectrum.values[nearest - 1 : nearest + 2]))
    return max(float(scene.noise.threshold[nearest]), seen)


def unexplained(scene: Scene, peak: int) -> LabelledPeak:
    """The entry of a peak that nothing explains."""
    frequency = float(scene.found.frequency_hz[peak])
    return LabelledPeak(
        label="",
        status="unexplained",
        frequency_hz=frequency,
        order=frequency / scene.unit_hz,
        unit=scene.spectrum.unit,
        scaling=scene.spectrum.scaling,
        measured_frequency_hz=frequency,
        amplitude=float(scene.found.amplitude[peak]),
        db_over_floor=float(scene.found.db_over_floor[peak]),
    )
