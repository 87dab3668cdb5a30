"""Strong lines of the signal itself that the baseline has not, and that no multiple of a shaft explains.

Whirl of an oil film, a belt, a fan of the next machine, a resonance that is driven: envelopes and the shaft's multiples
show none of them. What is told is the line, not its cause.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.ndimage import maximum_filter1d

from reconcile.gate import Gate
from reconcile.kinematics.families import Ties
from reconcile.kinematics.lines import matched
from reconcile.kinematics.observe import Observation
from reconcile.kinematics.vague import LOUDER
from reconcile.shares import percent
from reconcile.speed.excess import EXPONENTIAL_MEDIAN, mains_bins, running_median
from reconcile.verdict import LineChange, NextExperiment, Report, Where
from signals.series import BoolArray, FloatArray
from signals.spectra.amplitude import amplitude_spectrum

GROWTH_DB, SHARE = 20.0, 0.1
"""Over the baseline, and of the channel's power. The made whirl, belt and tone grew by 34 to 53 dB. Of measured sound
recordings (two of a rig with eight sensors, halves of eleven of six rigs) no such line grew by more than 0.6 dB; in a
gearbox at four loads none is off the multiples of its slow shaft."""
CLEAR_DB = 15.0
WIDTH, BASE_WIDTH = 0.002, 0.004
"""Half widths of a line, share of its frequency, now and in the baseline."""
NARROW, AROUND = 0.7, 0.03
"""Share of the power within `AROUND` of it that is the line's: what a speed that wanders smears is none."""
OFF_SHAFT, OFF_BINS = 0.004, 1.2
"""A line whose middle is nearer to a multiple of a shaft, share of the order, or bins, is the shaft's: an exact
multiple lies within a third of a bin. With four bins two shafts left a third of all orders in records of two seconds.
"""
PEAK_BINS, FAMILY_BINS = 4, 4.0
"""A line is the highest of so many bins on either side: what lies nearer to a higher one is its foot; nearer than that
to a line of a bearing it may be the bearing's."""
LOWEST_BINS = 6
SAME = 0.01
"""Share by which lines of one train may miss a multiple of the lowest."""
LOWEST = 0.2
"""Order: below are drift and what the structure sways."""
MOST = 4
PEAKS = 40
WHIRL = (0.38, 0.49)
"""Times a shaft's speed at which a journal bearing whirls; looseness and rubs make subharmonics there too."""
TONAL = ("fixed_tones", "alias", "mains_hum")
AGAIN = NextExperiment(sentence="Record at another speed: it tells whether the line moves with the shaft.")


@dataclass(frozen=True, kw_only=True)
class NewLine:
    """A line of a channel: frequency, growth over the baseline, share of the channel's power."""

    hz: float
    order: float
    channel: str
    growth_db: float
    share: float
    speed_hz: float


def new_lines(tests: Sequence[Observation], baselines: Sequence[Observation], ties: Ties) -> tuple[NewLine, ...]:
    """The strongest ones of the first test that has any, where at least half of those with a baseline at their speed
    have; empty otherwise."""
    pairs = [(t, b) for t in tests if (b := matched(t, baselines)) is not None]
    found = [rows for t, b in pairs if (rows := lines_of_test(t, b, ties))]
    return found[0] if found and 2 * len(found) >= len(pairs) else ()


def with_new_lines(
    report: Report, gate: Gate, tests: Sequence[Observation], baselines: Sequence[Observation], ties: Ties
) -> Report:
    """The report that nothing is missing, or that something is louder, with what is new; `gate`: whose tones are told
    already."""
    if report.verdict != "nothing_missing" and LOUDER not in report.sentence:
        return report
    if gate.fault is not None and gate.fault.kind in TONAL:
        return report
    found = new_lines(tests, baselines, ties)
    return new_lines_report(report, found, ties) if found else report


def new_lines_report(report: Report, found: Sequence[NewLine], ties: Ties) -> Report:
    """The line with its frequency and order, and what makes such lines."""
    strongest, lowest = max(found, key=lambda one: one.share), min(found, key=lambda one: one.hz)
    first = lowest if all(_multiple(one.hz / lowest.hz) for one in found) else strongest
    channels = " and ".join(dict.fromkeys(one.channel for one in found))
    further = sorted({round(one.hz, 1) for one in found if abs(one.hz / first.hz - 1.0) > OFF_SHAFT})
    more = f" (with it {', '.join(f'{hz:.4g}' for hz in further)} Hz)" if further else ""
    size = f"{strongest.growth_db:.0f} dB above the baseline, {percent(strongest.share, 0)} of the power of"
    return replace(
        report,
        verdict="unknown_physics",
        sentence=f"A line at {first.hz:.4g} Hz, {first.order:.3g} times the speed of {ties.reference}, is new on "
        f"{channels}{more}: {size} {strongest.channel}. No part of the specification makes it. "
        f"{likely_cause(first.order, ties)}",
        where=Where(
            lines=tuple(
                LineChange(
                    label=f"order {one.order:.4g}",
                    frequency_hz=one.hz,
                    change_db=one.growth_db,
                    channel=one.channel,
                    locked_to="",
                    speed_hz=one.speed_hz,
                )
                for one in found
            ),
            limits=report.where.limits,
        ),
        undecidable=(f"what makes the line at {first.hz:.4g} Hz",),
        next_experiment=AGAIN,
    )


