"""Impacts exactly at a multiple of the supply's frequency: drives, rectifiers and discharges strike too.

A bearing's balls slip, so its rate is seldom a multiple of 50 or 60 Hz to a thousandth, and at another speed never the
same one. Where all that is known of a family lies there, it names no part; sidebands of the shaft or the cage about its
line are no supply's.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy import fft

from reconcile.kinematics.candidate import DEFECTS, LEAST_Z, Candidate
from reconcile.kinematics.contrast import band_turns
from reconcile.kinematics.envelopes import order_depth, squared_envelope
from reconcile.kinematics.evidence import Evidence
from reconcile.kinematics.families import Ties
from reconcile.kinematics.foreign import Foreign
from reconcile.kinematics.judge import named
from reconcile.kinematics.measured import measured_lines
from reconcile.kinematics.observe import Observation
from reconcile.speed.excess import power_over_floor
from reconcile.verdict import LineChange, NextExperiment, PlaceWeight, Report, SensorFault, Where
from signals.series import FloatArray

SUPPLIES_HZ = (50.0, 60.0)
MULTIPLES = 6
"""Six pulses a period are the most that common rectifiers make."""
SUPPLY = 0.001
"""Share by which a supply may be off. The lines of eleven measured defects of three rigs lie 1.2 % and more away from
the nearest multiple, made electric impacts 0.02 % at most."""
SEARCHED = 0.003
"""Share of a rate within which its line is looked for: the order as found is that of the comb's bins."""
HARMONICS = 4
PRESENT_DB = 12.0
LEAST_LINES = 2
SHARP, MAIN_LOBE, ABOUT = 0.8, 2, 0.01
"""Share of the power within `ABOUT` of a line that lies in its main lobe (bins to either side): 0.85 and more of made
electric impacts."""
SIDE_DEPTH = 0.15
"""Of a line's depth, that both lines of a pair beside it have at least where load or cage modulates it."""
OFF_SHAFT_BINS = 4.0
SAME_RATE = 0.05
"""Relative difference of speeds between which no bearing keeps its rate."""
AGAIN = NextExperiment(
    sentence="Record at another speed: what the supply makes stays at its rate, a bearing's moves with the shaft."
)


@dataclass(frozen=True, kw_only=True)
class Electric:
    """Impacts `rate_hz` times a second, a multiple of the supply's frequency, in the band where they are heard best."""

    rate_hz: float
    evidence: Evidence
    growth_db: float | None
    parts: tuple[str, ...]
    """Families (by key) whose own rate is as near."""


Supply = tuple[tuple[Candidate, float], ...]
"""Families at whose lines the supply's stand, each with that multiple, Hz."""


def of_supply(one: Candidate, tests: Sequence[Observation], ties: Ties) -> float | None:
    """The multiple of the supply's frequency, Hz, at which the family's lines stand in every test that hears them; else
    None."""
    if one.family.kind not in DEFECTS:
        return None
    heard = [(e, t) for e, t in zip(one.evidence, tests, strict=True) if e is one.best or e.z >= LEAST_Z]
    if any(_multiple(e, t) is None or _modulated(e, t, ties) for e, t in heard):
        return None
    return _multiple(one.best, tests[one.strongest])


def named_but_supply(
    tests: Sequence[Observation], baselines: Sequence[Observation], ties: Ties, seed: int
) -> tuple[tuple[Candidate, ...], tuple[Candidate, ...], Supply]:
    """(bearing defects that stand, all candidates, those of them that have the supply's lines): these stand for no
    part, and are held to be driven."""
    chosen, every = named(tests, baselines, ties, seed)
    supply = {c.family.key: (c, hz) for c in every if c.present and (hz := of_supply(c, tests, ties)) is not None}
    if not supply:
        return chosen, every, ()
    if any(c.family.key in supply for c in chosen):
        rest = tuple(f for f in ties.families if f.key not in supply)
        chosen, _, _ = named_but_supply(tests, baselines, replace(ties, families=rest), seed)
    marked = tuple(replace(c, driven=True) if c.family.key in supply else c for c in every)
    return chosen, marked, tuple(supply.values())


