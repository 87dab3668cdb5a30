"""Flexible shafts: Timoshenko beam elements between the places where something sits."""

from sim.parts.shaft.beam import BeamElement, beam_element
from sim.parts.shaft.nodes import ShaftNodes, shaft_length_m, shaft_nodes, torsional_stiffness_nm_per_rad
from sim.parts.shaft.section import Section, section, shear_factor

__all__ = [
    "BeamElement",
    "Section",
    "ShaftNodes",
    "beam_element",
    "section",
    "shaft_length_m",
    "shaft_nodes",
    "shear_factor",
    "torsional_stiffness_nm_per_rad",
]
