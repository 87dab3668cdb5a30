"""Strong lines of the signal itself that the baseline has not, and that neither teeth nor a shaft's first turns make.

Whirl of an oil film, a belt, a fan of the next machine, vanes that pass, a resonance that is driven: envelopes and a
shaft's first three multiples show none of them. What is told is the line, and whose frequency it is, not its cause.
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
from reconcile.shares import percent
from reconcile.speed.excess import EXPONENTIAL_MEDIAN, mains_bins, running_median
from reconcile.verdict import LineChange, NextExperiment, Report, Where
from signals.series import FloatArray
from signals.spectra.amplitude import amplitude_spectrum

LOUDER = "louder than in the baseline, and no family of lines"
"""What is said where a channel is, whatever its lines are."""
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
ON_SHAFT = 0.001
"""Share of the order, beside what the speed may be off, up to which it is told as that multiple: seven times an outer
race (25.09 turns) lies near 25, and no vanes make it."""
PEAK_BINS = 4
"""A line is the highest of so many bins on either side: what lies nearer to a higher one is its foot."""
FIRST = 3
"""Multiples of a shaft up to which unbalance, misalignment and looseness are told by their own rule."""
CROWDED = 0.25
"""Share of a shaft's order from which on any line is near a multiple of it, which says nothing."""
HALVES = 10.0
"""Multiples of a shaft up to which half ones are looked at."""
SIDEBANDS = 3
"""Pairs of sidebands of a mesh that are the teeth's."""
BEARING_MULTIPLES = 4
WAVY = "a wavy ring or balls that differ"
NO_PART = "No part of the specification makes it."
LOWEST_BINS = 6
SAME = 0.01
"""Share by which lines of one train may miss a multiple of the lowest."""
LOWEST = 0.2
"""Order: below are drift and what the structure sways."""
MOST = 4
PEAKS = 40
WHIRL = (0.38, 0.49)
"""Times a shaft's speed at which a journal bearing whirls; looseness and rubs make subharmonics there too."""
PARTS = {"outer": "the outer race", "inner": "the inner race", "ball": "the balls", "cage": "the cage"}
TONAL = ("fixed_tones", "alias", "mains_hum")
AGAIN = NextExperiment(sentence="Record at another speed: it tells whether the line moves with the shaft.")


