"""What sounds beside the model of a machine: drawn once a machine, added to the motion before the measurement chain.

A block's defaults are the ranges that the sim-to-real classifier is trained with (docs/sim2real.md); a block that is
not given is off. Values are drawn at random by the recipe's seed, not at the points of its plan.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated

from pydantic import AfterValidator, Field

from sideband_datasets.recipe.values import Choice, Factor, Range, Value
from sim.core.spec import SpecModel


def _log(low: float, high: float) -> Range:
    return Range(low=low, high=high, scale="log")


def _even(low: float, high: float) -> Range:
    return Range(low=low, high=high)


def _within(low: float, high: float) -> Callable[[Value], Value]:
    def check(value: Value) -> Value:
        if isinstance(value, Factor):
            raise ValueError("a factor has nothing to multiply here: give `low` and `high`")
        items = value.choices if isinstance(value, Choice) else ()
        ends = (value.low, value.high) if isinstance(value, Range) else items or (value,)
        for end in ends:
            if isinstance(end, bool | str) or not isinstance(end, int | float) or not low <= end <= high:
                raise ValueError(f"needs numbers from {low:g} to {high:g}")
        return value

    return check


Depth = Annotated[Value, AfterValidator(_within(0.0, 1.0))]
Ratio = Annotated[Value, AfterValidator(_within(0.0, 1e6))]
Order = Annotated[Value, AfterValidator(_within(1e-3, 1e3))]
Time = Annotated[Value, AfterValidator(_within(1e-4, 1e3))]
Number = Annotated[Value, AfterValidator(_within(-100.0, 100.0))]
Count = Annotated[Value, AfterValidator(_within(1.0, 20.0))]
Share = Annotated[float, Field(ge=0, le=1)]


class Rolling(SpecModel):
    """Noise of rough surfaces, whose power follows load and passing balls (Antoni & Randall, J. Vib. Acoust. 125 (2003)
    282-289): depths from 0, steady, to 1."""

    share: Share = 1.0
    """Of the machines that have it."""
    level: Ratio = _log(0.03, 3.0)
    """RMS, in levels."""
    shaft: Depth = _log(0.01, 0.6)
    twice_shaft: Depth = _log(0.01, 0.4)
    outer: Depth = _log(0.01, 0.5)
    """At the ball pass frequency of the outer race of the bearing where the sensor sits; `inner` likewise."""
    inner: Depth = _log(0.01, 0.4)
    ball: Depth = _log(0.01, 0.3)
    """At twice the ball spin frequency."""
    cage: Depth = _log(0.01, 0.4)
    foreign: Depth = _log(0.01, 0.3)
    """At a line that is none of the machine's."""
    foreign_order: Order = _log(0.5, 12.0)
    """Its place, per turn of the driven shaft."""


class Knocks(SpecModel):
    """Impulses at random times: dirt, rough lubrication, play."""

    share: Share = 0.6
    level: Ratio = _log(0.1, 3.0)
    """RMS, in levels."""
    per_s: Ratio = _log(0.2, 500.0)
    """How many a second."""


class Neighbours(SpecModel):
    """Regular impulses of something else: another bearing, a gear, a belt, an inverter."""

    share: Share = 0.4
    level: Ratio = _log(0.03, 1.5)
    """RMS of all together, in levels."""
    trains: Count = Choice(choices=(1.0, 2.0, 3.0))
    """How many; what follows is drawn for each."""
    order: Order = _log(0.3, 13.0)
    """Impulses per turn of the driven shaft."""
    slip: Ratio = _log(1e-4, 0.02)
    """RMS step of their random walk, in periods."""
    swing: Depth = _even(0.0, 0.5)
    """How far their height goes up and down, ..."""
    slow: Ratio = _even(0.02, 0.5)
    """... so often an impulse."""
    size: Ratio = _log(0.1, 1.0)
    """Relative to the other trains."""


class FreeAxis(SpecModel):
    """The axis of a ball is held by friction only: its spin slips from one turn of the cage to the next, and its spall
    leaves the rolling track for a while. Acts on what a fault adds that is a ball's spall and nothing else."""

    share: Share = 1.0
    stay_s: Time = _log(0.02, 1.0)
    """How long the spall stays in or beside the track, about."""
    slip: Ratio = _log(0.01, 1.0)
    """RMS shift of the impacts between turns of the cage, in turns of the ball."""
    inside: Number = _even(-2.0, 5.0)
    """Where the spall is on average, in widths of the track's edge; above 0 inside. It wanders by 3 (RMS)."""


class Background(SpecModel):
    """Every accelerometer hears it, at the level of the machine's own motion times a drawn number.

    The level of a recording is the RMS acceleration of the same machine without the fault (mean of all outputs in x and
    y) times `level`. So the machine is simulated without the fault too, and no level tells of a fault.
    """

    level: Ratio = _log(1.0, 30.0)
    rolling: Rolling | None = None
    knocks: Knocks | None = None
    neighbours: Neighbours | None = None
    free_axis: FreeAxis | None = None
    chain_in_levels: bool = False
    """The chain's noise, hum, limits and ranges are multiples of the level too, whatever the machine moves by."""
