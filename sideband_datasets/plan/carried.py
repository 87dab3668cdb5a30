"""Whether the recordings of a class can carry the lines of its fault at their sampling rate."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from sideband_datasets.plan.drawing import Drawing, Effect
from sideband_datasets.recipe.model import Recipe
from sideband_datasets.recipe.values import most
from signals.sensors.clock import nominal_rate_hz
from sim.core.errors import Problem, SpecError
from sim.core.system import System

HARMONICS = 3
"""Of a fault that recordings should have, where it gives so many."""


@dataclass(frozen=True, kw_only=True)
class _Needed:
    """The effect of a class with the highest lines: its lowest and its third, and the rate of the recording."""

    effect: str
    first_hz: float
    third_hz: float
    rate_hz: float
    field: str


def told_of_rates(recipe: Recipe, found: Sequence[tuple[Drawing, System]]) -> list[str]:
    """Warnings of classes with less than three harmonics below half the sampling rate, at the highest speed.

    `found`: a recording of every class and family with its machine. SpecError for a class with no line below it.
    """
    needed: dict[str, _Needed] = {}
    for drawn, system in found:
        for one in _needed(recipe, drawn, system):
            before = needed.get(drawn.fault_type)
            if before is None or one.third_hz / one.rate_hz > before.third_hz / before.rate_hz:
                needed[drawn.fault_type] = one
    problems = [_refused(name, one) for name, one in needed.items() if one.first_hz >= one.rate_hz / 2]
    if problems:
        raise SpecError(problems)
    return [_warned(name, one) for name, one in needed.items() if one.third_hz >= one.rate_hz / 2]


def _needed(recipe: Recipe, drawn: Drawing, system: System) -> Iterator[_Needed]:
    rate, field = recipe.sampling_rate_hz, "sampling_rate_hz"
    if drawn.chain is not None and nominal_rate_hz(drawn.chain.clock, rate, field) < rate:
        rate = nominal_rate_hz(drawn.chain.clock, rate, field)
        field = "measurement.chain.clock.sampling_rate_hz"
    own = drawn.spec.operating.speed_hz if drawn.spec.operating is not None else None
    highest = most(recipe.speeds_hz) if recipe.speeds_hz is not None else own
    faster = highest / own if highest and own else 1.0
    for effect in drawn.effects:
        lines = [faster * hz for hz in _lines_hz(effect, system)]
        if lines:
            third = lines[min(HARMONICS, len(lines)) - 1]
            yield _Needed(effect=effect.label, first_hz=lines[0], third_hz=third, rate_hz=rate, field=field)


def _lines_hz(effect: Effect, system: System) -> list[float]:
    """Harmonics of what the effect repeats at, without sidebands where it has lines without; from the lowest on."""
    own = [line for line in system.lines if (line.mechanism, line.component) == (effect.term, effect.site)]
    plain = [line for line in own if len(line.orders) == 1]
    return sorted(hz for line in plain or own if (hz := line.frequency_hz(system.bases_hz)) > 0)


def _refused(name: str, one: _Needed) -> Problem:
    return Problem(
        field=one.field,
        message=f"cannot carry class {name}: the lowest line of {one.effect} is at {one.first_hz:.4g} Hz at the "
        f"highest speed of its first machine, above half the rate (`allowed` carries {HARMONICS} harmonics)",
        given=one.rate_hz,
        allowed=f">= {math.ceil(2.0 * one.third_hz * 1.01)}",
        unit="Hz",
    )


def _warned(name: str, one: _Needed) -> str:
    return (
        f"class {name}: {one.field} {one.rate_hz:g} Hz carries fewer than {HARMONICS} harmonics of {one.effect}, whose "
        f"lowest is at {one.first_hz:.4g} Hz; {math.ceil(2.0 * one.third_hz * 1.01)} Hz or more would"
    )
