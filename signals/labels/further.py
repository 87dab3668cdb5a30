"""Entries of the peaks that only a combination of bases explains, and how they stand beside the families."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from signals.floor import FloorSettings
from signals.labels.canonical import Candidate, inside, merge_lines
from signals.labels.entries import Scene, labelled
from signals.labels.evidence import Evidence, Word
from signals.labels.explain import SAME_HZ, Sums, bounded_chance, explained_by, measured_chance, proven_sums
from signals.labels.families import Bound
from signals.labels.images import FAMILY as NUMERICAL
from signals.labels.kinematics import Kinematics
from signals.labels.rivals import meet, reach_hz
from signals.labels.types import LabelledPeak, Matching
from signals.peaks import FoundPeaks
from signals.series import BoolArray


@dataclass(frozen=True, kw_only=True)
class Setting:
    """What decides whether there is a peak and whether a sum explains it."""

    matching: Matching
    bound: Bound
    floor: FloorSettings


@dataclass(frozen=True, kw_only=True)
class Further:
    """Entries of combinations, the scene with the lines they take from families without evidence, the peaks still
    without any name (peaks,), and the shares of lines at random places called present and named at all.
    """

    entries: list[LabelledPeak]
    scene: Scene
    nameless: BoolArray
    present: float
    named: float


def unproven(scene: Scene) -> BoolArray:
    """Peaks that no line with evidence explains, shape (peaks,)."""
    free = np.ones(scene.found.amplitude.size, dtype=np.bool_)
    owned = [p for p, word in zip(scene.meeting.peak, scene.evidence.words, strict=True) if word != "chance"]
    free[[p for p in owned if p is not None]] = False
    return free


def combine(
    scene: Scene, sums: Sums, kinematics: Kinematics, bases_hz: Mapping[str, float], setting: Setting
) -> Further:
    """Try the peaks that no line with evidence explains against all `sums`.

    A peak near a line of a family without evidence goes to a combination only where that is not chance.
    """
    spectrum, near = scene.spectrum, setting.matching
    step, top = spectrum.resolution_hz, float(spectrum.frequency_hz[-1])
    tried = unproven(scene)
    left = scene.found.part(tried)
    reach = reach_hz(left, step, near)
    limit, share = bounded_chance(sums, left, reach, resolution_hz=step, top_hz=top, max_chance=near.max_chance)
    owners, chance = explained_by(sums, left.frequency_hz, reach, resolution_hz=step, max_chance=limit)
    proven = proven_sums(sums, owners, left, reach, resolution_hz=step, top_hz=top, matching=near)
    good = np.array([bool(o) and bool(proven[o[0]]) for o in owners], dtype=np.bool_)
    claimed = np.array(scene.meeting.explained, dtype=np.bool_)[tried]
    named = np.array([bool(o) for o in owners], dtype=np.bool_) & (~claimed | good)
    lines = [line for o, kept in zip(owners, named, strict=True) if kept for i in o for line in sums.lines(i)]
    candidates = inside(merge_lines(lines, bases_hz, kinematics), spectrum)
    part = left.part(named)
    meeting = meet(candidates, part, step, near, setting.bound)
    odds = np.array([1.0 if p is None else chance[named][p] for p in meeting.peak])
    shown = good[named]
    words: tuple[Word, ...] = tuple("chance" if p is None or not shown[p] else "sum" for p in meeting.peak)
    inner = replace(scene, found=part, meeting=meeting, evidence=Evidence(words=words, chance=odds))
    entries = [labelled(inner, i, c) for i, c in enumerate(candidates) if meeting.peak[i] is not None]
    taken = np.flatnonzero(tried)[named][np.array(meeting.explained, dtype=np.bool_)]
    nameless = np.zeros(scene.found.amplitude.size, dtype=np.bool_)
    nameless[tried] = ~claimed
    nameless[taken] = False
    by_chance = measured_chance(sums, left, reach, resolution_hz=step, top_hz=top, max_chance=limit, proven=proven)
    outer, entries = _handed_over(scene, entries, part, np.flatnonzero(tried)[named])
    return Further(entries=entries, scene=outer, nameless=nameless, present=by_chance, named=share)


def _same(entry: LabelledPeak, candidate: Candidate) -> bool:
    """Whether a combination is a family's line in another form; one with the step rate never is."""
    return entry.family != NUMERICAL and abs(entry.frequency_hz - candidate.frequency_hz) < SAME_HZ


def _handed_over(
    scene: Scene, entries: list[LabelledPeak], part: FoundPeaks, place: np.ndarray
) -> tuple[Scene, list[LabelledPeak]]:
    """The scene and the combinations' entries after each peak has one of the two names.

    A line of a family that is the same sum keeps its name, and has the sum's evidence; another one loses the peak.
    """
    by_hz: dict[float, list[LabelledPeak]] = {}
    for entry in entries:
        by_hz.setdefault(entry.measured_frequency_hz or 0.0, []).append(entry)
    peak, owner = list(scene.meeting.peak), list(scene.meeting.owner)
    words, chance = list(scene.evidence.words), scene.evidence.chance.copy()
    sums = {int(p): by_hz.get(float(hz), []) for p, hz in zip(place, part.frequency_hz, strict=True)}
    same: set[str] = set()
    for i, candidate in enumerate(scene.meeting.candidates):
        there = sums.get(-1 if peak[i] is None else int(peak[i] or 0), [])
        if not there:
            continue
        equal = [e for e in there if _same(e, candidate)]
        if equal:
            same |= {e.label for e in equal}
            words[i], chance[i] = "sum", equal[0].chance_coincidence or 0.0
        else:
            owner[int(peak[i] or 0)] = there[0].label
            peak[i] = None
    meeting = replace(scene.meeting, peak=tuple(peak), owner=tuple(owner))
    evidence = replace(scene.evidence, words=tuple(words), chance=chance)
    return replace(scene, meeting=meeting, evidence=evidence), [e for e in entries if e.label not in same]
