"""Entries of the peaks that only a combination of bases explains, and how they stand beside the families."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from signals.floor import FloorSettings
from signals.labels.canonical import Candidate, inside, merge_lines
from signals.labels.entries import Scene, labelled
from signals.labels.evidence import Evidence, Word
from signals.labels.explain import SAME_HZ, Sums, bounded_chance, displaced_peaks, explained_by, proven_sums
from signals.labels.families import Bound
from signals.labels.images import FAMILY as NUMERICAL
from signals.labels.kinematics import Kinematics
from signals.labels.rivals import meet, reach_hz
from signals.labels.types import LabelledPeak, Matching
from signals.peaks import FoundPeaks
from signals.series import BoolArray, FloatArray
from signals.spectra.types import Spectrum


@dataclass(frozen=True, kw_only=True)
class Setting:
    """What decides whether there is a peak and whether a sum explains it."""

    matching: Matching
    bound: Bound
    floor: FloorSettings


@dataclass(frozen=True, kw_only=True)
class Further:
    """Entries of sums, the scene with the lines they take from families without evidence, the peaks that neither a sum
    nor a line with evidence explains (peaks,), those without any name (peaks,), and the shares of lines at random
    places called present and named at all.
    """

    entries: list[LabelledPeak]
    scene: Scene
    left: BoolArray
    nameless: BoolArray
    present: float
    named: float


def unproven(scene: Scene) -> BoolArray:
    """Peaks that no line with evidence explains, shape (peaks,)."""
    free = np.ones(scene.found.amplitude.size, dtype=np.bool_)
    owned = [p for p, word in zip(scene.meeting.peak, scene.evidence.words, strict=True) if word != "chance"]
    free[[p for p in owned if p is not None]] = False
    return free


@dataclass(frozen=True, kw_only=True)
class Explained:
    """What the sums say of some peaks: the credible ones of each, those of one that is there alone if there are any;
    their chance, and whether the first is there; shapes (peaks,). `present`, `named`: see `Further`.
    """

    owners: list[list[int]]
    chance: FloatArray
    good: BoolArray
    present: float
    named: float


def untouched(scene: Scene) -> Further:
    """Nothing further: the peaks as the families leave them."""
    left = unproven(scene)
    nameless = left & ~np.array(scene.meeting.explained, dtype=np.bool_)
    return Further(entries=[], scene=scene, left=left, nameless=nameless, present=0.0, named=0.0)


def combine(
    before: Further,
    sums: Sums,
    kinematics: Kinematics,
    bases_hz: Mapping[str, float],
    setting: Setting,
    *,
    tried: BoolArray,
    proven_only: bool = False,
) -> Further:
    """Try the peaks `tried` (peaks,), which no line with evidence explains, against all `sums`.

    A peak near a line of a family without evidence goes to a sum only where that is not chance; with `proven_only` no
    peak goes to one that is.
    """
    scene, spectrum, near = before.scene, before.scene.spectrum, setting.matching
    if not tried.any() or not sums.rank.size:
        return before
    left = scene.found.part(tried)
    told = _explained(sums, left, spectrum, near, near.max_chance - before.named)
    claimed = np.array(scene.meeting.explained, dtype=np.bool_)[tried]
    some = np.array([bool(o) for o in told.owners], dtype=np.bool_)
    named = some & (told.good if proven_only else ~claimed | told.good)
    chosen = [i for o, kept in zip(told.owners, named, strict=True) if kept for i in o]
    lines = [line for i in chosen for line in sums.lines(i)]
    candidates = inside(merge_lines(lines, bases_hz, kinematics), spectrum)
    part = left.part(named)
    meeting = meet(candidates, part, spectrum.resolution_hz, near, setting.bound)
    odds = np.array([1.0 if p is None else told.chance[named][p] for p in meeting.peak])
    own = np.array([sums.series(o[0]) for o, kept in zip(told.owners, named, strict=True) if kept], dtype=np.bool_)
    words = tuple(_word(p, told.good[named], own) for p in meeting.peak)
    inner = replace(scene, found=part, meeting=meeting, evidence=Evidence(words=words, chance=odds))
    entries = [labelled(inner, i, c) for i, c in enumerate(candidates) if meeting.peak[i] is not None]
    rest, nameless = before.left.copy(), before.nameless.copy()
    for kept in (rest, nameless):
        kept[np.flatnonzero(tried)[named][np.array(meeting.explained, dtype=np.bool_)]] = False
    outer, entries = _handed_over(scene, entries, part, np.flatnonzero(tried)[named])
    return Further(
        entries=[*before.entries, *entries],
        scene=outer,
        left=rest,
        nameless=nameless,
        present=before.present + told.present,
        named=before.named + (told.present if proven_only else told.named),
    )


def _explained(sums: Sums, left: FoundPeaks, spectrum: Spectrum, near: Matching, max_chance: float) -> Explained:
    """What the sums say of the peaks `left`, with no more than `max_chance` of lines anywhere named."""
    step, top = spectrum.resolution_hz, float(spectrum.frequency_hz[-1])
    reach = reach_hz(left, step, near)
    moved = displaced_peaks(sums, left, reach, resolution_hz=step, top_hz=top)
    limit, share = bounded_chance(moved, max_chance)
    owners, chance = explained_by(sums, left.frequency_hz, reach, resolution_hz=step, max_chance=limit)
    proven = proven_sums(sums, owners, left, reach, resolution_hz=step, top_hz=top, matching=near)
    good = np.array([bool(o) and bool(proven[o[0]]) for o in owners], dtype=np.bool_)
    # what is not there does not put in doubt what is
    owners = [[i for i in o if proven[i]] if g else o for o, g in zip(owners, good, strict=True)]
    present = moved.share(limit, proven)
    return Explained(owners=owners, chance=chance, good=good, present=present, named=share)


def _word(peak: int | None, good: BoolArray, series: BoolArray) -> Word:
    """What speaks for a sum."""
    if peak is None or not good[peak]:
        return "chance"
    return "family" if series[peak] else "sum"


def found_bases(scene: Scene) -> frozenset[str]:
    """Bases of which a multiple, without sidebands, was found with evidence."""
    met = zip(scene.meeting.candidates, scene.meeting.peak, scene.evidence.words, strict=True)
    return frozenset(
        c.orders[0][0] for c, peak, word in met if peak is not None and word != "chance" and len(c.orders) == 1
    )


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
            words[i], chance[i] = equal[0].evidence or "sum", equal[0].chance_coincidence or 0.0
        else:
            owner[int(peak[i] or 0)] = there[0].label
            peak[i] = None
    meeting = replace(scene.meeting, peak=tuple(peak), owner=tuple(owner))
    evidence = replace(scene.evidence, words=tuple(words), chance=chance)
    return replace(scene, meeting=meeting, evidence=evidence), [e for e in entries if e.label not in same]
