"""Labelling the peaks of a spectrum with predicted lines."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from signals.floor import Floor, FloorSettings, noise_floor
from signals.labels.canonical import Candidate, merge_lines
from signals.labels.families import Bound
from signals.labels.kinematics import Kinematics
from signals.labels.rivals import Meeting, meet
from signals.labels.types import LabelledPeak, LabelSet, Matching
from signals.peaks import FoundPeaks, find_peaks
from signals.spectra.types import Spectrum
from signals.windows import MAIN_LOBE_BINS
from sim.core.errors import Problem, SpecError, UnknownName
from sim.core.lines import Line

MAX_UNEXPLAINED = 200


def label_peaks(
    spectrum: Spectrum,
    lines: Sequence[Line],
    bases_hz: Mapping[str, float],
    *,
    kinematics: Kinematics | None = None,
    bound: Bound | None = None,
    floor: FloorSettings | None = None,
    matching: Matching | None = None,
    reference: str = "f_r1",
) -> LabelSet:
    """Match the peaks of a line spectrum with `lines`, merged where `kinematics` make them identical.

    Every predicted line inside the spectrum gets exactly one entry (present, ambiguous or absent); peaks that no
    line explains are listed as unexplained, the strongest first up to a limit. `reference` is the shaft that
    orders are counted by.
    """
    spectrum.amplitude_factor("peak")  # refuses densities
    if reference not in bases_hz:
        raise UnknownName("base frequency", reference, tuple(bases_hz))
    _check_bases(lines, bases_hz)
    settings, near, limits = floor or FloorSettings(), matching or Matching(), bound or Bound()
    candidates = _inside(merge_lines(lines, bases_hz, kinematics), spectrum)
    predicted = np.array([c.frequency_hz for c in candidates])
    noise = noise_floor(spectrum, settings, predicted)
    found = find_peaks(spectrum, noise)
    meeting = meet(candidates, found, spectrum.resolution_hz, near, limits)
    scene = _Scene(spectrum=spectrum, found=found, noise=noise, meeting=meeting, unit_hz=bases_hz[reference])
    labelled = [_labelled(scene, i, candidate) for i, candidate in enumerate(candidates)]
    free = [i for i in np.argsort(-found.amplitude, kind="stable") if not meeting.explained[i]]
    labelled += [_unexplained(scene, int(i)) for i in free[:MAX_UNEXPLAINED]]
    return LabelSet(
        frequencies_hz=dict(bases_hz),
        reference=reference,
        peaks=tuple(sorted(labelled, key=lambda p: (p.frequency_hz, p.label))),
        channel=spectrum.channel,
        kind=spectrum.kind,
        unit=spectrum.unit,
        scaling=spectrum.scaling,
        window=spectrum.window,
        resolution_hz=spectrum.resolution_hz,
        bound=limits,
        matching=near,
        floor=settings,
        found=found.amplitude.size,
        unexplained=len(free),
        band=spectrum.band,
    )


def _check_bases(lines: Sequence[Line], bases_hz: Mapping[str, float]) -> None:
    unknown = sorted({base for line in lines for base, _ in line.orders} - set(bases_hz))
    if unknown:
        raise UnknownName("base frequency", unknown[0], tuple(bases_hz))
    bad = [base for base, hz in bases_hz.items() if not (np.isfinite(hz) and hz > 0)]
    if bad:
        message, allowed = "must be positive", "above 0"
        raise SpecError(
            [
                Problem(field=f"bases_hz.{b}", message=message, given=bases_hz[b], allowed=allowed, unit="Hz")
                for b in bad
            ]
        )


def _inside(candidates: Sequence[Candidate], spectrum: Spectrum) -> tuple[Candidate, ...]:
    """Candidates a main lobe away from zero frequency and from the end of the axis."""
    lobe = MAIN_LOBE_BINS[spectrum.window] * spectrum.resolution_hz
    top = float(spectrum.frequency_hz[-1])
    return tuple(c for c in candidates if lobe <= c.frequency_hz <= top - lobe)


@dataclass(frozen=True, kw_only=True)
class _Scene:
    """Everything a label is read from."""

    spectrum: Spectrum
    found: FoundPeaks
    noise: Floor
    meeting: Meeting
    unit_hz: float


def _labelled(scene: _Scene, i: int, candidate: Candidate) -> LabelledPeak:
    """The entry of a predicted line."""
    meeting, spectrum = scene.meeting, scene.spectrum
    label = LabelledPeak(
        label=candidate.label,
        status="absent",
        frequency_hz=candidate.frequency_hz,
        order=candidate.frequency_hz / scene.unit_hz,
        unit=spectrum.unit,
        scaling=spectrum.scaling,
        components=candidate.components,
        family=candidate.family,
        mechanism=candidate.mechanism,
        mechanisms=candidate.mechanisms,
        aliases=candidate.aliases,
    )
    peak = meeting.peak[i]
    if peak is None:
        reach_hz = MAIN_LOBE_BINS[spectrum.window] * spectrum.resolution_hz
        limit = _detection_limit(scene, candidate.frequency_hz)
        return replace(label, detection_limit=limit, masked_by=meeting.masked_by(i, reach_hz))
    return replace(
        label,
        status="ambiguous" if meeting.alternatives[i] else "present",
        measured_frequency_hz=float(scene.found.frequency_hz[peak]),
        amplitude=float(scene.found.amplitude[peak]),
        db_over_floor=float(scene.found.db_over_floor[peak]),
        alternatives=meeting.alternatives[i],
        chance_coincidence=meeting.chance[i],
    )


def _detection_limit(scene: _Scene, frequency_hz: float) -> float:
    """Amplitude that would have been seen: the threshold, or what stands there already if that is more."""
    nearest = round(frequency_hz / scene.spectrum.resolution_hz)
    seen = float(np.max(scene.spectrum.values[nearest - 1 : nearest + 2]))
    return max(float(scene.noise.threshold[nearest]), seen)


def _unexplained(scene: _Scene, peak: int) -> LabelledPeak:
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