def electric(supply: Supply, based: bool) -> Electric | None:
    """What the supply makes, of the families whose lines it has: new over the baseline, if there is one."""
    own = [(c, hz) for c, hz in supply if c.risen or not based]
    if not own:
        return None
    first, rate_hz = max(own, key=lambda one: one[0].z)
    parts = tuple(c.family.key for c, _ in own)
    return Electric(rate_hz=rate_hz, evidence=first.best, growth_db=first.growth_db, parts=parts)


def electric_foreign(found: Foreign, test: Observation) -> Electric | None:
    """The same of impacts at an order of no part."""
    rate = _multiple(found.evidence, test)
    if rate is None:
        return None
    return Electric(rate_hz=rate, evidence=found.evidence, growth_db=found.growth_db, parts=())


def electric_report(found: Electric, tests: Sequence[Observation], baselines: Sequence[Observation]) -> Report:
    """No part is named: the supply does it, or, where a part has that rate at the only speed, it can't be told."""
    said = told(found)
    lines = _lines(found, tests, baselines)
    if not found.parts or _at_other_speeds(found, tests):
        why = "at more than one speed" if found.parts else "and no part of the specification has that rate"
        low, high = found.evidence.band_hz
        detail = f"impacts {found.rate_hz:g} times a second in {low:.0f}-{high:.0f} Hz"
        return Report(
            verdict="measurement_fault",
            sentence=f"{said}, {why}: a drive, a rectifier, a discharge or what else the supply shakes, not a bearing.",
            level="kinematics",
            where=Where(lines=lines),
            fault=SensorFault(kind="mains_hum", channel=found.evidence.channel, detail=detail),
            undecidable=("whether the sensor picks it up or something moves with the supply",),
            next_experiment=AGAIN,
        )
    parts = " and ".join(found.parts)
    sites = tuple(dict.fromkeys(p.rsplit(".", 1)[0] for p in found.parts))
    return Report(
        verdict="not_decidable",
        sentence=f"{said}: most likely electric (a drive, a rectifier, a discharge). The rate of {parts} lies as near "
        "at this speed, so a defect there can't be ruled out, but none is told: balls seldom keep to the supply.",
        level="kinematics",
        where=Where(sites=tuple(PlaceWeight(site=s, weight=1 / len(sites)) for s in sites), lines=lines),
        undecidable=(f"whether impacts {found.rate_hz:g} times a second are the supply's or of {parts}",),
        next_experiment=AGAIN,
    )


def told_beside(report: Report, found: Electric | None) -> Report:
    """Another answer, with what the supply makes beside it as a limit."""
    if found is None or report.next_experiment is AGAIN:
        return report
    said = f"{told(found)}: they are counted for no part"
    return replace(report, where=replace(report.where, limits=(*report.where.limits, said)))


def told(found: Electric) -> str:
    """What was heard."""
    low, high = found.evidence.band_hz
    growth = "" if found.growth_db is None else f", {found.growth_db:.0f} dB deeper than in the baseline,"
    return (
        f"Impacts in {low:.0f}-{high:.0f} Hz of {found.evidence.channel}{growth} come exactly {found.rate_hz:g} times "
        "a second, a multiple of the supply's frequency"
    )


def _lines(found: Electric, tests: Sequence[Observation], baselines: Sequence[Observation]) -> tuple[LineChange, ...]:
    wanted = [(f"{k * found.rate_hz:g} Hz", k * found.rate_hz / tests[0].speed.speed_hz) for k in (1, 2, 3)]
    return measured_lines(wanted, found.evidence.channel, found.evidence.band_hz, tests[0], baselines, "supply")


