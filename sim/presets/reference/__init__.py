"""Machines from flat parameter files: the names of the 28-DOF reference solutions, mapped to a composed machine."""

from sim.presets.reference.build import ReferenceMachine, machine_from_reference, reference_machine
from sim.presets.reference.names import KEYS, Key

__all__ = ["KEYS", "Key", "ReferenceMachine", "machine_from_reference", "reference_machine"]
