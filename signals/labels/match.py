"""Labelling the peaks of a spectrum with predicted lines."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from signals.floor import FloorSettings, noise_floor
from signals.labels.canonical import Candidate, merge_lines
from signals.labels.combinations import grids
from signals.labels.entries import Scene, above_nyquist, labelled, unexplained
from signals.labels.explain import FalseMatch, Sums, bounded_chance, explained_by, gather, measured_hits
from signals.labels.families import Bound
from signals.labels.kinematics import Kinematics
from signals.labels.rivals import meet, reach_hz
from signals.labels.types import LabelledPeak, LabelSet, Matching
from signals.peaks import FoundPeaks, find_peaks
from signals.spectra.types import Spectrum
from signals.windows import MAIN_LOBE_BINS
from sim.core.errors import Problem, SpecError, UnknownName
from sim.core.lines import Line

MAX_UNEXPLAINED = 200


@dataclass(frozen=True, kw_only=True)
class Setting:
    """What decides whether a sum explains a peak."""

    matching: Matching
    bound: Bound


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
    max_unexplained: int = MAX_UNEXPLAINED,
) -> LabelSet:
    """Match the peaks of a line spectrum with `lines`, merged where `kinematics` make them identical.

    Every predicted line inside the spectrum gets exactly one entry (present, ambiguous or absent), and those beyond
    the end of an amplitude spectrum one as `above_nyquist`. Peaks that no line explains are tried against the
    combinations of `bound` (family `combination`, listed only where found); what is still left is unexplained, the
    `max_unexplained` strongest are listed. `reference` is the shaft that orders are counted by.
    """
    spectrum.amplitude_factor("peak")  # refuses densities
    _check_bases(lines, bases_hz, reference)
    settings, near, limits = floor or FloorSettings(), matching or Matching(), bound or Bound()
    every = merge_lines(lines, bases_hz, kinematics)
    candidates = _inside(every, spectrum)
    noise = noise_floor(spectrum, settings, np.array([c.frequency_hz for c in candidates]))
    found = find_peaks(spectrum, noise)
    meeting = meet(candidates, found, spectrum.resolution_hz, near, limits)
    scene = Scene(spectrum=spectrum, found=found, noise=noise, meeting=meeting, unit_hz=bases_hz[reference])
    entries = [labelled(scene, i, candidate) for i, candidate in enumerate(candidates)]
    entries += [above_nyquist(scene, candidate) for candidate in _beyond(every, spectrum)]
    left = rest = found.part(~np.array(meeting.explained, dtype=np.bool_))
    share = 0.0
    if kinematics is not None:
        top = float(spectrum.frequency_hz[-1])
        sums = gather(grids(kinematics, bases_hz, lines, top_hz=top, bound=limits))
        combined, rest, share = _combined(scene, left, sums, kinematics, bases_hz, Setting(matching=near, bound=limits))
        entries += combined
    strangers = _strangers(scene, rest, max_unexplained)
    entries += strangers
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
        unexplained=rest.amplitude.size,
        truncated=rest.amplitude.size - len(strangers),
        false_match=FalseMatch(families=_by_families(scene, near), combinations=share, bound=near.max_chance),
        band=spectrum.band,
    )


def _combined(
    scene: Scene, left: FoundPeaks, sums: Sums, kinematics: Kinematics, bases_hz: Mapping[str, float], setting: Setting
) -> tuple[list[LabelledPeak], FoundPeaks, float]:
    """Entries of the peaks in `left` that a credible combination explains, the peaks still left, and the share of
    lines at random places that would have been explained too.
    """
    spectrum, near = scene.spectrum, setting.matching
    step, top = spectrum.resolution_hz, float(spectrum.frequency_hz[-1])
    reach = reach_hz(left, step, near)
    limit, share = bounded_chance(sums, left, reach, resolution_hz=step, top_hz=top, max_chance=near.max_chance)
    owners, chance = explained_by(sums, left.frequency_hz, reach, resolution_hz=step, max_chance=limit)
    explained = np.array([bool(o) for o in owners], dtype=np.bool_)
    lines = [line for o in owners for i in o for line in sums.lines(i)]
    candidates = _inside(merge_lines(lines, bases_hz, kinematics), spectrum)
    named = left.part(explained)
    meeting = meet(candidates, named, step, near, setting.bound)
    inner = replace(scene, found=named, meeting=meeting)
    odds = chance[explained]
    entries = [
        replace(labelled(inner, i, candidate), chance_coincidence=float(odds[peak]))
        for i, candidate in enumerate(candidates)
        if (peak := meeting.peak[i]) is not None
    ]
    explained[explained] = meeting.explained
    return entries, left.part(~explained), share


def _by_families(scene: Scene, near: Matching) -> float:
    """Share of lines at random places that a predicted line would have explained."""
    spectrum, found = scene.spectrum, scene.found
    step, top = spectrum.resolution_hz, float(spectrum.frequency_hz[-1])
    predicted = np.array([c.frequency_hz for c in scene.meeting.candidates])
    return measured_hits(predicted, found, reach_hz(found, step, near), resolution_hz=step, top_hz=top)


def _strangers(scene: Scene, left: FoundPeaks, most: int) -> list[LabelledPeak]:
    """Entries of the strongest peaks in `left`, at most `most`."""
    strongest = np.argsort(-left.amplitude, kind="stable")[:most]
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


def _beyond(candidates: Sequence[Candidate], spectrum: Spectrum) -> tuple[Candidate, ...]:
    """Candidates at or beyond the end of an amplitude spectrum; an envelope's axis ends with its band."""
    if spectrum.kind != "amplitude":
        return ()
    end = float(spectrum.frequency_hz[-1]) - MAIN_LOBE_BINS[spectrum.window] * spectrum.resolution_hz
    return tuple(c for c in candidates if c.frequency_hz > end)
