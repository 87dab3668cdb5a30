"""Stored numbers into SI: by the channel's unit, and by the sensor's sensitivity where volts were stored."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from signals.ingest.description import ChannelEntry, Sensitivity
from signals.series import FloatArray
from signals.units import ELECTRICAL, Unit, find_unit, unit_of, units_of
from sim.core.errors import Problem, SpecError
from sim.core.near import near
from sim.core.response import Channel

CHECKED = frozenset({"acceleration", "velocity", "displacement", "force", "torque", "pressure"})
"""Quantities whose unit must be one of theirs. Volts and uncalibrated numbers may stand for any of them."""
MISSPELT, SHORT = 0.88, 3
"""Likeness of another word to one of them, and letters of its beginning, from which that one is meant."""
_FREE = frozenset({"", ELECTRICAL})
_SENSITIVITY = re.compile(r"^\s*(?P<out>[^/\s]+)\s*(?:/|\s+per\s+)\s*(?P<per>.+?)\s*$")
_SAME = 1e-9


@dataclass(frozen=True, kw_only=True)
class Scale:
    """SI samples are stored ones x `factor` + `offset`."""

    channel: Channel
    factor: float
    offset: float

    def apply(self, stored: FloatArray) -> FloatArray:
        """The samples in the channel's unit, shape as given."""
        return stored * self.factor + self.offset


def scales_of(entries: Sequence[ChannelEntry], units_in_file: Sequence[str]) -> list[Scale]:
    """How each channel's numbers are read; SpecError names every channel with an unknown or contradicting unit."""
    found: list[Scale] = []
    problems: list[Problem] = []
    for i, (entry, unit) in enumerate(zip(entries, units_in_file, strict=True)):
        try:
            found.append(scale_of(entry, unit, f"channels.{i}"))
        except SpecError as error:
            problems += error.problems
    if problems:
        raise SpecError(problems)
    return found


def scale_of(entry: ChannelEntry, unit_in_file: str, field: str) -> Scale:
    """How a channel's numbers are read; SpecError for an unknown or contradicting unit."""
    unit = unit_of(entry.unit, f"{field}.unit")
    _check_file(entry, unit, unit_in_file, field)
    if unit.quantity == ELECTRICAL and entry.sensitivity is not None:
        unit = _sensed(unit, entry.sensitivity, field)
    wanted = _wanted(entry)
    if wanted in CHECKED and unit.quantity not in _FREE and unit.quantity != wanted:
        message = f"{entry.unit} is a unit of {unit.quantity.replace('_', ' ')}, not of the quantity stated"
        allowed = f"{unit.quantity}, or a unit of {wanted}: {', '.join(units_of(wanted))}"
        raise SpecError(Problem(field=f"{field}.quantity", message=message, given=entry.quantity, allowed=allowed))
    meant = _meant(wanted)
    if meant is not None:
        message = f"is not a known quantity (did you mean {meant}?)"
        raise SpecError(Problem(field=f"{field}.quantity", message=message, given=entry.quantity, allowed=meant))
    channel = Channel(
        name=entry.name,
        quantity=wanted if wanted in CHECKED else entry.quantity or unit.quantity,
        unit=unit.si,
        location=entry.location,
        axis=entry.axis,
    )
    return Scale(channel=channel, factor=unit.factor, offset=unit.offset)


def unsensed(entries: Sequence[ChannelEntry]) -> tuple[str, ...]:
    """What is to be said of channels that stay in volts though another quantity was measured: its levels are not known.

    Shapes and lines are those of the quantity all the same, so such channels are read.
    """
    return tuple(
        f"channels.{i}: {entry.name} is in {unit.si}: no sensitivity is stated, so levels are not {_levels(wanted)}"
        for i, entry in enumerate(entries)
        if (wanted := _wanted(entry)) in CHECKED
        and entry.sensitivity is None
        and (unit := unit_of(entry.unit, f"channels.{i}.unit")).quantity == ELECTRICAL
    )


def _meant(wanted: str) -> str | None:
    """The quantity that is checked and that a slip of the pen or a short form stands for."""
    if wanted in CHECKED or len(wanted) < SHORT:
        return None
    begun = [quantity for quantity in sorted(CHECKED) if quantity.startswith(wanted)]
    return next(iter(begun or near(wanted, sorted(CHECKED), most=1, like=MISSPELT)), None)


def _levels(quantity: str) -> str:
    return f"{quantity.removesuffix('y')}ies" if quantity.endswith("y") else f"{quantity}s"


def _wanted(entry: ChannelEntry) -> str:
    """The quantity that is stated, in one spelling."""
    return entry.quantity.strip().lower().replace(" ", "_")


def _check_file(entry: ChannelEntry, unit: Unit, unit_in_file: str, field: str) -> None:
    """The file's own unit, where it states one that is known, must be the one described."""
    inside = find_unit(unit_in_file) if unit_in_file else None
    # unscaled numbers may be described by what they stand for
    if inside is None or inside.quantity == "" or unit.quantity == "":
        return
    if inside.si != unit.si or abs(inside.factor - unit.factor) > _SAME * abs(unit.factor):
        message = "is not the unit that the file itself states"
        raise SpecError(Problem(field=f"{field}.unit", message=message, given=entry.unit, allowed=unit_in_file))


def _sensed(volts: Unit, sensitivity: Sensitivity | float, field: str) -> Unit:
    """The unit of stored volts behind a sensor: volts / (volts per unit sensed)."""
    form = 'as {"value": 100, "unit": "mV/g"}'
    if not isinstance(sensitivity, Sensitivity):
        message = "of a channel in volts must say its unit, which is never guessed"
        raise SpecError(Problem(field=f"{field}.sensitivity", message=message, given=sensitivity, allowed=form))
    parts = _SENSITIVITY.match(sensitivity.unit)
    out = find_unit(parts["out"]) if parts else None
    per = find_unit(parts["per"]) if parts else None
    if out is None or per is None or out.quantity != ELECTRICAL or per.offset:
        message = "is not a unit of volts per unit sensed"
        given = sensitivity.unit
        raise SpecError(Problem(field=f"{field}.sensitivity.unit", message=message, given=given, allowed=form))
    factor = volts.factor / (sensitivity.value * out.factor / per.factor)
    return Unit(si=per.si, factor=factor, quantity=per.quantity)
