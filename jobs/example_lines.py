"""Which predicted lines an example shows: those that stand out with the effect and not without it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from signals.floor import FloorSettings, noise_floor
from signals.spectra.types import Spectrum
from sim.core.lines import Line

LEADING = 6
"""Lines that are marked at most, and that are named when they are not seen."""
RISE = 2.0
"""Least ratio of a line's amplitudes with the effect and without (6 dB)."""
OVER_FLOOR = 4.0
"""Least ratio of a line to the local floor (12 dB): a bin of Gaussian noise gets there once in 10^7."""
IN_ENVELOPE = frozenset({"outer", "inner", "ball", "cage"})
"""Families whose rate shows in the envelope of a resonance rather than as a line of its own."""

Predicted = tuple[Line, float]


@dataclass(frozen=True, kw_only=True)
class Seen:
    """`marked`: the strongest of the lines that show, in the order of prediction, with their frequencies in Hz;
    `unseen`: labels of the leading ones that do not; `leading`: how many of the leading ones show.
    """

    marked: tuple[Predicted, ...]
    unseen: tuple[str, ...]
    leading: int


def in_envelope(lines: Sequence[Predicted]) -> bool:
    """Whether the effect is looked for in the envelope."""
    return bool(lines) and lines[0][0].family in IN_ENVELOPE


def seen(lines: Sequence[Predicted], spectrum: Spectrum, other: Spectrum | None, *, falls: bool) -> Seen:
    """Compare the spectra with the effect and without (None: no such machine); `falls`: the lines go with the effect.

    Of an envelope spectrum only the lines within it count, without those that name a mesh frequency: an envelope shows
    what modulates, not what is modulated.
    """
    if spectrum.kind != "amplitude":
        lines = [pair for pair in lines if not any(base.startswith("f_m") for base, _ in pair[0].orders)]
    lines = [pair for pair in lines if 0.0 < pair[1] < spectrum.frequency_hz[-2]]
    after, before = (spectrum, other) if other is None or not falls else (other, spectrum)
    floor = noise_floor(after, FloorSettings()).level
    levels = {}
    for line, hz in lines:
        level = amplitude_at(after, hz)
        rises = before is None or level >= RISE * amplitude_at(before, hz)
        if rises and level >= OVER_FLOOR * floor[round(hz / after.resolution_hz)]:
            levels[line.label] = level
    strongest = set(sorted(levels, key=lambda label: levels[label])[-LEADING:])
    first = [line.label for line, _ in lines[:LEADING]]
    return Seen(
        marked=tuple(pair for pair in lines if pair[0].label in strongest),
        unseen=tuple(label for label in first if label not in levels),
        leading=sum(label in levels for label in first),
    )


def amplitude_at(spectrum: Spectrum, frequency_hz: float) -> float:
    """Largest of the three bins around a frequency."""
    nearest = round(frequency_hz / spectrum.resolution_hz)
    return float(np.max(spectrum.values[nearest - 1 : nearest + 2]))
