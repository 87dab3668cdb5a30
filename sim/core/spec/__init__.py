"""The machine specification: what a caller writes, validated once, frozen afterwards. All values SI."""

from sim.core.spec.base import SCHEMA_VERSION, Name, SpecModel
from sim.core.spec.bearings import BallGeometry, BearingSpec, ResonatorSpec, SupportSpec
from sim.core.spec.custom import CustomLaw, ForceTable
from sim.core.spec.gears import GearSpec, MeshSpec, MeshTable, TransmissionError
from sim.core.spec.machine import MachineSpec
from sim.core.spec.operating import ForceLoad, LoadSpec, OperatingSpec, TermSpec, TorqueLoad
from sim.core.spec.shafts import BodySpec, ShaftSpec

__all__ = [
    "SCHEMA_VERSION",
    "BallGeometry",
    "BearingSpec",
    "BodySpec",
    "CustomLaw",
    "ForceLoad",
    "ForceTable",
    "GearSpec",
    "LoadSpec",
    "MachineSpec",
    "MeshSpec",
    "MeshTable",
    "Name",
    "OperatingSpec",
    "ResonatorSpec",
    "ShaftSpec",
    "SpecModel",
    "SupportSpec",
    "TermSpec",
    "TorqueLoad",
    "TransmissionError",
]
