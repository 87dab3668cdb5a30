"""Spur gears: involute geometry, contact along the path, tooth-pair stiffness by the potential-energy method."""

from sim.parts.gear.contact import ContactGeometry, standard_centre_distance_m
from sim.parts.gear.geometry import GearGeometry
from sim.parts.gear.pair import GearPair, RootModel
from sim.parts.gear.pair_table import InterpolationError, PairTable, build_pair_table, interpolation_error
from sim.parts.gear.summary import mesh_summary
from sim.parts.gear.total_table import TotalTable, total_table

__all__ = [
    "ContactGeometry",
    "GearGeometry",
    "GearPair",
    "InterpolationError",
    "PairTable",
    "RootModel",
    "TotalTable",
    "build_pair_table",
    "interpolation_error",
    "mesh_summary",
    "standard_centre_distance_m",
    "total_table",
]
