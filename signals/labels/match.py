"""Labelling the peaks of a spectrum with predicted lines."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from signals.floor import FloorSettings, noise_floor
from signals.labels.canonical import Candidate, merge_lines
from signals.labels.combinations import combine
from signals.labels.entries import Scene, labelled, unexplained
from signals.labels.families import Bound
from signals.labels.kinematics import Kinematics
from signals.labels.rivals import chance_of_another, meet, reach_hz
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

    Every predicted line inside the spectrum gets exactly one entry (present, ambiguous or absent). Peaks that no
    line explains are tried against the combinations of `bound` (family `combination`, listed only where found);
    what is still left is unexplained, the strongest listed up to a limit. `reference` is the shaft that orders
    are counted by.
    """
    spectrum.amplitude_factor("peak")  # refuses densities
    _check_bases(lines, bases_hz, reference)
    settings, near, limits = floor or FloorSettings(), matching or Matching(), bound or Bound()
    candidates = _inside(merge_lines(lines, bases_hz, kinematics), spectrum)
    noise = noise_floor(spectrum, settings, np.array([c.frequency_hz for c in candidates]))
    found = find_peaks(spectrum, noise)
    meeting = meet(candidates, found, spectrum.resolution_hz, near, limits)
    scene = Scene(spectrum=spectrum, found=found, noise=noise, meeting=meeting, unit_hz=bases_hz[reference])
    entries = [labelled(scene, i, candidate) for i, candidate in enumerate(candidates)]
    left = found.part(~np.array(meeting.explained, dtype=np.bool_))
    if kinematics is not None:
        combined, left = _combined(scene, left, bases_hz, kinematics, near, limits)
        entries += combined
    entries += _strangers(scene, left)
    return LabelSet(
        frequencies_hz=dict(bases_hz),
        reference=reference,
        peaks=tuple(sorted(entries, key=lambda p: (p.frequency_hz, p.label))),
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
        unexplained=left.amplitude.size,
        band=spectrum.band,
    )


def _combined(
    scene: Scene,
    left: FoundPeaks,
    bases_hz: Mapping[str, float],
    kinematics: Kinematics,
    matching: Matching,
    bound: Bound,
) -> tuple[list[LabelledPeak], FoundPeaks]:
    """Entries of the peaks in `left` that a credible combination explains, and the peaks still left."""
    spectrum = scene.spectrum
    top = float(spectrum.frequency_hz[-1])
    combinations = combine(
        kinematics, bases_hz, left, reach_hz=matching.bins * spectrum.resolution_hz, max_frequency_hz=top, bound=bound
    )
    candidates = _inside(merge_lines(combinations.lines, bases_hz, kinematics), spectrum)
    meeting = meet(candidates, left, spectrum.resolution_hz, matching, bound)
    inner = replace(scene, found=left, meeting=meeting)
    entries: list[LabelledPeak] = []
    explained = np.zeros(left.amplitude.size, dtype=np.bool_)
    for i, candidate in enumerate(candidates):
        peak = meeting.peak[i]
        if peak is None:
            continue
        rivals = combinations.up_to(candidate.weight)
        reach = float(reach_hz(left, spectrum.resolution_hz, matching)[peak])
        chance = chance_of_another(rivals, float(left.frequency_hz[peak]), reach, spectrum.resolution_hz)
        if chance <= matching.max_chance:
            explained[peak] = True
            entries.append(replace(labelled(inner, i, candidate), chance_coincidence=chance))
    return entries, left.part(~explained)


def _strangers(scene: Scene, left: FoundPeaks) -> list[LabelledPeak]:
    """Entries of the strongest peaks in `left`."""
    strongest = np.argsort(-left.amplitude, kind="stable")[:MAX_UNEXPLAINED]
    return [unexplained(replace(scene, found=left), int(i)) for i in strongest]


def _check_bases(lines: Sequence[Line], bases_hz: Mapping[str, float], reference: str) -> None:
    unknown = sorted(({base for line in lines for base, _ in line.orders} | {reference}) - set(bases_hz))
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
