"""Where a sensor sits: which degrees of freedom it sees, with which direction cosines."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Self

from pydantic import Field, model_validator

from sim.core.errors import Problem, SpecError
from sim.core.near import near
from sim.core.spec import SpecModel

ChannelName = Annotated[str, Field(min_length=1, max_length=120, pattern=r"^[A-Za-z0-9_.-]+$")]
NEGLIGIBLE = 1e-12
"""Direction cosines below this are rounding of a right angle."""


class MixEntry(SpecModel):
    """One output of the simulation and its weight."""

    channel: ChannelName
    factor: Annotated[float, Field(ge=-1e12, le=1e12)] = 1.0


class Place(SpecModel):
    """A part and a direction, or a free mix of outputs."""

    location: Annotated[str, Field(min_length=1, max_length=80, pattern=r"^[a-z0-9_.]+$")] | None = None
    """A part with motion: `bearing1.outer`, `bearing1.housing`, `resonator1`, `pinion`."""
    direction_deg: Annotated[float, Field(ge=-360, le=360)] | None = None
    """Sensitive axis in the plane of the shaft's section: 0 is +x, 90 is +y (90 unless given)."""
    relative_to: Annotated[str, Field(min_length=1, max_length=80, pattern=r"^[a-z0-9_.]+$")] | None = None
    """A part whose motion is subtracted: a probe fixed to a housing sees the shaft relative to it."""
    mix: Annotated[list[MixEntry], Field(min_length=1, max_length=32)] | None = None
    """Weighted outputs instead of a part: several parts that one structure carries, or channels of a recording."""

    @model_validator(mode="after")
    def _one_form(self) -> Self:
        if (self.location is None) == (self.mix is None):
            raise ValueError("give exactly one of `location` and `mix`")
        if self.mix is not None and (self.relative_to is not None or self.direction_deg is not None):
            raise ValueError("`direction_deg` and `relative_to` belong to `location`; a mix has its factors")
        return self


@dataclass(frozen=True, kw_only=True)
class Pickup:
    """What a sensor sees: sum of factor times channel. `axis` is empty where the direction is oblique."""

    factors: Mapping[str, float]
    location: str
    axis: str


def pickup_at(place: Place, quantity: str, known: Mapping[str, str], field: str) -> Pickup:
    """Channels and weights for a sensor of `quantity`; `known` is the quantity of every output by its name.

    SpecError names what the machine has when it does not have what is asked.
    """
    if place.mix is not None:
        return _mixed(place.mix, quantity, known, field)
    assert place.location is not None
    angle = math.radians(90.0 if place.direction_deg is None else place.direction_deg)
    cosines = {"x": math.cos(angle), "y": math.sin(angle)}
    factors: dict[str, float] = {}
    for part, sign, name in ((place.location, 1.0, "location"), (place.relative_to, -1.0, "relative_to")):
        if part is None:
            continue
        _check_part(part, quantity, known, f"{field}.{name}")
        for axis, cosine in cosines.items():
            channel = f"{part}.{axis}.{quantity}"
            if abs(cosine) < NEGLIGIBLE:
                continue
            if channel not in known:
                raise SpecError(_no_axis(part, axis, quantity, known, field))
            factors[channel] = factors.get(channel, 0.0) + sign * cosine
    along = [axis for axis, cosine in cosines.items() if abs(abs(cosine) - 1.0) < NEGLIGIBLE]
    return Pickup(factors=factors, location=place.location, axis=along[0] if along else "")


def _mixed(mix: list[MixEntry], quantity: str, known: Mapping[str, str], field: str) -> Pickup:
    problems, factors = [], dict[str, float]()
    for i, entry in enumerate(mix):
        at = f"{field}.mix.{i}.channel"
        if entry.channel not in known:
            alike = near(entry.channel, known, most=3) or list(known)[:3]
            message = "is not an output of this machine"
            allowed = f"{', '.join(alike)} ... ({len(known)} in all)"
            problems.append(Problem(field=at, message=message, given=entry.channel, allowed=allowed))
        elif known[entry.channel] != quantity:
            message = f"is a channel of {known[entry.channel]}; this sensor measures {quantity}"
            allowed = f"outputs of {quantity}"
            problems.append(Problem(field=at, message=message, given=entry.channel, allowed=allowed))
        factors[entry.channel] = factors.get(entry.channel, 0.0) + entry.factor
    if problems:
        raise SpecError(problems)
    return Pickup(factors=factors, location="mix", axis="")


def _parts(quantity: str, known: Mapping[str, str]) -> dict[str, list[str]]:
    """Axes of every part that moves in x or y."""
    found: dict[str, list[str]] = {}
    for name, kind in known.items():
        stem = name.removesuffix(f".{quantity}")
        if kind == quantity and stem != name and stem[-2:] in (".x", ".y"):
            found.setdefault(stem[:-2], []).append(stem[-1])
    return found


def _check_part(part: str, quantity: str, known: Mapping[str, str], field: str) -> None:
    parts = _parts(quantity, known)
    if part not in parts:
        message = f"is no part of this machine with {quantity} in x or y"
        allowed = ", ".join(parts) or "none: nothing moves in x or y"
        raise SpecError(Problem(field=field, message=message, given=part, allowed=allowed))


def _no_axis(part: str, axis: str, quantity: str, known: Mapping[str, str], field: str) -> Problem:
    has = _parts(quantity, known)[part]
    allowed = " or ".join({"x": "0 or 180", "y": "90 or -90"}[a] for a in has)
    message = f"{part} does not move along {axis} in this model"
    return Problem(field=f"{field}.direction_deg", message=message, given=f"along {axis}", allowed=allowed, unit="deg")
