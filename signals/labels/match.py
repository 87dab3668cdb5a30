"""Labelling the peaks of a spectrum with predicted lines."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from signals.floor import FloorSettings, noise_floor
from signals.labels.canonical import Candidate, inside, merge_lines
from signals.labels.combinations import Grid, carriers, grids
from signals.labels.entries import Scene, above_nyquist, labelled, unexplained
from signals.labels.evidence import weigh
from signals.labels.explain import explained_by, gather, measured_hits
from signals.labels.families import Bound
from signals.labels.further import Further, Setting, combine, found_bases, untouched
from signals.labels.images import STEP_BASE, faint, image_grids
from signals.labels.kinematics import Kinematics
from signals.labels.rivals import meet, reach_hz
from signals.labels.series import series_grids, tooth_grids
from signals.labels.types import FalseMatch, LabelledPeak, LabelSet, Matching
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
    max_unexplained: int = MAX_UNEXPLAINED,
    step_hz: float | None = None,
    merged: Sequence[Candidate] | None = None,
) -> LabelSet:
    """Match the peaks of a line spectrum with `lines`, merged where `kinematics` make them identical.

    Every predicted line inside the spectrum gets exactly one entry (present, ambiguous or absent), and those beyond
    the end of an amplitude spectrum one as `above_nyquist`. Peaks that no line explains are tried against the
    combinations of `bound` (family `combination`, listed only where found); what is still left is unexplained, the
    `max_unexplained` strongest are listed. `reference` is the shaft that orders are counted by.
    `step_hz`: steps a second of the simulation the spectrum is of, for the lines that its steps make (base `f_s`).
    `merged`: what `merge_lines` makes of the same lines, where several spectra are labelled with them.
    """
    spectrum.amplitude_factor("peak")  # refuses densities
    _check_bases(lines, bases_hz, reference)
    setting = Setting(matching=matching or Matching(), bound=bound or Bound(), floor=floor or FloorSettings())
    every = tuple(merged) if merged is not None else merge_lines(lines, bases_hz, kinematics)
    known = _known(lines, bases_hz, kinematics, step_hz, spectrum)
    further = _further(_scene(spectrum, inside(every, spectrum), bases_hz[reference], setting, known), known, setting)
    scene = further.scene
    rest = scene.found.part(further.nameless)
    strangers = _strangers(scene, rest, max_unexplained)
    entries = [*further.entries, *strangers]
    entries += [labelled(scene, i, candidate) for i, candidate in enumerate(scene.meeting.candidates)]
    entries += [above_nyquist(scene, candidate) for candidate in _beyond(every, spectrum)]
    return LabelSet(
        frequencies_hz=dict(known.bases_hz),
        reference=reference,
        peaks=tuple(sorted(entries, key=lambda p: (p.frequency_hz, p.label))),
        channel=spectrum.channel,
        kind=spectrum.kind,
        unit=spectrum.unit,
        scaling=spectrum.scaling,
        window=spectrum.window,
        resolution_hz=spectrum.resolution_hz,
        bound=setting.bound,
        matching=setting.matching,
        floor=setting.floor,
        found=scene.found.amplitude.size,
        unexplained=rest.amplitude.size,
        truncated=rest.amplitude.size - len(strangers),
        false_match=_false_match(scene, further, setting.matching),
        band=spectrum.band,
    )


@dataclass(frozen=True, kw_only=True)
class Known:
    """What is known of the machine. Without `kinematics` nothing is known of what may modulate what."""

    lines: Sequence[Line]
    bases_hz: Mapping[str, float]
    kinematics: Kinematics | None
    images: Sequence[Grid] = ()
    """Lines that the steps of the simulation make, if it is one."""


def _known(
    lines: Sequence[Line],
    bases_hz: Mapping[str, float],
    kinematics: Kinematics | None,
    step_hz: float | None,
    spectrum: Spectrum,
) -> Known:
    if kinematics is None or step_hz is None:
        return Known(lines=lines, bases_hz=bases_hz, kinematics=kinematics)
    meshes, balls = carriers(kinematics, bases_hz, lines)
    top, resolution = float(spectrum.frequency_hz[-1]), spectrum.resolution_hz
    images = tuple(image_grids((*meshes, *balls), bases_hz, step_hz=step_hz, top_hz=top, resolution_hz=resolution))
    return Known(lines=lines, bases_hz={**bases_hz, STEP_BASE: step_hz}, kinematics=kinematics, images=images)


def _scene(
    spectrum: Spectrum, candidates: tuple[Candidate, ...], unit_hz: float, setting: Setting, known: Known
) -> Scene:
    """The peaks of a spectrum, the lines they meet, and what speaks for each."""
    noise = noise_floor(spectrum, setting.floor, np.array([c.frequency_hz for c in candidates]))
    found, step, near = find_peaks(spectrum, noise), spectrum.resolution_hz, setting.matching
    meeting = meet(candidates, found, step, near, setting.bound)
    reach, top = reach_hz(found, step, near), float(spectrum.frequency_hz[-1])
    folded = gather(known.images)
    owners, _ = explained_by(folded, found.frequency_hz, reach, resolution_hz=step, max_chance=near.max_chance)
    doubtful = np.array([bool(o) for o in owners], dtype=np.bool_) & faint(found)
    evidence = weigh(meeting, found, reach, resolution_hz=step, top_hz=top, matching=near, doubtful=doubtful)
    return Scene(spectrum=spectrum, found=found, noise=noise, meeting=meeting, evidence=evidence, unit_hz=unit_hz)


def _further(scene: Scene, known: Known, setting: Setting) -> Further:
    """What series of defects and combinations explain, and of the weak peaks that they leave the images of the steps;
    nothing where the ties of the machine are not known.
    """
    kinematics, bases_hz, first = known.kinematics, known.bases_hz, untouched(scene)
    if kinematics is None:
        return first
    top = float(scene.spectrum.frequency_hz[-1])
    products = grids(kinematics, bases_hz, known.lines, top_hz=top, bound=setting.bound)
    series = series_grids(kinematics, bases_hz, known.lines, found=found_bases(scene), top_hz=top, bound=setting.bound)
    teeth = tooth_grids(kinematics, bases_hz, known.lines, top_hz=top)
    physical = combine(first, gather([*series, *teeth, *products]), kinematics, bases_hz, setting, tried=first.left)
    weak = faint(scene.found)
    images = gather(known.images)
    return combine(physical, images, kinematics, bases_hz, setting, tried=physical.left & weak, proven_only=True)


def _false_match(scene: Scene, further: Further, near: Matching) -> FalseMatch:
    """Shares of lines at random places that would have been called present, or named at all."""
    spectrum, found = scene.spectrum, scene.found
    step, top = spectrum.resolution_hz, float(spectrum.frequency_hz[-1])
    reach = reach_hz(found, step, near)

    def share(words: Sequence[str]) -> float:
        kept = [
            c.frequency_hz
            for c, word in zip(scene.meeting.candidates, scene.evidence.words, strict=True)
            if word in words
        ]
        return measured_hits(np.array(kept), found, reach, resolution_hz=step, top_hz=top)

    return FalseMatch(
        families=share(("term", "family", "sum")),
        combinations=further.present,
        ambiguous=share(("chance",)) + further.named - further.present,
        bound=near.max_chance,
    )


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


def _beyond(candidates: Sequence[Candidate], spectrum: Spectrum) -> tuple[Candidate, ...]:
    """Candidates at or beyond the end of an amplitude spectrum; an envelope's axis ends with its band."""
    if spectrum.kind != "amplitude":
        return ()
    end = float(spectrum.frequency_hz[-1]) - MAIN_LOBE_BINS[spectrum.window] * spectrum.resolution_hz
    return tuple(c for c in candidates if c.frequency_hz > end)
