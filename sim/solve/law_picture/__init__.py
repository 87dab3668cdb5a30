"""Pictures of force laws: what an effect does to its machine, from the elements and laws that are simulated."""

from sim.solve.law_picture.panel import Axis, Curve, Panel
from sim.solve.law_picture.picture import built_in_picture, law_picture

__all__ = ["Axis", "Curve", "Panel", "built_in_picture", "law_picture"]