def _one_line(a: float, b: float, step: float) -> bool:
    return abs(a - b) < max(AROUND * b, PEAK_BINS * step)


def _multiple(ratio: float) -> bool:
    return abs(ratio / round(ratio) - 1.0) < SAME


def likely_cause(order: float, ties: Ties) -> str:
    """What makes lines at such an order of the reference shaft."""
    for shaft, ratio in ties.shafts.items():
        if WHIRL[0] <= order / ratio <= WHIRL[1]:
            return f"Whirl of a journal bearing, looseness or a rub of {shaft} make such a line below half its speed."
    return "A belt, another machine, a resonance or a tone of the electronics may."


def lines_of_test(test: Observation, base: Observation, ties: Ties) -> tuple[NewLine, ...]:
    """The new lines of one test against its baseline, of all channels that both have."""
    found: list[NewLine] = []
    for name in test.recording.names:
        if name in base.recording.names:
            found += _of_channel(test, base, name, ties)
    return tuple(found)


def _of_channel(test: Observation, base: Observation, name: str, ties: Ties) -> list[NewLine]:
    (power, floor, step), (before, _, old_step) = (_spectrum(o, name) for o in (test, base))
    speed = test.speed.speed_hz
    over = np.maximum(power - 2.0 * floor, 0.0)
    total = max(float(np.sum(power)), 1e-300)
    peak = (power == maximum_filter1d(power, 2 * PEAK_BINS + 1)) & (power > floor * 10 ** (CLEAR_DB / 10))
    peak &= ~_known(power.size, step, test, ties)
    rows: list[NewLine] = []
    for place in np.argsort(-np.where(peak, power, 0.0))[: min(PEAKS, int(peak.sum()))]:
        hz = _middle(over, int(place)) * step
        if len(rows) == MOST or any(_one_line(hz, one.hz, step) for one in rows) or _of_shaft(hz, step, test, ties):
            continue
        own, around = (_within(over, hz, step, width) for width in (WIDTH, AROUND))
        places = (hz, hz / speed * base.speed.speed_hz)
        had = max(*(_within(before, at, old_step, BASE_WIDTH) for at in places), 1e-300)
        growth = 10 * float(np.log10(max(own, 1e-300) / had))
        if own >= SHARE * total and own >= NARROW * around and growth >= GROWTH_DB:
            rows.append(
                NewLine(hz=hz, order=hz / speed, channel=name, growth_db=growth, share=own / total, speed_hz=speed)
            )
    return rows


def _spectrum(one: Observation, name: str) -> tuple[FloatArray, FloatArray, float]:
    """(power of the bins, of the noise under them, resolution in Hz)."""
    spectrum = amplitude_spectrum(one.recording.series(name))
    power = np.asarray(spectrum.values**2, dtype=np.float64)
    return power, running_median(power) / EXPONENTIAL_MEDIAN, spectrum.resolution_hz


def _of_shaft(hz: float, step: float, test: Observation, ties: Ties) -> bool:
    """Whether a line is a multiple of a shaft's speed, or half of it."""
    order = hz / test.speed.speed_hz
    near = max(OFF_BINS * step / test.speed.speed_hz, (OFF_SHAFT + test.doubt) * order)
    ratios = ties.shafts.values()
    return any(abs(order - round(order / r) * r) < near or abs(order - r / 2) < near for r in ratios)


def _known(size: int, step: float, test: Observation, ties: Ties) -> BoolArray:
    """Bins of the supply's multiples, of the first two lines of a bearing, and those too low to be a line."""
    order = np.arange(size) * step / test.speed.speed_hz
    near = np.maximum(FAMILY_BINS * step / test.speed.speed_hz, (OFF_SHAFT + test.doubt) * order)
    known = mains_bins(size, step) | (order < LOWEST)
    known[:LOWEST_BINS] = True
    for family in ties.families:
        for k in (1, 2) if family.kind in ("outer", "inner", "ball") else ():
            known |= np.abs(order - k * family.order) < near + k * family.slip * family.order
    return np.asarray(known, dtype=np.bool_)


def _middle(power: FloatArray, place: int) -> float:
    """Where the power of a line lies, in bins."""
    bins = np.arange(max(place - 2, 0), min(place + 3, power.size))
    return float(np.sum(bins * power[bins]) / max(float(np.sum(power[bins])), 1e-300))


def _within(power: FloatArray, hz: float, step: float, width: float) -> float:
    middle, reach = round(hz / step), max(2, round(width * hz / step))
    return float(np.sum(power[max(middle - reach, 0) : middle + reach + 1]))