def _at_other_speeds(found: Electric, tests: Sequence[Observation]) -> bool:
    """Whether the same rate is heard at speeds between which no bearing keeps it."""
    speeds = [
        t.speed.speed_hz
        for t in tests
        if t.channel(found.evidence.channel) is not None
        and _multiple(replace(found.evidence, order=found.rate_hz / t.speed.speed_hz), t) == found.rate_hz
    ]
    return bool(speeds) and max(speeds) > (1 + SAME_RATE) * min(speeds)


def _multiple(e: Evidence, test: Observation) -> float | None:
    """The multiple of a supply's frequency at which all lines that are there stand, sharp; Hz."""
    series_rate = test.recording.sampling_rate_hz
    square, rate, _ = squared_envelope(test.white(e.channel), *e.band_hz, series_rate)
    power = np.abs(fft.rfft((square - np.mean(square)) * np.hanning(square.size))) ** 2
    excess, step = power_over_floor(power), rate / square.size
    rates = []
    for k in range(1, HARMONICS + 1):
        wanted = k * e.order * test.speed.speed_hz
        reach = max(MAIN_LOBE, int(np.ceil(SEARCHED * wanted / step)))
        middle = round(wanted / step)
        width = max(3 * MAIN_LOBE, int(ABOUT * wanted / step))
        if middle - reach - width < 1 or middle + reach + width >= power.size:
            break
        place = middle - reach + int(np.argmax(power[middle - reach : middle + reach + 1]))
        if excess[place] < 10 ** (PRESENT_DB / 10):
            continue
        if _in_main_lobe(power[place - width : place + width + 1], power[place] / excess[place]) < SHARP:
            return None
        rates.append((place + _off(power[place - 1 : place + 2])) * step / k)
    if len(rates) < LEAST_LINES:
        return None
    own = float(np.median(rates))
    nearest = min((m * s for s in SUPPLIES_HZ for m in range(1, MULTIPLES + 1)), key=lambda hz: abs(hz - own))
    return nearest if abs(own / nearest - 1.0) <= SUPPLY else None


def _in_main_lobe(power: FloatArray, floor: float) -> float:
    """Share of the power above the floor that lies in the main lobe of the line in the middle."""
    over = np.maximum(power - 2.0 * floor, 0.0)
    middle = power.size // 2
    lobe = np.sum(over[middle - MAIN_LOBE : middle + MAIN_LOBE + 1])
    return float(lobe / max(float(np.sum(over)), 1e-300))


def _off(three: FloatArray) -> float:
    """By which share of a bin a peak lies beside its largest bin: parabola through the logs."""
    a, b, c = np.log(np.maximum(three, 1e-300))
    return 0.0 if a + c >= 2 * b else float(np.clip(0.5 * (a - c) / (a - 2 * b + c), -0.5, 0.5))


def _modulated(e: Evidence, test: Observation, ties: Ties) -> bool:
    """Whether a pair of lines stands beside the first at the distance of a shaft or the bearing's cage."""
    depth, step = order_depth(*band_turns(test, e.channel, e.band_hz))
    excess = power_over_floor(depth**2)
    turns = tuple(ties.shafts.values())
    cages = [f.order for f in ties.families if f.key == f"{e.family.site}.cage"]

    def at(order: float) -> tuple[float, float]:
        place = round(order / step)
        part = slice(max(place - 2, 0), place + 3)
        return float(np.max(depth[part], initial=0.0)), float(np.max(excess[part], initial=0.0))

    own = at(e.order)[0]
    for distance in (*turns, *cages):
        sides = (e.order - distance, e.order + distance)
        of_shaft = any(abs(o - round(o / t) * t) < OFF_SHAFT_BINS * step for o in sides for t in turns)
        if sides[0] <= OFF_SHAFT_BINS * step or of_shaft:
            continue
        if all(d >= SIDE_DEPTH * own and x >= 10 ** (PRESENT_DB / 10) for d, x in map(at, sides)):
            return True
    return False
