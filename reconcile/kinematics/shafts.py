"""Shaft orders against a baseline (unbalance, misalignment, looseness), and impulsiveness without any order."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from reconcile.kinematics.families import Ties
from reconcile.kinematics.lines import OrderLines, at_half_of_speeds, line_growth, matched, spectra_of
from reconcile.kinematics.observe import Observation

GROWTH_DB = 10.0
MEDIAN_GROWTH_DB = 6.0
MULTIPLES = (0.5, 1.0, 2.0, 3.0)
MATERIAL_DB = 6.0
"""A shaft line that has grown counts if it is among the strongest up to order 10: a weak one wanders with load."""
LEAST_PERIODS = 8.0
"""Of a line in a recording, for it to be parted from the slow motion that a speed that wanders makes."""
KURTOSIS_RATIO = 3.0
KURTOSIS_LEAST = 1.5
"""Excess kurtosis of a complex envelope: 0 for noise, -1 for a steady line."""
KURTOSIS_ALLOWANCE = 0.3


@dataclass(frozen=True, kw_only=True)
class ShaftChange:
    """A multiple of a shaft's order that grew: by the channel it grew most in, and the median over channels."""

    shaft: str
    multiple: float
    order: float
    channel: str
    growth_db: float
    median_db: float
    label: str
    seldom: bool = False
    """Whether it has grown, but at fewer than half of the speeds."""

    @property
    def grown(self) -> bool:
        """Whether it is more than one sensor's, and at most speeds."""
        return self.growth_db > GROWTH_DB and self.median_db > MEDIAN_GROWTH_DB and not self.seldom


@dataclass(frozen=True, kw_only=True)
class Impulsiveness:
    """Excess kurtosis of the most impulsive band, median over blocks of time, now and in the baseline."""

    channel: str
    now: float
    before: float | None
    band_hz: tuple[float, float]
    label: str

    @property
    def grown(self) -> bool:
        """Whether it is far above the baseline's."""
        return self.before is not None and self.now > max(
            KURTOSIS_LEAST, KURTOSIS_RATIO * (self.before + KURTOSIS_ALLOWANCE)
        )


def shaft_changes(
    tests: Sequence[Observation], baselines: Sequence[Observation], ties: Ties
) -> tuple[ShaftChange, ...]:
    """Multiples 1/2, 1, 2, 3 of every shaft, each where it grew most; empty without a baseline at the same speed.

    Levels are compared after the channel's own change of floor (median over the low orders) is taken off: gains and
    scales differ between sessions.
    """
    found: list[ShaftChange] = []
    speeds: dict[tuple[str, float], list[tuple[float, bool]]] = {}
    for test in tests:
        base = matched(test, baselines)
        if base is None:
            continue
        spectra = spectra_of(test, base)
        turns = min(o.speed.speed_hz * o.recording.duration_s for o in (test, base))
        for shaft, ratio in ties.shafts.items():
            for multiple in MULTIPLES:
                if multiple * ratio * turns < LEAST_PERIODS:
                    continue
                change = _change(spectra, shaft, multiple, ratio, test.label)
                seen = speeds.setdefault((shaft, multiple), [])
                seen.append((test.speed.speed_hz, change is not None and change.grown))
                if change is not None:
                    found.append(change)
    told = [replace(c, seldom=c.grown and not at_half_of_speeds(speeds[c.shaft, c.multiple])) for c in found]
    return tuple(sorted(told, key=lambda c: -c.growth_db))


def _change(
    spectra: Sequence[tuple[str, OrderLines, OrderLines]], shaft: str, multiple: float, ratio: float, label: str
) -> ShaftChange | None:
    """The change of one line of a test in the channel where it grew most; None where no channel has it."""
    rows = _growths(spectra, multiple * ratio)
    if not rows:
        return None
    channel, growth = max(rows, key=lambda row: row[1])
    return ShaftChange(
        shaft=shaft,
        multiple=multiple,
        order=multiple * ratio,
        channel=channel,
        growth_db=growth,
        median_db=float(np.median([g for _, g in rows])),
        label=label,
    )


def _growths(spectra: Sequence[tuple[str, OrderLines, OrderLines]], order: float) -> list[tuple[str, float]]:
    rows = [
        (channel, float(line_growth(now, before, np.array([order]), MATERIAL_DB)[0]))
        for channel, now, before in spectra
    ]
    return [row for row in rows if np.isfinite(row[1])]


def impulsiveness(test: Observation, baselines: Sequence[Observation]) -> Impulsiveness | None:
    """The band whose kurtosis grew most."""
    best: Impulsiveness | None = None
    for e in test.channels:
        now = e.kurtosis
        before = [other.kurtosis for b in baselines if (other := b.channel(e.channel)) is not None]
        fitting = [b for b in before if b.shape == now.shape]
        reference = np.max(np.stack(fitting), axis=0) if fitting else None
        score = now if reference is None else now - KURTOSIS_RATIO * reference
        band = int(np.argmax(score))
        one = Impulsiveness(
            channel=e.channel,
            now=float(now[band]),
            before=None if reference is None else float(reference[band]),
            band_hz=(float(e.bands_hz[band, 0]), float(e.bands_hz[band, 1])),
            label=test.label,
        )
        if best is None or (one.grown, one.now) > (best.grown, best.now):
            best = one
    return best


def grown_impacts(tests: Sequence[Observation], baselines: Sequence[Observation]) -> Impulsiveness | None:
    """Impulsiveness that grew in most of the tests."""
    found = [x for t in tests if (x := impulsiveness(t, baselines)) is not None]
    risen = [x for x in found if x.grown]
    return max(risen, key=lambda x: x.now) if 2 * len(risen) > len(tests) else None
