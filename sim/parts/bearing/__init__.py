"""Rolling bearings: geometry, kinematic orders, Hertz contact, static ball loads, catalogue."""

from sim.parts.bearing.ball_load import BallLoads, BallRow, mean_stiffness_n_per_m, static_equilibrium
from sim.parts.bearing.catalogue import CatalogueRow, catalogue, lookup, missing
from sim.parts.bearing.frequencies import BearingSpeeds, bearing_speeds, defect_orders
from sim.parts.bearing.from_spec import geometry_from_ball_spec, geometry_from_spec
from sim.parts.bearing.geometry import RollingGeometry, from_diameters
from sim.parts.bearing.hertz import STEEL, Elasticity, ball_race_stiffness_n_per_m15
from sim.parts.bearing.palmgren import (
    line_coefficient_n_per_m109,
    line_force_n,
    line_penetration_m,
    line_tangent_n_per_m,
)

__all__ = [
    "STEEL",
    "BallLoads",
    "BallRow",
    "BearingSpeeds",
    "CatalogueRow",
    "Elasticity",
    "RollingGeometry",
    "ball_race_stiffness_n_per_m15",
    "bearing_speeds",
    "catalogue",
    "defect_orders",
    "from_diameters",
    "geometry_from_ball_spec",
    "geometry_from_spec",
    "line_coefficient_n_per_m109",
    "line_force_n",
    "line_penetration_m",
    "line_tangent_n_per_m",
    "lookup",
    "mean_stiffness_n_per_m",
    "missing",
    "static_equilibrium",
]
