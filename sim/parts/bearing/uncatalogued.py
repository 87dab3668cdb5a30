"""A bearing that the catalogue does not have: what is near it, how many there are, and what else can be given."""

from __future__ import annotations

from sim.core.errors import Problem, UnknownName
from sim.core.near import near
from sim.parts.bearing.catalogue import bare, catalogue, cylindrical, lookup, missing

MOST_NEAR = 6
LIKE = 0.5


def uncatalogued(
    designation: str, field: str, otherwise: str = "balls with both diameters, or orders"
) -> Problem | None:
    """The problem with a designation that stands in `field`; None where the catalogue has it. `otherwise`: what else
    can be given."""
    try:
        lookup(designation)
    except UnknownName:
        reason = missing().get(bare(designation))
        message = "is not in the catalogue of bearings" + (f" (left out: {reason})" if reason else "")
        names = list(catalogue())
        if cylindrical(designation):
            message += " (a cylindrical roller bearing: the catalogue has balls, and rollers of two rigs only)"
            return Problem(field=field, message=message, given=designation, allowed=otherwise)
        alike = near(bare(designation), names, most=MOST_NEAR, like=LIKE)
        shown = f"near it {', '.join(alike)}; " if alike else f"{', '.join(names[:MOST_NEAR])}, ...: "
        allowed = f"{shown}one of {len(names)} that `sideband bearings` lists; or {otherwise}"
        return Problem(field=field, message=message, given=designation, allowed=allowed)
    return None
