"""Mass and inertia of a gear body: a disc of pitch radius with its bore."""

from __future__ import annotations

import math

from sim.core.spec import GearSpec


def annulus_mass_kg(gear: GearSpec) -> float:
    """Mass of a disc of pitch radius with its bore, kg."""
    radius = 0.5 * gear.module_m * gear.teeth
    bore = 0.3 * radius if gear.bore_radius_m is None else gear.bore_radius_m
    return math.pi * (radius**2 - bore**2) * gear.face_width_m * gear.density_kg_per_m3


def annulus_inertia_kg_m2(gear: GearSpec, mass_kg: float) -> float:
    """Polar inertia of that disc for a mass, kg m^2."""
    radius = 0.5 * gear.module_m * gear.teeth
    bore = 0.3 * radius if gear.bore_radius_m is None else gear.bore_radius_m
    return 0.5 * mass_kg * (radius**2 + bore**2)
