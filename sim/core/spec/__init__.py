"""The machine specification: what a caller writes, validated once, frozen afterwards. All values SI."""

from sim.core.spec.base import SCHEMA_VERSION, Name, SpecModel
from sim.core.spec.bearings import BallGeometry, BearingSpec, ResonatorSpec, SupportSpec
from sim.core.spec.custom import CustomLaw, ForceTable
from sim.core.spec.gears import GearSpec, MeshSpec, MeshTable, TransmissionError
from sim.core.spec.machine import MachineSpec
from sim.core.spec.operating import (
    FluctuatingSpeed,
    ForceLoad,
    LoadSpec,
    MeasuredLoad,
    MeasuredSpeed,
    OperatingSpec,
    RampSpeed,
    SpeedProfile,
    TermSpec,
    TorqueLoad,
)
from sim.core.spec.shafts import BodySpec, ShaftSegment, ShaftSpec

__all__ = [
    "SCHEMA_VERSION",
    "BallGeometry",
    "BearingSpec",
    "BodySpec",
    "CustomLaw",
    "FluctuatingSpeed",
    "ForceLoad",
    "ForceTable",
    "GearSpec",
    "LoadSpec",
    "MachineSpec",
    "MeasuredLoad",
    "MeasuredSpeed",
    "MeshSpec",
    "MeshTable",
    "Name",
    "OperatingSpec",
    "RampSpeed",
    "ResonatorSpec",
    "ShaftSegment",
    "ShaftSpec",
    "SpecModel",
    "SpeedProfile",
    "SupportSpec",
    "TermSpec",
    "TorqueLoad",
    "TransmissionError",
]
