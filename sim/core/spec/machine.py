"""The whole machine."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from sim.core.spec.base import MAX_ITEMS, SpecModel
from sim.core.spec.bearings import BearingSpec, ResonatorSpec
from sim.core.spec.custom import CustomLaw
from sim.core.spec.gears import GearSpec, MeshSpec
from sim.core.spec.operating import LoadSpec, OperatingSpec, TermSpec
from sim.core.spec.shafts import BodySpec, ShaftSpec


class MachineSpec(SpecModel):
    """A composed machine. Cross references are checked at assembly, where every index is checked too."""

    schema_version: Literal[1] = 1
    name: Annotated[str, Field(min_length=1, max_length=80)]
    notes: Annotated[str, Field(max_length=2000)] = ""
    shafts: Annotated[list[ShaftSpec], Field(max_length=MAX_ITEMS)] = Field(default_factory=list)
    gears: Annotated[list[GearSpec], Field(max_length=MAX_ITEMS)] = Field(default_factory=list)
    bodies: Annotated[list[BodySpec], Field(max_length=MAX_ITEMS)] = Field(default_factory=list)
    meshes: Annotated[list[MeshSpec], Field(max_length=MAX_ITEMS)] = Field(default_factory=list)
    bearings: Annotated[list[BearingSpec], Field(max_length=MAX_ITEMS)] = Field(default_factory=list)
    resonators: Annotated[list[ResonatorSpec], Field(max_length=MAX_ITEMS)] = Field(default_factory=list)
    loads: Annotated[list[LoadSpec], Field(max_length=MAX_ITEMS)] = Field(default_factory=list)
    gravity_m_per_s2: Annotated[float, Field(ge=0, le=100)] = 0.0
    """Along -y on every body, ring and resonator."""
    operating: OperatingSpec | None = None
    """Needed by any machine with shafts."""
    terms: Annotated[list[TermSpec], Field(max_length=4 * MAX_ITEMS)] = Field(default_factory=list)
    custom_laws: Annotated[list[CustomLaw], Field(max_length=MAX_ITEMS)] = Field(default_factory=list)
    """Force laws of the user's own, numbered from 1; each acts where a term `custom_force` names its number."""