@dataclass(frozen=True, kw_only=True)
class NewLine:
    """A line of a channel: frequency, growth over the baseline, share of the channel's power.

    `multiple`: of which shaft it is which whole or half multiple; `bearing`: whose frequency it is, in words.
    """

    hz: float
    order: float
    channel: str
    growth_db: float
    share: float
    speed_hz: float
    multiple: tuple[str, float] | None = None
    bearing: str = ""

    @property
    def open(self) -> bool:
        """Whether what is outside the specification may make it as well."""
        return not self.bearing and (self.multiple is None or not self.multiple[1].is_integer())

    @property
    def made_by(self) -> str:
        """What of the specification has this frequency, or what makes such a line, in a sentence."""
        if self.bearing:
            what = "balls that differ or a cage out of balance" if "the cage" in self.bearing else WAVY
            return (
                f"It is at {self.bearing}: {what} make such a line without impacts, another source there looks alike."
            )
        if self.multiple is None:
            return NO_PART
        shaft, number = self.multiple
        if number.is_integer():
            return (
                f"What has {number:.0f} vanes, blades, jaws or poles on {shaft} makes it; the specification has none."
            )
        return f"Looseness or a rub makes such half multiples of the speed of {shaft}."


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
    cause = f" {likely_cause(first.order, ties)}" if first.open else ""
    return replace(
        report,
        verdict="not_decidable" if first.bearing else "unknown_physics",
        sentence=f"A line at {first.hz:.4g} Hz, {first.order:.3g} times the speed of {ties.reference}, is new on "
        f"{channels}{more}: {size} {strongest.channel}. {first.made_by}{cause}",
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
    peak &= ~(mains_bins(power.size, step) | (np.arange(power.size) < max(LOWEST_BINS, LOWEST * speed / step)))
    rows: list[NewLine] = []
    for place in np.argsort(-np.where(peak, power, 0.0))[: min(PEAKS, int(peak.sum()))]:
        hz = _middle(over, int(place)) * step
        if len(rows) == MOST or any(_one_line(hz, one.hz, step) for one in rows):
            continue
        own, around = (_within(over, hz, step, width) for width in (WIDTH, AROUND))
        places = (hz, hz / speed * base.speed.speed_hz)
        had = max(*(_within(before, at, old_step, BASE_WIDTH) for at in places), 1e-300)
        growth = 10 * float(np.log10(max(own, 1e-300) / had))
        if own < SHARE * total or own < NARROW * around or growth < GROWTH_DB:
            continue
        whose = _whose(hz / speed, step / speed, test.doubt, ties)
        if whose is not None:
            line = NewLine(hz=hz, order=hz / speed, channel=name, growth_db=growth, share=own / total, speed_hz=speed)
            rows.append(replace(line, multiple=whose[0], bearing=whose[1]))
    return rows


def _spectrum(one: Observation, name: str) -> tuple[FloatArray, FloatArray, float]:
    """(power of the bins, of the noise under them, resolution in Hz)."""
    spectrum = amplitude_spectrum(one.recording.series(name))
    power = np.asarray(spectrum.values**2, dtype=np.float64)
    return power, running_median(power) / EXPONENTIAL_MEDIAN, spectrum.resolution_hz


def _whose(order: float, bin_order: float, doubt: float, ties: Ties) -> tuple[tuple[str, float] | None, str] | None:
    """The whole multiple of a shaft that a line is, or whose frequency of a bearing it is; None for what other rules
    tell: teeth with their sidebands, first turns of a shaft, and where any line is near a multiple."""
    near, at = (max(OFF_BINS * bin_order, (share + doubt) * order) for share in (OFF_SHAFT, ON_SHAFT))
    for mesh in ties.mesh_orders:
        for ratio in ties.shafts.values():
            away = abs(order - max(1, round(order / mesh)) * mesh) / ratio
            if away < SIDEBANDS + 0.5 and abs(away - round(away)) * ratio < near:
                return None
    found: tuple[str, float] | None = None
    for shaft, ratio in ties.shafts.items():
        number = round(2.0 * order / ratio) / 2.0
        if abs(order - number * ratio) >= near or (number > HALVES and not number.is_integer()):
            continue
        if (0 < number <= FIRST and (number.is_integer() or number < 1.0)) or near > CROWDED * ratio:
            return None
        if abs(order - number * ratio) < at:
            found = found or (shaft, number)
    return found, _bearing(order, near, ties) if found is None else ""


def _bearing(order: float, near: float, ties: Ties) -> str:
    """Whose frequency a line is nearest to."""
    hits = [
        (k, f)
        for f in ties.families
        for k in range(1, BEARING_MULTIPLES + 1)
        if f.kind in PARTS and abs(order - k * f.order) < near + k * f.slip * f.order
    ]
    if not hits:
        return ""
    k, family = min(hits, key=lambda hit: abs(order / (hit[0] * hit[1].order) - 1.0))
    return f"{'' if k == 1 else f'{k} times '}the frequency of {PARTS[family.kind]} of {family.site}"


def _middle(power: FloatArray, place: int) -> float:
    """Where the power of a line lies, in bins."""
    bins = np.arange(max(place - 2, 0), min(place + 3, power.size))
    return float(np.sum(bins * power[bins]) / max(float(np.sum(power[bins])), 1e-300))


def _within(power: FloatArray, hz: float, step: float, width: float) -> float:
    middle, reach = round(hz / step), max(2, round(width * hz / step))
    return float(np.sum(power[max(middle - reach, 0) : middle + reach + 1]))
